// SPDX-License-Identifier: Apache-2.0
// One call of the C API: validates its arguments and stores its error for relief_error(). No exception leaves it.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <cstring>
#include <exception>
#include <memory>
#include <new>
#include <shared_mutex>
#include <string>
#include <unordered_map>
#include <utility>

#include "formats/base/field.h"
#include "formats/base/result.h"
#include "formats/collider.h"

struct relief_collider;  // of relief_runtime.h

namespace relief {

enum class HandleKind : std::uint8_t {
    kCollider = 1,
    kTextures,
    kParticles,
    kPicture,
    kWorld,
    kAnimation,
    kEmitter
};
inline constexpr std::size_t kHandleKinds = 7;

/// Handles of the C API. A handle is a number in the form of a pointer: the highest bit (which no user-space address
/// has set), a serial number, and the kind in the low bits (so it is never the address of an aligned object). Handles
/// are looked up, never dereferenced, so an invalid handle cannot cause a crash. Numbers are never reused.
///
/// All functions are thread-safe. Removing an object while another thread uses it is a race.
class HandleTable {
  public:
    /// Returns a handle, never 0. Throws std::bad_alloc, without effect, if memory or numbers run out.
    [[nodiscard]] std::uintptr_t add(HandleKind kind, std::shared_ptr<void> object);
    /// Returns null if the handle was freed, is of another kind, or was never issued.
    [[nodiscard]] const std::shared_ptr<void>* find(HandleKind kind, std::uintptr_t handle) const;
    /// Removes and returns the object; the caller may become its last owner. Returns null if find() does.
    [[nodiscard]] std::shared_ptr<void> remove(HandleKind kind, std::uintptr_t handle);

  private:
    mutable std::shared_mutex mutex_;
    std::unordered_map<std::uintptr_t, std::shared_ptr<void>> objects_;
    std::uintptr_t issued_ = 0;  // handles so far
};

/// The table of the process. It is never destroyed; the system reclaims objects that the program does not free.
[[nodiscard]] HandleTable& handleTable();

/// The object behind a handle.
template <class T, HandleKind kind>
struct HandleOf {
    using Object = T;
    static constexpr HandleKind kKind = kind;
};

/// Maps a handle type H of the C API to its object: specialisations derive from HandleOf.
template <class H>
struct HandleType;
template <>
struct HandleType<relief_collider> : HandleOf<Collider, HandleKind::kCollider> {};

/// The errors of the calls of one thread.
class CallErrors {
  public:
    [[nodiscard]] const char* last() const { return shown_; }
    [[nodiscard]] std::uint64_t count() const { return count_; }

    void fail(const char* message) noexcept;
    /// Records that creating an object of this kind failed with last(); the caller may pass the NULL to other calls.
    void creationFailed(HandleKind kind) noexcept;
    void made(HandleKind kind) noexcept { of(kind).clear(); }
    /// The unread error that a NULL of this kind represents, or empty.
    [[nodiscard]] const std::string& unreadError(HandleKind kind) const {
        return unread_[static_cast<std::size_t>(kind) - 1];
    }
    void read() noexcept;

  private:
    [[nodiscard]] std::string& of(HandleKind kind) { return unread_[static_cast<std::size_t>(kind) - 1]; }

    std::string text_;
    const char* shown_ = "";  // text_, or a literal if memory is exhausted
    std::uint64_t count_ = 0;
    std::array<std::string, kHandleKinds> unread_;
};

[[nodiscard]] CallErrors& callErrors();

/// Locates a number in messages: "births[3].velocity[1]".
struct NumberName {
    static constexpr std::size_t kNone = ~std::size_t{0};
    const char* argument;
    std::size_t item = kNone;
    const char* field = nullptr;
    std::size_t component = kNone;

    [[nodiscard]] std::string text() const;
};

/// Validates arguments. Errors name the function, the argument and the fix.
class Call {
  public:
    explicit Call(const char* function) : function_(function) {}

    /// Checks that an index is below `count`. \param argument, elements  "body" and "bodies", for the message.
    [[nodiscard]] Result<void> index(std::size_t i, std::size_t count, const std::string& argument,
                                     const std::string& elements) const {
        return i < count
                   ? Result<void>()
                   : reject(argument + " is " + std::to_string(i) + "; it must be below the number of " +
                            elements + ", " + std::to_string(count));
    }
    [[nodiscard]] tl::unexpected<Error> reject(const std::string& what) const {
        return fail(ErrorCode::kUsage, std::string(function_) + "(): " + what);
    }

    template <class H>
    [[nodiscard]] Result<std::shared_ptr<typename HandleType<H>::Object>> shared(const H* handle,
                                                                                 const char* argument) const {
        const std::shared_ptr<void>& found = *RELIEF_TRY(find(handle, argument));
        return std::static_pointer_cast<typename HandleType<H>::Object>(found);
    }
    /// Like shared(), without ownership: the caller's handle owns the object.
    template <class H>
    [[nodiscard]] Result<typename HandleType<H>::Object*> object(const H* handle,
                                                                 const char* argument) const {
        return static_cast<typename HandleType<H>::Object*>(RELIEF_TRY(find(handle, argument))->get());
    }
    /// Like shared(), but returns null for NULL. Returns the error if the NULL comes from an unread failure.
    template <class H>
    [[nodiscard]] Result<std::shared_ptr<typename HandleType<H>::Object>> optional(
        const H* handle, const char* argument) const {
        if (handle == nullptr && callErrors().unreadError(HandleType<H>::kKind).empty()) {
            return std::shared_ptr<typename HandleType<H>::Object>();
        }
        return shared(handle, argument);
    }

    [[nodiscard]] Result<void> notNull(const void* pointer, const char* argument) const;
    /// Checks an array of `count` items: not NULL unless `count` is 0, and within the address space.
    template <class T>
    [[nodiscard]] Result<void> array(const T* items, const char* argument, std::size_t count,
                                     const char* count_argument) const {
        if (count >= static_cast<std::size_t>(PTRDIFF_MAX) / sizeof(T)) {
            return reject(std::string(count_argument) + " is " + std::to_string(count) +
                          "; an array of that size does not fit in memory");
        }
        return count == 0 ? Result<void>() : notNull(items, argument);
    }
    /// Copies a structure that starts with its size. Every structure has only one size so far.
    /// \param name  the name of its type.
    template <class T>
    [[nodiscard]] Result<T> structure(const T* given, const char* argument, const char* name) const {
        std::size_t size = 0;
        std::memcpy(&size, given, sizeof(size));
        if (size != sizeof(T)) {
            return reject(std::string(argument) + "->size is " + std::to_string(size) +
                          "; set it to sizeof(" + name + "), which is " + std::to_string(sizeof(T)));
        }
        return *given;
    }

    /// Checks the range of a number, or of each number of an array.
    template <class T>
    [[nodiscard]] Result<void> number(const T& value, const FieldRange& range, NumberName name) const {
        if constexpr (std::is_array_v<T>) {
            for (name.component = 0; name.component < std::extent_v<T>; ++name.component) {
                RELIEF_TRY(number(value[name.component], range, name));
            }
            return {};
        } else {
            const auto given = static_cast<double>(value);
            return range.holds(given) ? Result<void>() : numberOutOfRange(given, range, name);
        }
    }
    /// Checks that a GL context is current.
    [[nodiscard]] Result<void> context() const;

  private:
    template <class H>
    [[nodiscard]] Result<const std::shared_ptr<void>*> find(const H* handle, const char* argument) const {
        const auto number = reinterpret_cast<std::uintptr_t>(handle);
        if (const auto* found = handleTable().find(HandleType<H>::kKind, number); found != nullptr) {
            return found;
        }
        return faulty(HandleType<H>::kKind, number, argument);
    }
    [[nodiscard]] tl::unexpected<Error> faulty(HandleKind kind, std::uintptr_t handle,
                                               const char* argument) const;
    [[nodiscard]] tl::unexpected<Error> numberOutOfRange(double value, const FieldRange& range,
                                                         const NumberName& name) const;

    const char* function_;
};

/// Returns the result of body(call); on failure, stores the error in callErrors() and returns `failed`.
template <class T, class F>
T answer(const char* function, T failed, const F& body) noexcept {
    try {
        Result<T> result = body(Call(function));
        if (result) {
            return *std::move(result);
        }
        callErrors().fail(result.error().message.c_str());
    } catch (const std::bad_alloc&) {
        callErrors().fail("out of memory");
    } catch (const std::exception& error) {
        callErrors().fail(error.what());
    } catch (...) {
        callErrors().fail("an unknown error");
    }
    return failed;
}

/// Returns a new handle of the object that body(call) returns, or NULL on failure.
template <class H, class F>
H* create(const char* function, const F& body) noexcept {
    constexpr HandleKind kKind = HandleType<H>::kKind;
    const auto handle = answer(function, std::uintptr_t{0}, [&](const Call& call) -> Result<std::uintptr_t> {
        using Object = typename HandleType<H>::Object;
        return handleTable().add(kKind, std::make_shared<Object>(RELIEF_TRY(body(call))));
    });
    if (handle == 0) {
        callErrors().creationFailed(kKind);
    } else {
        callErrors().made(kKind);
    }
    return reinterpret_cast<H*>(handle);
}

}  // namespace relief

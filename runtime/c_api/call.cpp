// SPDX-License-Identifier: Apache-2.0
#include "runtime/c_api/call.h"

#include <algorithm>
#include <mutex>

#include "formats/base/text.h"
#include "runtime/gl/gl_fault.h"

namespace relief {
namespace {

std::string numberText(double value) {
    return formatted("%.9g", value);
}

/// In the order of HandleKind.
constexpr auto kTypeNames =
    std::to_array<const char*>({"relief_collider", "relief_textures", "relief_particles", "relief_renderer",
                                "relief_world", "relief_animation", "relief_emitter"});
static_assert(kTypeNames.size() == kHandleKinds);
constexpr int kKindBits = 3;
constexpr std::uintptr_t kHighestBit = ~(~std::uintptr_t{0} >> 1);

/// Returns 0 if the number is not a handle.
std::uintptr_t kindOf(std::uintptr_t handle) {
    const std::uintptr_t kind = handle & ((1U << kKindBits) - 1);
    return (handle & kHighestBit) != 0 && kind <= kHandleKinds ? kind : 0;
}

}  // namespace

std::uintptr_t HandleTable::add(HandleKind kind, std::shared_ptr<void> object) {
    const std::lock_guard lock(mutex_);
    if (issued_ + 1 == kHighestBit >> kKindBits) {
        throw std::bad_alloc();
    }
    const std::uintptr_t handle =
        kHighestBit | (issued_ + 1) << kKindBits | static_cast<std::uintptr_t>(kind);
    objects_.emplace(handle, std::move(object));
    ++issued_;
    return handle;
}

const std::shared_ptr<void>* HandleTable::find(HandleKind kind, std::uintptr_t handle) const {
    if (kindOf(handle) != static_cast<std::uintptr_t>(kind)) {
        return nullptr;
    }
    const std::shared_lock lock(mutex_);
    const auto found = objects_.find(handle);
    return found == objects_.end() ? nullptr : &found->second;
}

std::shared_ptr<void> HandleTable::remove(HandleKind kind, std::uintptr_t handle) {
    if (find(kind, handle) == nullptr) {
        return nullptr;
    }
    const std::lock_guard lock(mutex_);
    const auto removed = objects_.extract(handle);
    return removed ? removed.mapped() : nullptr;
}

HandleTable& handleTable() {
    static auto* const table = new HandleTable;
    return *table;
}

void CallErrors::fail(const char* message) noexcept {
    ++count_;
    try {
        // The message may point into text_.
        std::string text = message;
        std::replace(text.begin(), text.end(), '\n', ' ');
        text_.swap(text);
        shown_ = text_.c_str();
    } catch (...) {
        shown_ = "out of memory";
    }
}

void CallErrors::creationFailed(HandleKind kind) noexcept {
    try {
        of(kind) = shown_;
    } catch (...) {
        of(kind).clear();
    }
}

void CallErrors::read() noexcept {
    for (std::string& one : unread_) {
        one.clear();
    }
}

CallErrors& callErrors() {
    thread_local CallErrors errors;
    return errors;
}

std::string NumberName::text() const {
    std::string text = argument;
    if (item != kNone) {
        text += "[" + std::to_string(item) + "]";
    }
    if (field != nullptr) {
        text += (item != kNone ? "." : "->") + std::string(field);
    }
    if (component != kNone) {
        text += "[" + std::to_string(component) + "]";
    }
    return text;
}

Result<void> Call::notNull(const void* pointer, const char* argument) const {
    if (pointer == nullptr) {
        return reject(std::string(argument) + " is NULL");
    }
    return {};
}

Result<void> Call::context() const {
    if (checkContext()) {
        return {};
    }
    return reject("no OpenGL context is current; make yours current on this thread");
}

tl::unexpected<Error> Call::faulty(HandleKind kind, std::uintptr_t handle, const char* argument) const {
    const std::string type = kTypeNames[static_cast<std::size_t>(kind) - 1];
    if (handle != 0) {
        return reject(std::string(argument) + " is not a live " + type +
                      " handle: it was freed, has another type, or was never created");
    }
    if (const std::string& cause = callErrors().unreadError(kind); !cause.empty()) {
        return fail(ErrorCode::kUsage, cause);
    }
    return reject(std::string(argument) + " is NULL; pass a " + type + " that was created successfully");
}

tl::unexpected<Error> Call::numberOutOfRange(double value, const FieldRange& range,
                                             const NumberName& name) const {
    return reject(name.text() + " is " + numberText(value) + "; it must be " +
                  (range.low_included ? "from " : "above ") + numberText(range.low) +
                  (range.low_included ? " to " : " and at most ") + numberText(range.high));
}

}  // namespace relief

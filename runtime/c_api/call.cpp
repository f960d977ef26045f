#include "runtime/c_api/call.h"

#include <algorithm>
#include <cstdio>

#include "runtime/gl/gl_fault.h"

namespace relief {
namespace {

std::string numberText(double value) {
    char text[40];
    std::snprintf(text, sizeof(text), "%.9g", value);
    return text;
}

}  // namespace

void CallErrors::fail(const char* message) noexcept {
    ++count_;
    try {
        // The message may be this object's own.
        std::string text = message;
        std::replace(text.begin(), text.end(), '\n', ' ');
        text_.swap(text);
        shown_ = text_.c_str();
    } catch (...) {
        shown_ = "there is not enough memory";
    }
}

void CallErrors::failedToMake(HandleKind kind) noexcept {
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

bool copyKnown(std::span<std::byte> all, const void* given, std::size_t size,
               std::span<const std::size_t> versions) {
    if (std::find(versions.begin(), versions.end(), size) == versions.end() || size > all.size()) {
        return false;
    }
    std::memcpy(all.data(), given, size);
    return true;
}

Result<void> Call::notNull(const void* pointer, const char* argument) const {
    if (pointer == nullptr) {
        return refuse(std::string(argument) + " is NULL");
    }
    return {};
}

Result<void> Call::context() const {
    if (checkContext()) {
        return {};
    }
    return refuse("no OpenGL context is current; make yours current on this thread");
}

tl::unexpected<Error> Call::faulty(HandleKind kind, std::uintptr_t handle, const char* argument,
                                   const char* type) const {
    switch (handleTable().faultOf(kind, handle)) {
        case HandleFault::kNull:
            if (const std::string& cause = callErrors().unreadOf(kind); !cause.empty()) {
                return fail(ErrorCode::kUsage, cause);
            }
            return refuse(std::string(argument) + " is NULL, as a " + type + " is that could not be made");
        case HandleFault::kFreed:
            return refuse(std::string(argument) + " has been freed");
        case HandleFault::kOtherKind:
            return refuse(std::string(argument) + " is another kind of handle; it must be a " + type);
        case HandleFault::kNever:
            break;
    }
    return refuse(std::string(argument) + " is no handle of this library; it must be a " + type);
}

tl::unexpected<Error> Call::wrongNumber(double value, const NumberRange& range,
                                        const NumberName& name) const {
    return refuse(name.text() + " is " + numberText(value) + "; it must be " +
                  (range.low_included ? "from " : "above ") + numberText(range.low) +
                  (range.low_included ? " to " : " and at most ") + numberText(range.high));
}

}  // namespace relief

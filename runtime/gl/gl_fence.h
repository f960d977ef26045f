// A mark in the GPU's work, and whether it has come by.
#pragma once

#include <epoxy/gl.h>

#include <utility>

namespace relief {

/// Owns a sync object of the current context's share group. Moves, like GlName; empty until inserted.
class GlFence {
  public:
    GlFence() = default;
    GlFence(GlFence&& other) noexcept : sync_(std::exchange(other.sync_, nullptr)) {}
    GlFence& operator=(GlFence&& other) noexcept {
        std::swap(sync_, other.sync_);
        return *this;
    }
    ~GlFence() { remove(); }

    /// Marks the end of what has been asked of the GL so far.
    void insert() {
        remove();
        sync_ = glFenceSync(GL_SYNC_GPU_COMMANDS_COMPLETE, 0);
        state_ = GL_TIMEOUT_EXPIRED;
    }
    void remove() {
        if (sync_ != nullptr) {
            glDeleteSync(std::exchange(sync_, nullptr));
        }
    }
    /// Hands what was asked for to the GPU, and waits for at most so many nanoseconds.
    /// \return whether the GPU has come by; false also where the GL reports an error.
    [[nodiscard]] bool passed(GLuint64 nanoseconds = 0) const {
        if (sync_ == nullptr) {
            return false;
        }
        state_ = glClientWaitSync(sync_, GL_SYNC_FLUSH_COMMANDS_BIT, nanoseconds);
        return state_ == GL_ALREADY_SIGNALED || state_ == GL_CONDITION_SATISFIED;
    }
    /// Whether there is nothing to wait for: never inserted, or the GL reported an error to passed().
    [[nodiscard]] bool failed() const { return sync_ == nullptr || state_ == GL_WAIT_FAILED; }

  private:
    GLsync sync_ = nullptr;
    mutable GLenum state_ = GL_TIMEOUT_EXPIRED;  // as the last passed() was told
};

}  // namespace relief

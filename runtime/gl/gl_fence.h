// SPDX-License-Identifier: Apache-2.0
// A mark in the GPU's commands.
#pragma once

#include <utility>

#include "runtime/gl/gl_types.h"

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

    /// Marks the end of the commands so far.
    void insert();
    void remove();
    /// Flushes the commands, and waits for at most so many nanoseconds.
    /// \return whether the GPU has come by; false also where the GL reports an error.
    [[nodiscard]] bool passed(GLuint64 nanoseconds = 0) const;
    /// True if there is nothing to wait for: never inserted, or the GL reported an error to passed().
    [[nodiscard]] bool failed() const;

  private:
    GLsync sync_ = nullptr;
    mutable GLenum state_ = 0;  // of the last passed()
};

}  // namespace relief

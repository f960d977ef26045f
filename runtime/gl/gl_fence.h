// SPDX-License-Identifier: Apache-2.0
// A fence in the GPU's command stream.
#pragma once

#include <utility>

#include "runtime/gl/gl_types.h"

namespace relief {

/// Owns a sync object of the current context's share group. Movable, like GlName; empty until insert().
class GlFence {
  public:
    GlFence() = default;
    GlFence(GlFence&& other) noexcept : sync_(std::exchange(other.sync_, nullptr)) {}
    GlFence& operator=(GlFence&& other) noexcept {
        std::swap(sync_, other.sync_);
        return *this;
    }
    ~GlFence() { remove(); }

    /// Inserts the fence after all commands so far.
    void insert();
    void remove();
    /// Flushes the commands and waits at most for the given time.
    /// \return whether the GPU has passed the fence; false also if the GL reports an error.
    [[nodiscard]] bool passed(GLuint64 nanoseconds = 0) const;
    /// Returns true if there is nothing to wait for: never inserted, or passed() failed with a GL error.
    [[nodiscard]] bool failed() const;

  private:
    GLsync sync_ = nullptr;
    mutable GLenum state_ = 0;  // result of the last passed()
};

}  // namespace relief

// SPDX-License-Identifier: Apache-2.0
#include "runtime/gl/gl_fence.h"

#include "runtime/gl/gl_functions.h"

namespace relief {

void GlFence::insert() {
    remove();
    sync_ = glFenceSync(GL_SYNC_GPU_COMMANDS_COMPLETE, 0);
    state_ = GL_TIMEOUT_EXPIRED;
}

void GlFence::remove() {
    if (sync_ != nullptr) {
        glDeleteSync(std::exchange(sync_, nullptr));
    }
}

bool GlFence::passed(GLuint64 nanoseconds) const {
    if (sync_ == nullptr) {
        return false;
    }
    state_ = glClientWaitSync(sync_, GL_SYNC_FLUSH_COMMANDS_BIT, nanoseconds);
    return state_ == GL_ALREADY_SIGNALED || state_ == GL_CONDITION_SATISFIED;
}

bool GlFence::failed() const {
    return sync_ == nullptr || state_ == GL_WAIT_FAILED;
}

}  // namespace relief

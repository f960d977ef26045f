// SPDX-License-Identifier: Apache-2.0
#include "runtime/particles/birth_pass.h"

#include <algorithm>
#include <cstddef>

#include "runtime/gl/compute_units.h"
#include "runtime/gl/gl_functions.h"
#include "shaders/particles/constants.h"

namespace relief {
namespace {

// 11.5 MB, below the maximum storage block size of every GL.
constexpr std::size_t kBirthsPerDispatch = std::size_t{1} << 18;

constexpr GLsizei kStride = sizeof(BirthPass::Newborn);
static_assert(kStride == 11 * sizeof(float));

/// Allocates new storage each time, so that the driver need not wait until the old contents have been used.
void upload(GLenum target, std::span<const BirthPass::Newborn> newborn) {
    glBufferData(target, static_cast<GLsizeiptr>(newborn.size_bytes()), newborn.data(), GL_STREAM_DRAW);
}

}  // namespace

Result<BirthPass> BirthPass::create(const glm::uvec2& size, StepPath path) {
    BirthPass pass;
    pass.path_ = path;
    pass.size_ = size;
    pass.newborn_ = makeBuffer();
    pass.program_ =
        RELIEF_TRY(path == StepPath::kCompute ? makeComputeProgram("particles/birth.comp")
                                              : makeProgram("particles/birth.vert", "particles/birth.frag"));
    pass.program_.use();
    pass.program_.set("u_size", glm::ivec2(size));
    if (path != StepPath::kCompute) {
        pass.makeVertexFormat();
    }
    return pass;
}

void BirthPass::makeVertexFormat() {
    array_ = makeVertexArray();
    glBindVertexArray(array_.name());
    glBindBuffer(GL_ARRAY_BUFFER, newborn_.name());
    const auto at = [](std::size_t offset) { return reinterpret_cast<const void*>(offset); };
    glVertexAttribIPointer(0, 1, GL_UNSIGNED_INT, kStride, at(offsetof(Newborn, index)));
    glVertexAttribPointer(1, 3, GL_FLOAT, GL_FALSE, kStride, at(offsetof(Newborn, position)));
    glVertexAttribPointer(2, 3, GL_FLOAT, GL_FALSE, kStride, at(offsetof(Newborn, velocity)));
    glVertexAttribPointer(3, 4, GL_FLOAT, GL_FALSE, kStride, at(offsetof(Newborn, birth)));
    for (GLuint i = 0; i < 4; ++i) {
        glEnableVertexAttribArray(i);
    }
}

void BirthPass::run(std::span<const Newborn> newborn, const Target& target) const {
    program_.use();
    if (path_ == StepPath::kCompute) {
        dispatch(newborn, target);
    } else {
        draw(newborn, target);
    }
}

void BirthPass::draw(std::span<const Newborn> newborn, const Target& target) const {
    glBindFramebuffer(GL_FRAMEBUFFER, target.framebuffer);
    glViewport(0, 0, static_cast<GLsizei>(size_.x), static_cast<GLsizei>(size_.y));
    glBindVertexArray(array_.name());
    glBindBuffer(GL_ARRAY_BUFFER, newborn_.name());
    upload(GL_ARRAY_BUFFER, newborn);
    glDrawArrays(GL_POINTS, 0, static_cast<GLsizei>(newborn.size()));
}

void BirthPass::dispatch(std::span<const Newborn> newborn, const Target& target) const {
    const ImageUnits images;
    const StorageUnits storage;
    ImageUnits::write(0, target.position);
    ImageUnits::write(1, target.velocity);
    ImageUnits::write(2, target.birth);
    StorageUnits::bind(0, newborn_);
    StorageUnits::order();  // renderers may still read the textures
    for (std::size_t first = 0; first < newborn.size(); first += kBirthsPerDispatch) {
        const auto batch = newborn.subspan(first, std::min(kBirthsPerDispatch, newborn.size() - first));
        upload(GL_SHADER_STORAGE_BUFFER, batch);
        const auto count = static_cast<GLuint>(batch.size());
        program_.set("u_count", count);
        glDispatchCompute((count + kBirthGroup - 1) / kBirthGroup, 1, 1);
    }
    ImageUnits::finish();
}

}  // namespace relief

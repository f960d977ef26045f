// SPDX-License-Identifier: Apache-2.0
#include "runtime/live/skin_pass.h"

#include <algorithm>
#include <glm/glm.hpp>
#include <string>
#include <vector>

#include "runtime/gl/gl_fault.h"
#include "runtime/gl/gl_functions.h"
#include "runtime/gl/pass_state.h"

namespace relief {
namespace {

constexpr int kPoseUnit = 0;
constexpr int kInfluencesUnit = 1;
constexpr int kDeltasUnit = 2;
/// log2 of the maximum width, 2048 texels, which every OpenGL ES 3.0 context supports.
constexpr int kWidestShift = 11;

struct RestVertex {
    glm::vec3 position;
    glm::uvec4 lists;
    glm::vec3 normal;
};

/// Pads texels to whole rows of a power-of-two width, with as few rows as possible.
template <class T>
int padToRows(std::vector<T>& texels) {
    const std::size_t count = std::max<std::size_t>(texels.size(), 1);
    int shift = 0;
    while (shift < kWidestShift && (std::size_t{1} << shift) < count) {
        ++shift;
    }
    const std::size_t width = std::size_t{1} << shift;
    texels.resize((count + width - 1) / width * width);
    return shift;
}

template <class T>
Result<GlTexture> makeList(std::vector<T> texels, int& shift, GLenum internal_format, GLenum format,
                           GLenum type, const char* what) {
    shift = padToRows(texels);
    const std::size_t width = std::size_t{1} << shift;
    RELIEF_TRY(checkTextureSize(width, texels.size() / width, what, "simplify the mesh"));
    return makeTexture2D(internal_format, static_cast<GLsizei>(width),
                         static_cast<GLsizei>(texels.size() / width), format, type, texels.data());
}

}  // namespace

Result<SkinPass> SkinPass::create(const AnimatedMesh& mesh, std::span<const glm::vec3> normals) {
    RELIEF_TRY(checkContext());
    if (!normals.empty() && normals.size() != mesh.positions.size()) {
        return fail(ErrorCode::kUsage, "an animated mesh of " + std::to_string(mesh.positions.size()) +
                                           " vertices needs as many normals, not " +
                                           std::to_string(normals.size()));
    }
    std::vector<RestVertex> rest;
    for (std::size_t i = 0; i < mesh.positions.size(); ++i) {
        rest.push_back({mesh.positions[i],
                        {mesh.influence_begin[i], mesh.influence_begin[i + 1], mesh.delta_begin[i],
                         mesh.delta_begin[i + 1]},
                        normals.empty() ? glm::vec3(0.0F) : normals[i]});
    }
    std::vector<glm::uvec2> influences;
    for (const VertexInfluence& by : mesh.influences) {
        influences.emplace_back(by.joint, glm::floatBitsToUint(by.weight));
    }
    std::vector<glm::vec4> deltas;
    for (const MorphDelta& by : mesh.deltas) {
        deltas.emplace_back(by.delta, static_cast<float>(by.target));
    }

    const PassState state;
    clearGlErrors();
    SkinPass pass;
    pass.joints_ = static_cast<int>(mesh.joints.size());
    pass.feedback_ = RELIEF_TRY(VertexFeedback::create(
        "live/skin.vert", rest.size(),
        normals.empty() ? VertexOutput::kPositions : VertexOutput::kPositionsAndNormals));
    pass.rest_ = makeBuffer();
    glBindBuffer(GL_ARRAY_BUFFER, pass.rest_.name());
    glBufferData(GL_ARRAY_BUFFER, static_cast<GLsizeiptr>(rest.size() * sizeof(RestVertex)), rest.data(),
                 GL_STATIC_DRAW);
    const auto at = [](std::size_t offset) { return reinterpret_cast<const void*>(offset); };
    glEnableVertexAttribArray(0);
    glVertexAttribPointer(0, 3, GL_FLOAT, GL_FALSE, sizeof(RestVertex), at(offsetof(RestVertex, position)));
    glEnableVertexAttribArray(1);
    glVertexAttribIPointer(1, 4, GL_UNSIGNED_INT, sizeof(RestVertex), at(offsetof(RestVertex, lists)));
    if (!normals.empty()) {
        glEnableVertexAttribArray(2);
        glVertexAttribPointer(2, 3, GL_FLOAT, GL_FALSE, sizeof(RestVertex), at(offsetof(RestVertex, normal)));
    }
    pass.influences_ = RELIEF_TRY(makeList(std::move(influences), pass.shifts_.y, GL_RG32UI, GL_RG_INTEGER,
                                           GL_UNSIGNED_INT, "the joints of the animated mesh's vertices"));
    pass.deltas_ = RELIEF_TRY(makeList(std::move(deltas), pass.shifts_.z, GL_RGBA32F, GL_RGBA, GL_FLOAT,
                                       "the morph targets of the animated mesh"));
    pass.texels_.resize(3 * mesh.joints.size() + mesh.weights.size());
    pass.shifts_.x = padToRows(pass.texels_);
    pass.pose_ =
        makeTexture2D(GL_RGBA32F, GLsizei{1} << pass.shifts_.x,
                      static_cast<GLsizei>(pass.texels_.size() >> pass.shifts_.x), GL_RGBA, GL_FLOAT);
    pass.upload_ = makeBuffer();
    GlProgram& program = pass.feedback_.program();
    program.use();
    program.set("u_pose", kPoseUnit);
    program.set("u_influences", kInfluencesUnit);
    program.set("u_deltas", kDeltasUnit);
    program.set("u_shifts", pass.shifts_);
    program.set("u_joints", pass.joints_);
    RELIEF_TRY(checkAllocated("the vertices of the animated mesh", "simplify it"));
    return pass;
}

void SkinPass::run(const MeshPose& pose, const glm::vec3& origin) {
    std::size_t at = 0;
    for (const Affine& joint : pose.joints) {
        for (const glm::vec4& row : joint.row) {
            texels_[at++] = row;
        }
    }
    for (const float weight : pose.weights) {
        texels_[at++] = glm::vec4(weight, 0.0F, 0.0F, 0.0F);
    }
    const PassState state;
    useTexture(kPoseUnit, pose_);
    // Upload through a new buffer, so that the upload does not wait for a step that still reads the texture.
    glBindBuffer(GL_PIXEL_UNPACK_BUFFER, upload_.name());
    glBufferData(GL_PIXEL_UNPACK_BUFFER, static_cast<GLsizeiptr>(texels_.size() * sizeof(glm::vec4)),
                 texels_.data(), GL_STREAM_DRAW);
    glTexSubImage2D(GL_TEXTURE_2D, 0, 0, 0, GLsizei{1} << shifts_.x,
                    static_cast<GLsizei>(texels_.size() >> shifts_.x), GL_RGBA, GL_FLOAT, nullptr);
    glBindBuffer(GL_PIXEL_UNPACK_BUFFER, 0);
    useTexture(kInfluencesUnit, influences_);
    useTexture(kDeltasUnit, deltas_);
    GlProgram& program = feedback_.program();
    program.use();
    program.set("u_origin", origin);
    feedback_.run();
}

}  // namespace relief

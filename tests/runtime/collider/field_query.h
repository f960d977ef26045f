// SPDX-License-Identifier: Apache-2.0
// Evaluates a collider at many points on the GPU with the shader code of the simulation, to prove that
// shaders/collider/collider.glsl matches formats/collider.cpp.
#pragma once

#include <gtest/gtest.h>

#include <algorithm>
#include <glm/glm.hpp>
#include <memory>
#include <span>
#include <vector>

#include "runtime/bodies/world_textures.h"
#include "runtime/gl/gl_fault.h"
#include "runtime/gl/pass_state.h"
#include "tests/results.h"
#include "tests/runtime/gl/query_program.h"

namespace relief {

/// With RELIEF_QUERY_INSIDE it uses reliefSolid; with RELIEF_QUERY_PROBE it uses reliefProbe, which evaluates map
/// RELIEF_QUERY_PROBE first. The distance is then −1 inside and 1 outside.
inline constexpr const char* kFieldQuery = R"(
uniform highp sampler2D u_points;  // xyz: object space
layout(location = 0) out vec4 o_normal_distance;
layout(location = 1) out vec4 o_map;  // x: deciding map, −1 for none
void main() {
    vec3 p = texelFetch(u_points, ivec2(gl_FragCoord.xy), 0).xyz;
#if defined(RELIEF_QUERY_INSIDE) || defined(RELIEF_QUERY_PROBE)
#ifdef RELIEF_QUERY_INSIDE
    ReliefField field = reliefSolid(p);
#else
    ReliefField field = reliefFieldOf(reliefProbe(0, u_relief_count.x, RELIEF_QUERY_PROBE, p));
#endif
    bool inside = reliefInside(field);
    o_normal_distance = vec4(inside ? field.normal : vec3(0.0), inside ? -1.0 : 1.0);
#else
    ReliefField field = reliefEvaluate(p);
    o_normal_distance = vec4(field.normal, field.distance);
#endif
    o_map = vec4(float(field.map), 0.0, 0.0, 0.0);
}
)";

class FieldQuery {
  public:
    /// Uploads the collider. Fails as WorldTextures::create and makeProgram do.
    [[nodiscard]] static Result<FieldQuery> create(const Collider& collider);

    /// Uses existing textures, of one collider or of a world's bodies, some of which may be live. They must outlive
    /// this. Fails as makeProgram does.
    /// \param defines  lines for the shader.
    [[nodiscard]] static Result<FieldQuery> create(const WorldTextures& textures,
                                                   const std::string& defines = {});
    /// Switches to other textures with the same defines().
    void use(const WorldTextures& textures) { textures_ = &textures; }

    /// One sample per point, in order. Waits for the GPU.
    /// Errors: kLimit (out of GPU memory), kUnsupported, kFailure.
    [[nodiscard]] Result<std::vector<FieldSample>> evaluate(std::span<const glm::vec3> points) const;

  private:
    static constexpr GLsizei kWidth = 1024;
    static constexpr std::size_t kBatch = std::size_t{kWidth} * 1024;  // points per draw call
    static constexpr WorldTextures::Binding kBinding{1, 0};            // unit 0 holds the points

    FieldQuery() = default;

    std::unique_ptr<WorldTextures> own_;  // null: the caller's textures are used
    const WorldTextures* textures_ = nullptr;
    GlProgram program_;
};

inline Result<FieldQuery> FieldQuery::create(const Collider& collider) {
    WorldTextures textures = RELIEF_TRY(WorldTextures::create(collider));
    auto own = std::make_unique<WorldTextures>(std::move(textures));
    auto query = create(*own);
    if (query) {
        query->own_ = std::move(own);
    }
    return query;
}

inline Result<FieldQuery> FieldQuery::create(const WorldTextures& textures, const std::string& defines) {
    RELIEF_TRY(checkContext());
    const PassState state;
    FieldQuery query;
    query.textures_ = &textures;
    query.program_ =
        RELIEF_TRY(makeQueryProgram("collider/collider.glsl", kFieldQuery, textures.defines() + defines));
    textures.attach(query.program_, kBinding);
    query.program_.set("u_points", 0);
    return query;
}

inline Result<std::vector<FieldSample>> FieldQuery::evaluate(std::span<const glm::vec3> points) const {
    const PassState state;
    std::vector<FieldSample> samples;
    samples.reserve(points.size());
    RELIEF_TRY(checkTextureSize(kWidth, std::min(kBatch, points.size()) / kWidth, "the points of a query",
                                "this GL context is too small for it"));
    for (std::size_t first = 0; first < points.size(); first += kBatch) {
        const std::span<const glm::vec3> batch =
            points.subspan(first, std::min(kBatch, points.size() - first));
        const auto height = static_cast<GLsizei>((batch.size() + kWidth - 1) / kWidth);
        std::vector<float> texels(std::size_t{4} * kWidth * static_cast<std::size_t>(height), 0.0F);
        for (std::size_t i = 0; i < batch.size(); ++i) {
            std::copy_n(&batch[i].x, 3, &texels[4 * i]);
        }

        clearGlErrors();
        const GlTexture input = makeTexture2D(GL_RGBA32F, kWidth, height, GL_RGBA, GL_FLOAT, texels.data());
        const GlTexture normal_distance = makeTexture2D(GL_RGBA32F, kWidth, height, GL_RGBA, GL_FLOAT);
        const GlTexture map = makeTexture2D(GL_RGBA32F, kWidth, height, GL_RGBA, GL_FLOAT);
        RELIEF_TRY(checkAllocated("a query of " + std::to_string(batch.size()) + " points",
                                  "close what else is on the GPU"));
        const GlFramebuffer framebuffer = RELIEF_TRY(makeFramebuffer({normal_distance.name(), map.name()}));
        useTexture(0, input);
        textures_->bind(kBinding);
        program_.drawScreen(framebuffer.name(), kWidth, height);

        const auto fields = RELIEF_TRY(readTextureFloats(normal_distance, kWidth, height));
        const auto maps = RELIEF_TRY(readTextureFloats(map, kWidth, height));
        for (std::size_t i = 0; i < batch.size(); ++i) {
            const float* field = &fields[4 * i];
            samples.push_back({field[3], {field[0], field[1], field[2]}, static_cast<int>(maps[4 * i])});
        }
    }
    return samples;
}

/// The field of existing textures.
/// \param defines  lines for the shader.
inline std::vector<FieldSample> fieldOf(const WorldTextures& textures, std::span<const glm::vec3> points,
                                        const std::string& defines = {}) {
    const auto query = required(FieldQuery::create(textures, defines));
    auto samples = query.evaluate(points);
    EXPECT_TRUE(samples) << samples.error().message;
    return samples.value_or(std::vector<FieldSample>(points.size()));
}

}  // namespace relief

#include "runtime/collider/field_query.h"

#include <algorithm>
#include <array>
#include <glm/glm.hpp>

#include "runtime/gl/gl_fault.h"
#include "runtime/gl/gl_functions.h"
#include "runtime/gl/pass_state.h"

namespace relief {
namespace {

constexpr GLsizei kWidth = 1024;
constexpr std::size_t kBatch = std::size_t{kWidth} * 1024;  // points evaluated with one draw
constexpr ColliderTextures::Binding kBinding{1, 0};         // unit 0 holds the points

}  // namespace

Result<FieldQuery> FieldQuery::create(const Collider& collider) {
    ColliderTextures textures = RELIEF_TRY(ColliderTextures::create(collider));
    auto own = std::make_unique<ColliderTextures>(std::move(textures));
    auto query = create(*own);
    if (query) {
        query->own_ = std::move(own);
    }
    return query;
}

Result<FieldQuery> FieldQuery::create(const ColliderTextures& textures) {
    RELIEF_TRY(checkContext());
    const PassState state;
    FieldQuery query;
    query.textures_ = &textures;
    query.program_ = RELIEF_TRY(makeScreenProgram("collider/query.frag", textures.defines()));
    textures.attach(query.program_, kBinding);
    query.program_.set("u_points", 0);
    return query;
}

Result<std::vector<FieldSample>> FieldQuery::evaluate(std::span<const glm::vec3> points) const {
    const PassState state;
    std::vector<FieldSample> samples;
    samples.reserve(points.size());
    RELIEF_TRY(checkTextureSize(kWidth, std::min(kBatch, points.size()) / kWidth, "the points of a query",
                                "this GL is too small for it"));
    for (std::size_t first = 0; first < points.size(); first += kBatch) {
        const std::span<const glm::vec3> batch =
            points.subspan(first, std::min(kBatch, points.size() - first));
        const auto height = static_cast<GLsizei>((batch.size() + kWidth - 1) / kWidth);
        std::vector<float> texels(std::size_t{4} * kWidth * static_cast<std::size_t>(height), 0.0F);
        for (std::size_t i = 0; i < batch.size(); ++i) {
            std::copy_n(&batch[i].x, 3, &texels[4 * i]);
        }

        forgetGlErrors();
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

}  // namespace relief

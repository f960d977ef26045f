// SPDX-License-Identifier: Apache-2.0
#include "runtime/bench/rival_step.h"

#include <algorithm>
#include <utility>

#include "runtime/gl/compute_units.h"
#include "runtime/gl/gl_functions.h"
#include "runtime/gl/pass_state.h"

namespace relief {
namespace {

constexpr auto kWidth = ParticleSystem::kStateWidth;
constexpr int kFirstUnit = 3;  // texture units after those of the state

}  // namespace

Result<RivalStep> RivalStep::create(Rival rival, const BenchScene& scene, StepPath path) {
    const auto old = [](const Birth& birth) { return birth.age != 0.0F; };
    if (scene.births.size() % kWidth != 0 || std::ranges::any_of(scene.births, old)) {
        return fail(ErrorCode::kUsage, "RivalStep needs a multiple of 1024 births, all of age 0");
    }
    const PassState state;
    RivalStep made;
    made.rival_ = std::move(rival);
    made.path_ = RELIEF_TRY(resolvePath(path));
    made.forces_ = scene.forces;
    made.types_ = {kBenchSnow};
    made.makeState(scene);
    for (std::size_t i = 0; i < 2; ++i) {
        std::vector<GLuint> names;
        for (const GlTexture& texture : made.state_[i]) {
            names.push_back(texture.name());
        }
        made.target_[i] = RELIEF_TRY(makeFramebuffer(names));
    }
    RELIEF_TRY(made.compile());
    return made;
}

void RivalStep::makeState(const BenchScene& scene) {
    rows_ = static_cast<std::uint32_t>(scene.births.size() / kWidth);
    const auto texture = [&](GLenum internal_format, GLenum format) {
        const auto rows = static_cast<GLsizei>(rows_);
        return path_ == StepPath::kCompute ? makeImageTexture2D(internal_format, kWidth, rows)
                                           : makeTexture2D(internal_format, kWidth, rows, format, GL_FLOAT);
    };
    birth_ = texture(GL_RGBA32F, GL_RGBA);
    for (auto& buffer : state_) {
        buffer.push_back(texture(GL_RGBA32F, GL_RGBA));
        buffer.push_back(texture(GL_RGBA32F, GL_RGBA));
        if (rival_.keeps) {
            buffer.push_back(texture(GL_R32F, GL_RED));
        }
    }
}

Result<void> RivalStep::compile() {
    pass_ = RELIEF_TRY(StepPass::start({.compute = path_ == StepPath::kCompute}, rival_.shader));
    RELIEF_TRY(pass_.finish());
    const GlProgram& program = pass_.program();
    program.use();
    int unit = kFirstUnit;
    for (const Rival::Texture& texture : rival_.textures) {
        program.set(texture.sampler, unit++);
    }
    program.set("u_kept", unit);
    rival_.set(program);
    return {};
}

void RivalStep::begin(const BenchScene& scene) {
    std::vector<glm::vec4> position, velocity, birth;
    for (const Birth& one : scene.births) {
        position.emplace_back(one.position, 0.0F);
        velocity.emplace_back(one.velocity, 0.0F);
        birth.emplace_back(0.0F, one.lifetime, static_cast<float>(one.type), 0.0F);
    }
    const PassState state;
    const auto upload = [&](const GlTexture& texture, const auto& texels, GLenum format = GL_RGBA) {
        useTexture(0, texture);
        glTexSubImage2D(GL_TEXTURE_2D, 0, 0, 0, kWidth, static_cast<GLsizei>(rows_), format, GL_FLOAT,
                        texels.data());
    };
    upload(state_[current_][0], position);
    upload(state_[current_][1], velocity);
    if (rival_.keeps) {
        upload(state_[current_][2], std::vector<float>(position.size(), -1.0F), GL_RED);
    }
    upload(birth_, birth);
    clock_ = 0.0F;
    step();
}

void RivalStep::step() {
    const PassState state;
    const std::size_t next = 1 - current_;
    clock_ += kBenchDt;
    useTexture(StepPass::kPositionUnit, state_[current_][0]);
    useTexture(StepPass::kVelocityUnit, state_[current_][1]);
    useTexture(StepPass::kBirthUnit, birth_);
    int unit = kFirstUnit;
    for (const Rival::Texture& texture : rival_.textures) {
        texture.volume ? useTexture3D(unit++, texture.texture) : useTexture(unit++, texture.texture);
    }
    if (rival_.keeps) {
        useTexture(unit, state_[current_][2]);
    }
    pass_.use({.now = clock_, .dt = kBenchDt, .ground = -1e30F, .forces = forces_, .types = types_});
    if (path_ == StepPath::kCompute) {
        const ImageUnits units;
        ImageUnits::write(0, state_[next][0]);
        ImageUnits::write(1, state_[next][1]);
        if (rival_.keeps) {
            ImageUnits::write(2, state_[next][2], GL_R32F);
        }
        pass_.dispatch(kWidth, rows_);
        ImageUnits::finish();
    } else {
        pass_.draw(target_[next].name(), kWidth, rows_);
    }
    current_ = next;
}

}  // namespace relief

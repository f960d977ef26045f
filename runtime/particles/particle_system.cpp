// SPDX-License-Identifier: Apache-2.0
#include "runtime/particles/particle_system.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <glm/geometric.hpp>
#include <string>

#include "formats/base/finite.h"
#include "runtime/gl/compute_units.h"
#include "runtime/gl/gl_fault.h"
#include "runtime/gl/gl_functions.h"
#include "runtime/gl/pass_state.h"

namespace relief {
namespace {

// A dead particle, as written by step_state.glsl.
constexpr std::array<float, 4> kDeadPosition{0.0F, kDeadHeight, 0.0F, kDeadCollisions};
constexpr std::array<float, 4> kZero{};

// Below every floor and particle, but finite when a height is subtracted.
constexpr float kNoGround = -1e30F;

constexpr std::uint32_t kIdMask = kBirthTypeMax;

Result<void> checkTypes(std::span<const ParticleType> types) {
    const auto finite = [](float value, float low) { return value >= low && std::isfinite(value); };
    for (const ParticleType& type : types) {
        if (!(finite(type.mass, kParticleMassMin) && finite(type.radius, 0.0F) &&
              isFraction(type.restitution) && std::isfinite(type.gravity) &&
              type.collides_with <= kCollidesWithAll && isFraction(type.friction) &&
              finite(type.friction_threshold, 0.0F) && finite(type.lifetime_loss, 0.0F))) {
            return fail(
                ErrorCode::kUsage,
                "a particle type needs finite numbers: a mass of at least 1e-15; a radius, friction "
                "threshold and lifetime loss of at least 0; restitution and friction from 0 to 1. It may "
                "only collide with body groups 0 to 7 and with the ground");
        }
    }
    return {};
}

}  // namespace

Result<ParticleSystem> ParticleSystem::create(const ParticleSystemOptions& options) {
    RELIEF_TRY(checkContext());
    if (options.capacity == 0 || options.capacity > kCapacityMax) {
        return fail(ErrorCode::kUsage, "a particle system of " + std::to_string(options.capacity) +
                                           " particles is not supported; choose 1 to " +
                                           std::to_string(kCapacityMax));
    }
    // The upper limit keeps the resolution of the GPU's clock below 8 ms.
    if (!(options.epoch_seconds > 0.0 && options.epoch_seconds <= 65536.0)) {
        return fail(ErrorCode::kUsage, "epoch_seconds must be above 0 and at most 65536");
    }
    ParticleSystem system(options.capacity);
    if (!std::isfinite(options.start_time)) {
        return fail(ErrorCode::kUsage, "start_time must be finite");
    }
    system.epoch_seconds_ = options.epoch_seconds;
    system.time_ = options.start_time;
    system.epoch_ = options.start_time;
    system.integrator_ = options.integrator;
    system.path_ = RELIEF_TRY(resolvePath(options.path));
    system.width_ = std::min(options.capacity, kStateWidth);
    system.height_ = (options.capacity + system.width_ - 1) / system.width_;
    system.ids_.resize(options.capacity);

    RELIEF_TRY(checkTextureSize(system.width_, system.height_,
                                std::to_string(options.capacity) + " particles",
                                "choose a smaller capacity"));
    const PassState state;
    RELIEF_TRY(system.createTextures());
    RELIEF_TRY(system.createPrograms());
    return system;
}

GlTexture ParticleSystem::makeStateTexture() const {
    const auto width = static_cast<GLsizei>(width_);
    const auto height = static_cast<GLsizei>(height_);
    return path_ == StepPath::kCompute ? makeImageTexture2D(GL_RGBA32F, width, height)
                                       : makeTexture2D(GL_RGBA32F, width, height, GL_RGBA, GL_FLOAT);
}

Result<void> ParticleSystem::createTextures() {
    clearGlErrors();
    birth_ = makeStateTexture();
    for (int i = 0; i < 2; ++i) {
        position_[i] = makeStateTexture();
        velocity_[i] = makeStateTexture();
    }
    RELIEF_TRY(checkAllocated("the state of " + std::to_string(ids_.size()) + " particles",
                              "choose a smaller capacity"));
    RELIEF_TRY(makeStepTargets());
    for (int i = 0; i < 2; ++i) {
        birth_target_[i] = RELIEF_TRY(
            makeFramebuffer(std::array<GLuint, 3>{position_[i].name(), velocity_[i].name(), birth_.name()}));
        glBindFramebuffer(GL_FRAMEBUFFER, birth_target_[i].name());
        glClearBufferfv(GL_COLOR, 0, kDeadPosition.data());
        glClearBufferfv(GL_COLOR, 1, kZero.data());
        glClearBufferfv(GL_COLOR, 2, kZero.data());
    }
    return {};
}

Result<void> ParticleSystem::makeStepTargets() {
    GlFramebuffer made[2];
    for (int i = 0; i < 2; ++i) {
        std::vector<GLuint> textures{position_[i].name(), velocity_[i].name()};
        for (const std::shared_ptr<StepFeature>& feature : features_) {
            for (const GlTexture& output : feature->outputs()) {
                textures.push_back(output.name());
            }
        }
        made[i] = RELIEF_TRY(makeFramebuffer(textures));
    }
    std::swap(step_target_, made);
    return {};
}

Result<void> ParticleSystem::createPrograms() {
    birth_pass_ = RELIEF_TRY(BirthPass::create({width_, height_}, path_));
    rebase_program_ = RELIEF_TRY(makeScreenProgram("particles/rebase.frag"));
    rebase_program_.use();
    rebase_program_.set("u_birth", StepPass::kBirthUnit);
    return {};
}

std::optional<glm::vec3> ParticleSystem::featureWind() const {
    std::optional<glm::vec3> wind;
    for (const std::shared_ptr<StepFeature>& feature : features_) {
        wind = feature->wind() ? feature->wind() : wind;
    }
    return wind;
}

StepVariant ParticleSystem::stepVariant() const {
    StepVariant variant{.collider = collider_,
                        .features = {},
                        .verlet = integrator_ == Integrator::kVerlet,
                        .sweep = sweep_ > 0.0F,
                        .compute = path_ == StepPath::kCompute,
                        .types = static_cast<int>(types_.size())};
    for (const ParticleType& type : types_) {
        variant.radius = variant.radius || (type.radius > 0.0F && collider_ != nullptr);
        variant.masks = variant.masks || type.collides_with != kCollidesWithAll;
    }
    for (const std::shared_ptr<StepFeature>& feature : features_) {
        variant.features.push_back(feature.get());
    }
    return variant;
}

Result<void> ParticleSystem::checkFeatures(const ShaderCollider* collider) const {
    for (const std::shared_ptr<StepFeature>& feature : features_) {
        RELIEF_TRY(feature->check(collider));
    }
    return {};
}

Result<void> ParticleSystem::startStep() {
    StepVariant variant = stepVariant();
    if (step_ && variant == step_->variant()) {
        return {};
    }
    step_.reset();
    step_ = RELIEF_TRY(StepPass::start(std::move(variant)));
    return {};
}

Result<void> ParticleSystem::compileStep() {
    RELIEF_TRY(startStep());
    const Result<void> compiled = step_->finish();
    if (!compiled) {
        step_.reset();
    }
    return compiled;
}

Result<void> ParticleSystem::setForces(const Forces& forces) {
    const auto rate = [](float value) { return value >= 0.0F && std::isfinite(value); };
    if (!isFinite(forces.gravity) || !isFinite(forces.wind)) {
        return fail(ErrorCode::kUsage, "gravity and wind must be finite");
    }
    if (!rate(forces.drag) || !rate(forces.viscosity)) {
        return fail(ErrorCode::kUsage, "drag and viscosity must be finite and at least 0");
    }
    forces_ = forces;
    return {};
}

Result<void> ParticleSystem::setGround(std::optional<float> height) {
    if (height && !std::isfinite(*height)) {
        return fail(ErrorCode::kUsage, "the height of the ground must be finite");
    }
    ground_ = height;
    return {};
}

Result<void> ParticleSystem::setTypes(std::span<const ParticleType> types) {
    if (types.empty() || types.size() > kParticleTypesMax) {
        return fail(ErrorCode::kUsage, std::to_string(types.size()) + " particle types; choose 1 to " +
                                           std::to_string(kParticleTypesMax));
    }
    RELIEF_TRY(checkTypes(types));
    types_.assign(types.begin(), types.end());
    return {};
}

Result<void> ParticleSystem::setSweep(float length) {
    if (!(length >= 0.0F && std::isfinite(length))) {
        return fail(ErrorCode::kUsage, "the length of a sweep must be finite and at least 0");
    }
    sweep_ = length;
    return {};
}

Result<void> ParticleSystem::setCollider(const ShaderCollider* collider) {
    RELIEF_TRY(checkFeatures(collider));
    collider_ = collider;
    step_.reset();  // another collider may have the address of a former one
    return {};
}

Result<void> ParticleSystem::replaceFeature(const StepFeature* old, std::shared_ptr<StepFeature> now) {
    const PassState state;
    const std::vector<std::shared_ptr<StepFeature>> before = features_;
    std::erase_if(features_, [&](const std::shared_ptr<StepFeature>& one) { return one.get() == old; });
    if (now) {
        features_.push_back(std::move(now));
    }
    auto done = checkFeatures(collider_);
    if (done) {
        done = makeStepTargets();
    }
    if (!done) {
        features_ = before;
        static_cast<void>(makeStepTargets());
        return done;
    }
    step_.reset();  // another feature may have the address of a former one
    return {};
}

Result<std::size_t> ParticleSystem::spawn(std::span<const Birth> births) {
    const auto wrong = std::find_if_not(births.begin(), births.end(), isValid);
    if (wrong != births.end()) {
        return fail(ErrorCode::kUsage,
                    "birth " + std::to_string(wrong - births.begin()) +
                        " needs a finite position and velocity, a finite lifetime above 0, a "
                        "finite age of at least 0, and a type below 2^24");
    }
    const float now = clock();
    const glm::vec3 wind = featureWind().value_or(forces_.wind);
    std::size_t accepted = 0;
    for (const Birth& birth : births) {
        const std::optional<std::uint32_t> index = allocator_.acquire();
        if (!index) {
            break;
        }
        const float born = now - birth.age;
        const float death = born + birth.lifetime;
        // Free flight for the particle's age, with the formulas of a step.
        const ParticleType& type = types_[std::min<std::size_t>(birth.type, types_.size() - 1)];
        const float drag = dragRate(forces_, type);
        const glm::vec3 velocity =
            (birth.velocity + birth.age * (type.gravity * forces_.gravity + drag * wind)) *
            (1.0F / (1.0F + birth.age * drag));
        const auto id = static_cast<std::uint32_t>(born_ + accepted);
        for (const std::shared_ptr<StepFeature>& feature : features_) {
            feature->replaced(*index, ids_[*index]);
        }
        ids_[*index] = id;
        deaths_.push(death, *index);
        // Write the members individually: copying a whole vertex would stall on store forwarding.
        BirthPass::Newborn& vertex = newborn_.emplace_back();
        vertex.index = *index;
        vertex.position = birth.position + birth.age * velocity;
        vertex.velocity = velocity;
        vertex.birth = glm::vec4(born, death, static_cast<float>(birth.type & kIdMask),
                                 static_cast<float>(id & kIdMask));
        ++accepted;
    }
    born_ += accepted;
    rejected_ += births.size() - accepted;
    return accepted;
}

Result<void> ParticleSystem::step(float dt) {
    if (!(dt > 0.0F && std::isfinite(dt))) {
        return fail(ErrorCode::kUsage, "the duration of a step must be finite and above 0");
    }
    const PassState state;
    RELIEF_TRY(compileStep());
    runBirths(dt);
    for (const std::shared_ptr<StepFeature>& feature : features_) {
        feature->beforeStep(time_, time_ + static_cast<double>(dt), allocator_.extent(), collider_);
    }
    time_ += static_cast<double>(dt);
    const float now = clock();
    runStep(dt, now);
    freeDead(now);
    if (time_ - epoch_ >= epoch_seconds_) {
        advanceEpoch();
    }
    drawn_extent_ = allocator_.extent();
    return {};
}

float ParticleSystem::clock() const {
    return clockOf(time_);
}

void ParticleSystem::runBirths(float dt) {
    if (newborn_.empty()) {
        return;
    }
    // Round as if the particles had moved at this velocity during the previous step.
    if (integrator_ == Integrator::kVerlet) {
        const float rate = 1.0F / dt;
        for (BirthPass::Newborn& newborn : newborn_) {
            const glm::vec3 before = newborn.position - dt * newborn.velocity;
            newborn.velocity = (newborn.position - before) * rate;
        }
    }
    birth_pass_.run(newborn_, {birth_target_[current_].name(), position_[current_], velocities(), birth_});
    newborn_.clear();
}

void ParticleSystem::runStep(float dt, float now) {
    const std::uint32_t extent = allocator_.extent();
    stepped_extent_ = extent;
    if (extent == 0) {
        return;
    }
    const int next = 1 - current_;
    useTexture(StepPass::kPositionUnit, position_[current_]);
    useTexture(StepPass::kVelocityUnit, velocity_[current_]);
    useTexture(StepPass::kBirthUnit, birth_);
    std::optional<StorageUnits> storage;
    if (step_->usesStorage()) {
        storage.emplace();
    }
    Forces forces = forces_;
    if (featureWind()) {
        forces.wind = glm::vec3(0.0F);  // the feature applies it
    }
    step_->use({now, dt, ground_.value_or(kNoGround), sweep_, time_, forces, types_});
    // Rows beyond the extent keep stale contents in either buffer. This is safe: an index beyond the extent is only
    // reused by a birth, which overwrites it, and indices below it have been stepped since.
    const std::uint32_t rows = (extent + width_ - 1) / width_;
    if (path_ == StepPath::kCompute) {
        const ImageUnits units;
        ImageUnits::write(0, position_[next]);
        ImageUnits::write(1, velocity_[next]);
        int unit = 2;
        for (const std::shared_ptr<StepFeature>& feature : features_) {
            for (const GlTexture& output : feature->outputs()) {
                ImageUnits::write(unit++, output);
            }
        }
        step_->dispatch(width_, rows);
        ImageUnits::finish();
    } else {
        step_->draw(step_target_[next].name(), width_, rows);
    }
    current_ = next;
}

void ParticleSystem::freeDead(float now) {
    dead_.clear();
    deaths_.popUntil(now, dead_);
    for (const std::uint32_t index : dead_) {
        allocator_.release(index);
    }
    died_ += dead_.size();
}

void ParticleSystem::advanceEpoch() {
    const double epochs = std::floor((time_ - epoch_) / epoch_seconds_);
    const auto shift = static_cast<float>(epochs * epoch_seconds_);
    epoch_ += static_cast<double>(shift);
    // The same subtraction of the same floats as in rebase.frag.
    deaths_.rebase(shift);
    if (allocator_.extent() == 0) {
        return;
    }
    if (!birth_spare_) {
        birth_spare_ = makeStateTexture();
        rebase_target_ = makeFramebuffer();
    }
    // Created without checks because a step cannot report this error; create() has tested the combination.
    glBindFramebuffer(GL_FRAMEBUFFER, rebase_target_.name());
    glFramebufferTexture2D(GL_FRAMEBUFFER, GL_COLOR_ATTACHMENT0, GL_TEXTURE_2D, birth_spare_.name(), 0);
    rebase_program_.use();
    useTexture(StepPass::kBirthUnit, birth_);
    rebase_program_.set("u_shift", shift);
    // Include particles that have just died: their events may still be listed.
    const std::uint32_t rows = (std::max(allocator_.extent(), stepped_extent_) + width_ - 1) / width_;
    rebase_program_.drawScreen(rebase_target_.name(), static_cast<GLsizei>(width_),
                               static_cast<GLsizei>(rows));

    std::swap(birth_, birth_spare_);
    for (const GlFramebuffer& target : birth_target_) {
        glBindFramebuffer(GL_FRAMEBUFFER, target.name());
        glFramebufferTexture2D(GL_FRAMEBUFFER, GL_COLOR_ATTACHMENT2, GL_TEXTURE_2D, birth_.name(), 0);
    }
}

ParticleCounts ParticleSystem::counts() const {
    return {born_, died_, rejected_, allocator_.liveCount(), allocator_.extent()};
}

bool isLost(const ParticleState& particle) {
    return !isFinite(particle.position) || !(glm::length(particle.velocity) <= 1e15F);
}

Result<RawState> ParticleSystem::readRaw() const {
    RawState raw;
    const std::uint32_t rows = (drawn_extent_ + width_ - 1) / width_;
    if (rows == 0) {
        return raw;
    }
    const PassState state;
    const auto read = [&](const GlTexture& texture, std::vector<float>& floats) -> Result<void> {
        auto all =
            RELIEF_TRY(readTextureFloats(texture, static_cast<GLsizei>(width_), static_cast<GLsizei>(rows)));
        floats = std::move(all);
        floats.resize(std::size_t{4} * drawn_extent_);
        return {};
    };
    for (auto done :
         {read(positions(), raw.position), read(velocities(), raw.velocity), read(births(), raw.birth)}) {
        if (!done) {
            return forward(done);
        }
    }
    return raw;
}

Result<std::vector<ParticleState>> ParticleSystem::readState() const {
    auto raw = RELIEF_TRY(readRaw());
    std::vector<bool> unborn(drawn_extent_);
    for (const BirthPass::Newborn& vertex : newborn_) {
        if (vertex.index < drawn_extent_) {
            unborn[vertex.index] = true;
        }
    }
    const float now = clock();
    std::vector<ParticleState> particles;
    particles.reserve(allocator_.liveCount());
    for (std::uint32_t index = 0; index < drawn_extent_; ++index) {
        if (!allocator_.isLive(index) || unborn[index]) {
            continue;
        }
        const float* position = &raw.position[std::size_t{4} * index];
        const float* velocity = &raw.velocity[std::size_t{4} * index];
        const float* birth = &raw.birth[std::size_t{4} * index];
        if (position[3] < 0.0F) {  // killed by a collision; the CPU does not track these
            continue;
        }
        ParticleState& particle = particles.emplace_back();
        particle.id = ids_[index];
        particle.index = index;
        particle.position = {position[0], position[1], position[2]};
        particle.velocity = {velocity[0], velocity[1], velocity[2]};
        particle.age = now - birth[0];
        particle.lifetime = birth[1] - birth[0];
        particle.type = static_cast<std::uint32_t>(birth[2]);
        particle.collisions = static_cast<std::uint32_t>(std::max(position[3], 0.0F));
        particle.contact = static_cast<Contact>(std::clamp(static_cast<int>(velocity[3]), 0, 3));
    }
    return particles;
}

}  // namespace relief

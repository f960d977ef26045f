// SPDX-License-Identifier: Apache-2.0
#include "runtime/air/particle_air.h"

#include <memory>
#include <utility>

#include "runtime/air/air_block.h"

namespace relief {
namespace {

constexpr AirBlock::Binding kBinding{6, 1};  // after the step's own bindings

class ParticleAir : public StepFeature {
  public:
    ParticleAir(AirSettings settings, AirBlock block)
        : settings_(std::move(settings)), block_(std::move(block)) {}

    [[nodiscard]] const AirSettings& settings() const { return settings_; }
    [[nodiscard]] std::string defines() const override { return block_.defines(); }
    void attach(const GlProgram& program) const override { block_.attach(program, kBinding); }
    void bind(const GlProgram& program, double time) const override {
        block_.bind(kBinding);
        program.set("u_air_time", airTime(settings_, time));
    }
    [[nodiscard]] std::optional<glm::vec3> wind() const override { return settings_.wind; }

  private:
    AirSettings settings_;
    AirBlock block_;
};

}  // namespace

Result<void> setAir(ParticleSystem& particles, const AirSettings& air) {
    const auto* const old = particles.feature<ParticleAir>();
    if (air == (old == nullptr ? AirSettings{} : old->settings())) {
        return {};  // unchanged: keep the program
    }
    auto block = RELIEF_TRY(AirBlock::create(air));
    if (block.defines().empty()) {
        return old == nullptr ? Result<void>{} : particles.replaceFeature(old, nullptr);
    }
    return particles.replaceFeature(old, std::make_shared<ParticleAir>(air, std::move(block)));
}

}  // namespace relief

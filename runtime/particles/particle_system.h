// SPDX-License-Identifier: Apache-2.0
// The particle simulation: state in float textures, moved by fragment shaders (paper, section 3). Nothing is
// read back and nothing waits for the GPU but in readState().
//
//     bytes on the GPU = 80 · texels, texels = capacity rounded up to whole rows of kStateWidth:
//         position  2 × RGBA32F (double-buffered)      xyz, collisions (−1: dead)
//         velocity  2 × RGBA32F (double-buffered)      xyz, contact of the last step
//         birth     1 × RGBA32F                        time of birth, time of death, type, id mod 2^24
//     (96 · texels once the clock has been set back for the first time; 16 · texels more for each output of a feature)
//
// A step, in this order: births are written into the textures (birth_pass.h); one pass over the occupied rows
// decides deaths, moves and collides (shaders/particles/step.glsl); the CPU frees the indices of the dead.
//
// Time. The CPU counts in double. The GPU sees floats relative to an epoch that is set forward whenever
// epoch_seconds have passed, so that a float resolves half a millisecond even after days. A particle dies at
// the first step whose end is at or after its time of death; that time is one float, made by the CPU, and
// both sides compare the same two floats, so they agree on the step.
#pragma once

#include <cstdint>
#include <glm/vec3.hpp>
#include <memory>
#include <optional>
#include <span>
#include <vector>

#include "formats/base/enum_words.h"
#include "formats/base/result.h"
#include "runtime/collider/shader_collider.h"
#include "runtime/gl/gl_object.h"
#include "runtime/particles/birth.h"
#include "runtime/particles/birth_pass.h"
#include "runtime/particles/death_queue.h"
#include "runtime/particles/index_allocator.h"
#include "runtime/particles/step_feature.h"
#include "runtime/particles/step_pass.h"
#include "runtime/particles/step_path.h"

namespace relief {

/// The integration of velocities; both are of first order, and alike but for rounding.
enum class Integrator : std::uint8_t {
    kEuler,  ///< semi-implicit: v' = v + dt a, P' = P + dt v'
    kVerlet,  ///< P' = P + dt/dt_before (P − P_before) + dt² a: the velocity is the last step's displacement
};
template <>
inline constexpr std::array<std::string_view, 2> kWordsOf<Integrator>{"euler", "verlet"};

struct ParticleSystemOptions {
    std::uint32_t capacity = 65536;  ///< particles that may live at once, 1…kCapacityMax
    Integrator integrator = Integrator::kEuler;
    double epoch_seconds = 4096.0;  ///< how far the GPU's clock runs before it is set back
    StepPath path = StepPath::kAuto;
    double start_time = 0.0;  ///< what time() is at first, seconds; also below 0, where a run is warmed up
};

struct ParticleCounts {
    std::uint64_t born = 0;
    std::uint64_t died = 0;
    std::uint64_t refused = 0;  ///< births without a free index
    std::uint32_t alive = 0;
    std::uint32_t extent = 0;  ///< the largest live index + 1
};

/// One live particle, read back.
struct ParticleState {
    std::uint32_t id = 0;     ///< births before its own, modulo 2^32
    std::uint32_t index = 0;  ///< its texel
    glm::vec3 position{0.0F};
    glm::vec3 velocity{0.0F};
    float age = 0.0F;       ///< seconds
    float lifetime = 0.0F;  ///< seconds
    std::uint32_t type = 0;
    std::uint32_t collisions = 0;      ///< steps in contact so far
    Contact contact = Contact::kNone;  ///< of the last step
};

/// True for a particle that floats no longer hold: a position or velocity that is no number or infinite, or a speed above
/// 10¹⁵ world units a second. Extreme forces send particles there.
[[nodiscard]] bool isLost(const ParticleState& particle);

/// The state textures as they are, four floats a texel, index after index
/// up to the extent. (Texels beyond it hold leftovers, which no renderer may draw.)
struct RawState {
    std::vector<float> position;
    std::vector<float> velocity;
    std::vector<float> birth;
};

class ParticleSystem {
  public:
    static constexpr std::uint32_t kStateWidth = 1024;  ///< texels in a row, fewer if the capacity is
    static constexpr std::uint32_t kCapacityMax = 1U << 24;

    /// Needs a current context, as every call does that is not const.
    /// Errors: kUsage (capacity, epoch), kLimit (above what this GL takes), kUnsupported (also StepPath::kCompute without
    /// compute shaders), kFailure.
    [[nodiscard]] static Result<ParticleSystem> create(const ParticleSystemOptions& options = {});

    /// The colliders from the next step on; compiles the step for it. The particles live in
    /// the object space of a single collider, or in the world of several bodies.
    /// \param collider  must outlive its use by the system; null: nothing.
    /// Errors: kFailure (the driver's compiler).
    [[nodiscard]] Result<void> setCollider(const ShaderCollider* collider);
    /// Errors: kUsage (a number that is not finite, a drag or viscosity below 0); the forces then stay as they were.
    [[nodiscard]] Result<void> setForces(const Forces& forces);
    /// The types of particles: Birth::type is an index here, and the last one for what lies beyond. Compiles
    /// the step where their number changes, or the first gets a radius or collides with less than all.
    /// Errors: kUsage (none or more than kParticleTypesMax; a number that is not finite, a mass below kParticleMassMin, a
    /// negative radius, a share outside 0…1, unknown bits), kFailure (the driver's compiler).
    [[nodiscard]] Result<void> setTypes(std::span<const ParticleType> types);
    [[nodiscard]] Result<void> setType(const ParticleType& type) { return setTypes({&type, 1}); }
    /// Above 0 a step tests its way in pieces no longer than this, world units, and never ends inside what it
    /// did not begin in: nothing crosses a body at rest that is thicker than this. What moves farther than
    /// StepPass::kSweepPieces of them in a step is slowed down. 0: only both ends are tested, as in the paper.
    /// Errors: kUsage, kFailure (the driver's compiler).
    [[nodiscard]] Result<void> setSweep(float length);
    /// A floor: everything below this height is solid, in union with the collider. nullopt: none.
    /// Errors: kUsage (a height that is not finite).
    [[nodiscard]] Result<void> setGround(std::optional<float> height);

    /// The feature of a class; null: none.
    template <class Feature>
    [[nodiscard]] Feature* feature() const {
        for (const std::shared_ptr<StepFeature>& one : features_) {
            if (auto* const found = dynamic_cast<Feature*>(one.get()); found != nullptr) {
                return found;
            }
        }
        return nullptr;
    }
    /// Puts a feature in the place of another, and compiles the step for it. \param old  null: adds it.
    /// \param now  null: removes the old one. Errors: kUsage or kLimit (StepFeature::check), kUnsupported (a GL that draws to
    /// fewer textures), kFailure (the driver's compiler). The system then keeps the features that it had.
    [[nodiscard]] Result<void> replaceFeature(const StepFeature* old, std::shared_ptr<StepFeature> now);

    /// Gives birth at the start of the next step; what has an age then has moved freely, under the forces,
    /// since its own birth. Texels without a particle are taken in ascending order.
    /// \return how many found a place; the rest are refused and counted.
    /// Errors: kUsage (a birth that is not isValid(), by its number; none is made then).
    Result<std::size_t> spawn(std::span<const Birth> births);

    /// Moves everything by `dt` seconds, > 0. Restores the GL state that it touches (runtime/INTEGRATE.md).
    /// Errors: kUsage (another `dt`; nothing has moved then). checkGpu() reports failures of the GPU (gl_fault.h).
    Result<void> step(float dt);

    /// kFragment or kCompute.
    [[nodiscard]] StepPath path() const { return path_; }
    [[nodiscard]] std::uint32_t capacity() const { return allocator_.capacity(); }
    /// Places left for spawn().
    [[nodiscard]] std::uint32_t room() const { return allocator_.capacity() - allocator_.liveCount(); }
    [[nodiscard]] ParticleCounts counts() const;
    [[nodiscard]] double time() const { return time_; }  ///< seconds since time 0
    [[nodiscard]] bool isLive(std::uint32_t index) const { return allocator_.isLive(index); }
    /// ParticleState::id of the last particle that had this index.
    [[nodiscard]] std::uint32_t idOf(std::uint32_t index) const { return ids_[index]; }
    [[nodiscard]] std::span<const ParticleType> types() const { return types_; }
    /// An empty texture of the state's size, RGBA32F, for an output of a feature.
    [[nodiscard]] GlTexture makeStateTexture() const;

    // For renderers: particle i < extent() lies at texel (i mod width, i / width). Births since the last step
    // are not in the textures yet.
    [[nodiscard]] const GlTexture& positions() const { return position_[current_]; }
    [[nodiscard]] const GlTexture& velocities() const { return velocity_[current_]; }
    [[nodiscard]] const GlTexture& births() const { return birth_; }
    /// As they were before the last step.
    [[nodiscard]] const GlTexture& positionsBefore() const { return position_[1 - current_]; }
    [[nodiscard]] std::uint32_t textureWidth() const { return width_; }
    [[nodiscard]] std::uint32_t extent() const { return drawn_extent_; }
    [[nodiscard]] float clock() const;  ///< the time that births() counts in

    /// The live particles in ascending order of index, without those born since the last step. Waits for the
    /// GPU: for dumps and tests.
    /// Errors: kFailure.
    [[nodiscard]] Result<std::vector<ParticleState>> readState() const;
    /// Errors: kFailure.
    [[nodiscard]] Result<RawState> readRaw() const;

  private:
    explicit ParticleSystem(std::uint32_t capacity) : allocator_(capacity) {}
    [[nodiscard]] Result<void> createTextures();
    [[nodiscard]] Result<void> createPrograms();
    /// The wind that a feature adds; nullopt: none does, and Forces::wind acts.
    [[nodiscard]] std::optional<glm::vec3> featureWind() const;
    [[nodiscard]] StepVariant variantFor(const ShaderCollider* collider) const;
    [[nodiscard]] Result<void> remakeStep(const ShaderCollider* collider);
    /// After a change of anything but the collider, which may be another one at the same place.
    [[nodiscard]] Result<void> remakeStepIfNeeded();
    [[nodiscard]] float clockOf(double time) const { return static_cast<float>(time - epoch_); }
    void setEpochForward();
    void runBirths(float dt);
    void runStep(float dt, float now);
    void freeDead(float now);
    /// Of the state and the features' outputs.
    [[nodiscard]] Result<void> makeStepTargets();

    IndexAllocator allocator_;
    DeathQueue deaths_;
    std::vector<std::uint32_t> dead_;          // of the last step, kept for its memory
    std::vector<std::uint32_t> ids_;           // of each index
    std::vector<BirthPass::Newborn> newborn_;  // since the last step
    std::uint32_t stepped_extent_ = 0;         // of the last step: those that died in it included
    std::uint64_t born_ = 0;
    std::uint64_t died_ = 0;
    std::uint64_t refused_ = 0;
    double time_ = 0.0;
    double epoch_ = 0.0;
    double epoch_seconds_ = 0.0;

    StepPath path_ = StepPath::kFragment;
    Integrator integrator_ = Integrator::kEuler;
    Forces forces_;
    std::vector<ParticleType> types_{ParticleType{}};
    float sweep_ = 0.0F;
    std::optional<float> ground_;
    std::vector<std::shared_ptr<StepFeature>> features_;

    std::uint32_t width_ = 0;
    std::uint32_t height_ = 0;
    std::uint32_t drawn_extent_ = 0;  // the extent after the last step
    int current_ = 0;                 // which of the buffers holds the state
    GlTexture position_[2];
    GlTexture velocity_[2];
    GlTexture birth_;
    GlTexture birth_spare_;          // made when the clock is first set back
    GlFramebuffer step_target_[2];   // position, velocity and the features' outputs
    GlFramebuffer birth_target_[2];  // position, velocity, birth
    GlFramebuffer rebase_target_;    // birth_spare_
    BirthPass birth_pass_;
    GlProgram rebase_program_;
    StepPass step_;
};

}  // namespace relief

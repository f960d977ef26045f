// SPDX-License-Identifier: Apache-2.0
// The particle simulation: state in float textures, advanced by fragment or compute shaders (paper, section 3). Only
// readState() and readRaw() read back data or wait for the GPU.
//
//     bytes on the GPU = 80 · texels; texels = capacity rounded up to whole rows of kStateWidth:
//         position  2 × RGBA32F (double-buffered)      xyz, collisions (−1: dead)
//         velocity  2 × RGBA32F (double-buffered)      xyz, contact of the last step
//         birth     1 × RGBA32F                        time of birth, time of death, type, id mod 2^24
//     (96 · texels after the clock has been set back for the first time; 16 · texels more for each feature output)
//
// Order of a step: births are written into the textures (birth_pass.h); one pass over the occupied rows removes dead
// particles, moves the others and collides them (shaders/particles/step.glsl); the CPU frees the indices of the dead.
//
// Time: the CPU uses doubles. The GPU uses floats relative to an epoch, which advances every epoch_seconds, so that
// a float resolves half a millisecond even after days. A particle dies in the first step that ends at or after its time
// of death. CPU and GPU agree on this step because both compare the same two floats, computed by the CPU.
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

/// Velocity integration. Both methods are first-order, and their results differ only by rounding.
enum class Integrator : std::uint8_t {
    kEuler,  ///< semi-implicit: v' = v + dt a, P' = P + dt v'
    kVerlet,  ///< P' = P + dt/dt_before (P − P_before) + dt² a; the velocity is the displacement of the last step
};
template <>
inline constexpr std::array<std::string_view, 2> kWordsOf<Integrator>{"euler", "verlet"};

struct ParticleSystemOptions {
    std::uint32_t capacity = 65536;  ///< maximum live particles, 1…kCapacityMax
    Integrator integrator = Integrator::kEuler;
    double epoch_seconds = 4096.0;  ///< seconds until the GPU's clock is set back
    StepPath path = StepPath::kAuto;
    double start_time = 0.0;  ///< initial time(), seconds; negative for a warm-up
};

struct ParticleCounts {
    std::uint64_t born = 0;
    std::uint64_t died = 0;
    std::uint64_t rejected = 0;  ///< births without a free index
    std::uint32_t alive = 0;
    std::uint32_t extent = 0;  ///< largest live index + 1
};

/// A live particle, read back.
struct ParticleState {
    std::uint32_t id = 0;     ///< number of earlier births, modulo 2^32
    std::uint32_t index = 0;  ///< index of its texel
    glm::vec3 position{0.0F};
    glm::vec3 velocity{0.0F};
    float age = 0.0F;       ///< seconds
    float lifetime = 0.0F;  ///< seconds
    std::uint32_t type = 0;
    std::uint32_t collisions = 0;      ///< number of steps in contact
    Contact contact = Contact::kNone;  ///< in the last step
};

/// Returns true if a particle exceeds the range of floats: a position or velocity that is NaN or infinite, or a speed
/// above 10¹⁵ world units/s. Extreme forces can cause this.
[[nodiscard]] bool isLost(const ParticleState& particle);

/// The raw state textures, four floats per texel, in order of index up to the extent. (Texels beyond it contain stale
/// data, which renderers must not draw.)
struct RawState {
    std::vector<float> position;
    std::vector<float> velocity;
    std::vector<float> birth;
};

class ParticleSystem {
  public:
    static constexpr std::uint32_t kStateWidth = 1024;  ///< texels per row; fewer if the capacity is smaller
    static constexpr std::uint32_t kCapacityMax = 1U << 24;

    /// Every call that is not const, except spawn(), needs a current context, as do readState(), readRaw() and
    /// makeStateTexture().
    /// Errors: kUsage (capacity, epoch), kLimit (more than this GL context supports), kUnsupported (also
    /// StepPath::kCompute without compute shaders), kFailure.
    [[nodiscard]] static Result<ParticleSystem> create(const ParticleSystemOptions& options = {});

    /// Sets the colliders for subsequent steps. Particles are in the object space of a single collider, or in the world
    /// space of several bodies. The next step compiles a program for the colliders. A step also compiles a program if
    /// the features, the number of types, or the use of radii, collision masks or sweeps has changed.
    /// \param collider  must outlive its use by the system; null: none.
    /// Errors: those of StepFeature::check(); the colliders are then unchanged.
    [[nodiscard]] Result<void> setCollider(const ShaderCollider* collider);
    /// Sets the forces. Errors: kUsage (a number that is not finite, a negative drag or viscosity); the forces are then
    /// unchanged.
    [[nodiscard]] Result<void> setForces(const Forces& forces);
    /// Sets the particle types. Birth::type is an index into them; larger values use the last one.
    /// Errors: kUsage (none or more than kParticleTypesMax, a number that is not finite, a mass below kParticleMassMin,
    /// a negative radius, friction threshold or lifetime loss, restitution or friction outside 0…1, unknown bits in
    /// collides_with).
    [[nodiscard]] Result<void> setTypes(std::span<const ParticleType> types);
    [[nodiscard]] Result<void> setType(const ParticleType& type) { return setTypes({&type, 1}); }
    /// Sets the sweep length, world units. If above 0, a step tests its path in pieces of at most this length and never
    /// ends inside a solid in which it did not start: particles cannot cross static bodies thicker than this. Particles
    /// that move more than StepPass::kSweepPieces pieces in a step are slowed down. If the length is 0, a step tests
    /// only the end of its path, as in the paper.
    /// Errors: kUsage.
    [[nodiscard]] Result<void> setSweep(float length);
    /// Sets a floor: everything below this height is solid, in addition to the collider. nullopt: none.
    /// Errors: kUsage (a height that is not finite).
    [[nodiscard]] Result<void> setGround(std::optional<float> height);

    /// Returns the feature of a class, or null.
    template <class Feature>
    [[nodiscard]] Feature* feature() const {
        for (const std::shared_ptr<StepFeature>& one : features_) {
            if (auto* const found = dynamic_cast<Feature*>(one.get()); found != nullptr) {
                return found;
            }
        }
        return nullptr;
    }
    /// Replaces a feature.
    /// \param old  null: adds `now`.
    /// \param now  null: removes `old`.
    /// Errors: kUsage or kLimit (StepFeature::check), kUnsupported (too few draw buffers). The features are then
    /// unchanged.
    [[nodiscard]] Result<void> replaceFeature(const StepFeature* old, std::shared_ptr<StepFeature> now);

    /// Adds births for the start of the next step. A birth with an age first moves for this time, under the forces
    /// and without collisions. Free texels are used in ascending order.
    /// \return the number of births added; the others are rejected and counted.
    /// Errors: kUsage (a birth that is not isValid(), named by its index; none is added then).
    Result<std::size_t> spawn(std::span<const Birth> births);

    /// Starts to compile the program of the next step; without it, step() starts and waits. Call it after all settings.
    /// Drivers compile in the background only if glMaxShaderCompilerThreadsKHR() enabled it, as GlContext does.
    /// Errors: kFailure (a shader file is missing).
    Result<void> startStep();

    /// Advances the simulation by `dt` seconds, > 0. Restores the GL state that it changes (runtime/INTEGRATE.md).
    /// Errors: kUsage (an invalid `dt`), kFailure (a program does not compile); nothing moves then. checkGpu() reports
    /// GPU failures (gl_fault.h).
    Result<void> step(float dt);

    /// Returns kFragment or kCompute.
    [[nodiscard]] StepPath path() const { return path_; }
    [[nodiscard]] std::uint32_t capacity() const { return allocator_.capacity(); }
    /// Returns the free capacity for spawn().
    [[nodiscard]] std::uint32_t room() const { return allocator_.capacity() - allocator_.liveCount(); }
    [[nodiscard]] ParticleCounts counts() const;
    [[nodiscard]] double time() const { return time_; }  ///< seconds since time 0
    [[nodiscard]] bool isLive(std::uint32_t index) const { return allocator_.isLive(index); }
    /// Returns the ParticleState::id of the last particle with this index.
    [[nodiscard]] std::uint32_t idOf(std::uint32_t index) const { return ids_[index]; }
    [[nodiscard]] std::span<const ParticleType> types() const { return types_; }
    /// Creates an RGBA32F texture of the state's size with undefined contents, for the output of a feature.
    [[nodiscard]] GlTexture makeStateTexture() const;

    // For renderers: particle i < extent() is at texel (i mod width, i / width). Births since the last step are not in
    // the textures yet.
    [[nodiscard]] const GlTexture& positions() const { return position_[current_]; }
    [[nodiscard]] const GlTexture& velocities() const { return velocity_[current_]; }
    [[nodiscard]] const GlTexture& births() const { return birth_; }
    /// The positions before the last step.
    [[nodiscard]] const GlTexture& positionsBefore() const { return position_[1 - current_]; }
    [[nodiscard]] std::uint32_t textureWidth() const { return width_; }
    [[nodiscard]] std::uint32_t extent() const { return drawn_extent_; }
    [[nodiscard]] float clock() const;  ///< time() on the GPU's clock, as used in births()

    /// Reads the live particles in ascending order of index, without births since the last step. Waits for the GPU; for
    /// dumps and tests.
    /// Errors: kFailure.
    [[nodiscard]] Result<std::vector<ParticleState>> readState() const;
    /// Reads the raw state textures. Waits for the GPU. Errors: kFailure.
    [[nodiscard]] Result<RawState> readRaw() const;

  private:
    explicit ParticleSystem(std::uint32_t capacity) : allocator_(capacity) {}
    [[nodiscard]] Result<void> createTextures();
    [[nodiscard]] Result<void> createPrograms();
    /// Returns the wind of a feature, which replaces Forces::wind; nullopt if no feature has wind.
    [[nodiscard]] std::optional<glm::vec3> featureWind() const;
    [[nodiscard]] Result<void> checkFeatures(const ShaderCollider* collider) const;
    [[nodiscard]] StepVariant stepVariant() const;
    /// Compiles the program for the current settings, unless it is already compiled.
    [[nodiscard]] Result<void> compileStep();
    [[nodiscard]] float clockOf(double time) const { return static_cast<float>(time - epoch_); }
    void advanceEpoch();
    void runBirths(float dt);
    void runStep(float dt, float now);
    void freeDead(float now);
    /// Creates framebuffers with the state and the features' outputs.
    [[nodiscard]] Result<void> makeStepTargets();

    IndexAllocator allocator_;
    DeathQueue deaths_;
    std::vector<std::uint32_t> dead_;          // in the last step; kept to avoid reallocation
    std::vector<std::uint32_t> ids_;           // indexed by texel
    std::vector<BirthPass::Newborn> newborn_;  // since the last step
    std::uint32_t stepped_extent_ = 0;         // in the last step, including particles that died in it
    std::uint64_t born_ = 0;
    std::uint64_t died_ = 0;
    std::uint64_t rejected_ = 0;
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
    std::uint32_t drawn_extent_ = 0;  // extent after the last step
    int current_ = 0;                 // buffer that holds the state
    GlTexture position_[2];
    GlTexture velocity_[2];
    GlTexture birth_;
    GlTexture birth_spare_;          // created when the clock is first set back
    GlFramebuffer step_target_[2];   // position, velocity and feature outputs
    GlFramebuffer birth_target_[2];  // position, velocity, birth
    GlFramebuffer rebase_target_;    // birth_spare_
    BirthPass birth_pass_;
    GlProgram rebase_program_;
    const ShaderCollider* collider_ = nullptr;
    std::optional<StepPass> step_;  // nullopt: not started; compiled once step() has finished it
};

}  // namespace relief

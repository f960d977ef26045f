// The hits of a run as lines of JSON, which grow while it goes on.
#pragma once

#include <cstdint>
#include <cstdio>
#include <filesystem>
#include <memory>
#include <optional>
#include <span>
#include <string>

#include "formats/base/result.h"
#include "formats/fields/field.h"
#include "runtime/particles/particle_event.h"

namespace relief {

class EventsLog {
  public:
    /// \param path       "-" for standard output
    /// \param min_speed  slower hits are left out
    /// Errors: kIo.
    [[nodiscard]] static Result<EventsLog> create(const std::filesystem::path& path, float min_speed);

    /// A line for each hit where the step before touched nothing. The tag is the number of the step.
    /// \param materials  ColliderTextures::materialNames()
    /// Errors: kIo.
    [[nodiscard]] Result<void> write(const StepEvents& step, std::span<const std::string> materials);
    /// Errors: kIo.
    [[nodiscard]] Result<void> finish();

    /// Hits beyond the capacity of a step's list.
    [[nodiscard]] std::uint64_t dropped() const { return dropped_; }

  private:
    struct Close {
        void operator()(std::FILE* file) const;
    };
    [[nodiscard]] Result<void> writeError() const;

    std::filesystem::path path_;
    std::unique_ptr<std::FILE, Close> file_;
    float min_speed_ = 0.0F;
    std::uint64_t dropped_ = 0;
};

// --- The lines as fields.

struct HitLine {
    const ParticleEvent& hit = kNone<ParticleEvent>;
    std::uint64_t step = 1;
    std::span<const std::string> materials = {};  ///< ColliderTextures::materialNames()
};

template <class Visitor, FieldsOf<HitLine> L>
void fields(Visitor& visit, L& line) {
    const auto& [hit, step, materials] = line;
    const auto known = static_cast<std::size_t>(hit.material);
    visit("step", step, {"Number of the step, from 1", {}, kFromOne});
    visit("time", hit.time, {"Time of the scene", "s", kFromZero});
    visit("id", hit.id, {"Particle, as in dumps"});
    visit("type", hit.type, {"Type of the particle, as in dumps"});
    visit("body", onlyIf(hit.body >= 0, hit.body),
          {"Collider of the scene, from 0; null: the ground", {}, kFromZero});
    visit("material", known < materials.size() ? std::optional(materials[known]) : std::nullopt,
          {"Name of the material there; null: the collider has none, or the ground"});
    visit("position", hit.position, {"Point where the particle touched the surface", "world units"});
    visit("normal", hit.normal, {"Normal of the surface, out of the body, of length 1"});
    visit("velocity", hit.velocity, {"Velocity of the particle before the hit", "world units per second"});
    visit(
        "speed", hit.speed,
        {"Speed of approach along the normal, relative to the surface", "world units per second", kFromZero});
}

}  // namespace relief

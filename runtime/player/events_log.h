// SPDX-License-Identifier: Apache-2.0
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
#include "runtime/events/event_recorder.h"
#include "runtime/events/particle_event.h"

namespace relief {

class EventsLog {
  public:
    /// \param path       "-" for standard output
    /// \param min_speed  slower hits are left out
    /// Errors: kIo.
    [[nodiscard]] static Result<EventsLog> create(const std::filesystem::path& path, float min_speed);

    /// A line for each hit where the step before touched nothing. The tag is the number of the step.
    /// \param materials  WorldTextures::materialNames()
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
    std::span<const std::string> materials = {};  ///< WorldTextures::materialNames()
};

void fields(FieldVisitor& visit, const HitLine& line);

}  // namespace relief

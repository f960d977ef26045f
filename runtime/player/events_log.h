// SPDX-License-Identifier: Apache-2.0
// Writes the hits of a run as lines of JSON while it is running.
#pragma once

#include <cstdint>
#include <cstdio>
#include <filesystem>
#include <memory>
#include <span>
#include <string>

#include "formats/base/result.h"
#include "formats/fields/field.h"
#include "runtime/events/event_recorder.h"
#include "runtime/events/particle_event.h"

namespace relief {

class EventsLog {
  public:
    /// \param path       "-" for standard output.
    /// \param min_speed  world units/s; slower hits are omitted.
    /// Errors: kIo.
    [[nodiscard]] static Result<EventsLog> create(const std::filesystem::path& path, float min_speed);

    /// Writes a line for each new contact. \param step  with the step number as its tag.
    /// \param materials  WorldTextures::materialNames().
    /// Errors: kIo.
    [[nodiscard]] Result<void> write(const StepEvents& step, std::span<const std::string> materials);
    /// Flushes the file. Errors: kIo.
    [[nodiscard]] Result<void> finish();

    /// Returns the number of hits lost because the list of a step was full.
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

// --- fields of a line

struct HitLine {
    const ParticleEvent& hit = kNone<ParticleEvent>;
    std::uint64_t step = 1;
    std::span<const std::string> materials = {};  ///< WorldTextures::materialNames()
};

void fields(FieldVisitor& visit, const HitLine& line);

}  // namespace relief

// The hits of a run as lines of JSON, written while it goes on.
#pragma once

#include <cstdint>
#include <cstdio>
#include <filesystem>
#include <memory>

#include "formats/base/result.h"
#include "runtime/particles/particle_event.h"

namespace relief {

class EventsLog {
  public:
    /// \param path       "-" for standard output. Like statistics it grows line by line.
    /// \param min_speed  slower hits are left out.
    /// Errors: kIo.
    [[nodiscard]] static Result<EventsLog> create(const std::filesystem::path& path, float min_speed);

    /// A line for each hit where the step before touched nothing. The tag is the number of the step.
    /// Errors: kIo.
    [[nodiscard]] Result<void> write(const StepEvents& step);
    /// Errors: kIo.
    [[nodiscard]] Result<void> finish();

    /// Hits that the list of a step had no room for.
    [[nodiscard]] std::uint64_t dropped() const { return dropped_; }

  private:
    struct Close {
        void operator()(std::FILE* file) const;
    };
    [[nodiscard]] Result<void> writeError() const;

    std::filesystem::path path_;
    float min_speed_ = 0.0F;
    std::unique_ptr<std::FILE, Close> file_;
    std::uint64_t dropped_ = 0;
};

}  // namespace relief

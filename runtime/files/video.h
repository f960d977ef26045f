// Pictures as a video, through the program ffmpeg: it is started without a shell and takes raw pixels from a
// pipe.
#pragma once

#include <cstdint>
#include <filesystem>
#include <memory>
#include <span>

#include "formats/base/result.h"

namespace relief {

struct VideoOptions {
    std::uint32_t width = 0;  ///< pixels, 1…65535, as is the height; ffmpeg pads odd ones by a row or column
    std::uint32_t height = 0;
    double frames_per_second = 30.0;  ///< above 0
};

/// Writes beside the video under a name of its own, and renames it when ffmpeg has succeeded: an older video
/// stays as it was until then. Dropped without finish(), it leaves nothing behind.
class VideoWriter {
  public:
    /// Finds ffmpeg on PATH and starts it.
    /// \param path  ends in .mp4, .mkv, .mov or .webm, which says what ffmpeg writes.
    /// Errors: kUsage (size, rate, another ending), kIo (no such folder, a folder of that name),
    /// kUnsupported (no ffmpeg).
    [[nodiscard]] static Result<std::unique_ptr<VideoWriter>> create(const std::filesystem::path& path,
                                                                     const VideoOptions& options);
    ~VideoWriter();
    VideoWriter(const VideoWriter&) = delete;
    VideoWriter& operator=(const VideoWriter&) = delete;

    /// \param rgb  3 · width · height bytes, sRGB, the top row first. Waits until ffmpeg has taken them.
    /// Errors: kUsage (another size), kFailure (ffmpeg has ended; with its words).
    [[nodiscard]] Result<void> add(std::span<const std::uint8_t> rgb);

    /// Waits for ffmpeg and puts the video in its place. Call once, last.
    /// Errors: kFailure (with ffmpeg's words), kIo.
    [[nodiscard]] Result<void> finish();

    /// Ends ffmpeg at once and removes what it has written: for a process that is about to end without
    /// destructors, from any thread while no other member runs. The writer is of no use any more.
    void abandon();

  private:
    VideoWriter() = default;
    struct Impl;
    std::unique_ptr<Impl> impl_;
};

}  // namespace relief

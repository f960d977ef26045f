// SPDX-License-Identifier: Apache-2.0
// Runs relief-import on one file within limits, and reports how it ended.
#pragma once

#include <array>
#include <chrono>
#include <cstddef>
#include <cstdint>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "bake/import/import_job.h"
#include "formats/base/descriptor.h"
#include "formats/base/process.h"
#include "formats/base/result.h"

namespace relief {

/// Creates a memfd. Returns an empty descriptor on failure, with errno set.
[[nodiscard]] Descriptor memoryFile(std::uint64_t size);
/// Creates a sealed memfd with a copy of a file's bytes. Returns an empty descriptor on failure, with errno set.
[[nodiscard]] Descriptor sharedBytes(std::span<const std::byte> bytes);

/// A worker process. Errors omit the file name.
class ImportProcess {
  public:
    /// Prepares a worker.
    /// \param noun     the kind of file, for messages: "mesh".
    /// \param smaller  advice for a file that is too large: "simplify the mesh".
    ImportProcess(const char* noun, const char* smaller, const ImportLimits& limits)
        : noun_(noun), smaller_(smaller), limits_(limits), left_(std::chrono::seconds(limits.seconds)) {}

    [[nodiscard]] Result<void> checkLimits() const;
    /// Starts the worker.
    /// \param kind   a name of ImportKind, or kImportImage.
    /// \param more   further arguments.
    /// \param files  descriptors to pass as kImportMeshFd and the following numbers; -1: /dev/null.
    /// Errors: kFailure.
    [[nodiscard]] Result<void> start(const std::string& path, std::string_view kind,
                                     const std::vector<std::string>& more, const std::array<int, 4>& files);
    /// Waits for poll() events. Errors: kLimit (the total time of all waits reached the limit).
    [[nodiscard]] Result<void> await(int pipe, short events);
    /// Waits for the worker to end. \param begun  the worker has written its first byte. Errors: the worker ended
    /// without a complete result.
    [[nodiscard]] Result<void> finish(bool begun);

    [[nodiscard]] const ImportLimits& limits() const { return limits_; }
    [[nodiscard]] static tl::unexpected<Error> notStarted(int number);

  private:
    [[nodiscard]] tl::unexpected<Error> timeoutError() const;
    [[nodiscard]] tl::unexpected<Error> ended(int number) const;
    [[nodiscard]] tl::unexpected<Error> unreadable(const std::string& what) const;

    const char* noun_;
    const char* smaller_;
    ImportLimits limits_;
    std::chrono::steady_clock::duration left_;
    Process worker_;
};

}  // namespace relief

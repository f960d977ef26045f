// SPDX-License-Identifier: Apache-2.0
// The program relief-import at work on one file: started within limits, and how it ended in words.
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

/// Empty on failure, with errno.
[[nodiscard]] Descriptor memoryFile(std::uint64_t size);
/// A sealed copy of a file's bytes for the worker. Empty on failure, with errno.
[[nodiscard]] Descriptor sharedBytes(std::span<const std::byte> bytes);

/// Errors are without the file's name.
class ImportProcess {
  public:
    /// \param noun     what the file is, for messages: "mesh".
    /// \param smaller  what helps if it is too large: "simplify the mesh".
    ImportProcess(const char* noun, const char* smaller, const ImportLimits& limits)
        : noun_(noun), smaller_(smaller), limits_(limits), left_(std::chrono::seconds(limits.seconds)) {}

    /// Errors: kUsage.
    [[nodiscard]] Result<void> checkLimits() const;
    /// \param kind   a word of ImportKind, or kImportImage.
    /// \param more   arguments behind it.
    /// \param files  for kImportMeshFd and the numbers behind it; -1: none, /dev/null.
    /// Errors: kFailure.
    [[nodiscard]] Result<void> start(const std::string& path, std::string_view kind,
                                     const std::vector<std::string>& more, const std::array<int, 4>& files);
    /// Waits for events of poll(). Errors: kLimit: all waits together have lasted as long as the limits allow.
    [[nodiscard]] Result<void> await(int pipe, short events);
    /// Waits for its end. \param begun  it has written its first byte. Errors: it ended otherwise than after a whole answer.
    [[nodiscard]] Result<void> finish(bool begun);

    [[nodiscard]] const ImportLimits& limits() const { return limits_; }
    [[nodiscard]] static tl::unexpected<Error> notStarted(int number);

  private:
    [[nodiscard]] tl::unexpected<Error> timeIsUp() const;
    [[nodiscard]] tl::unexpected<Error> ended(int number) const;
    [[nodiscard]] tl::unexpected<Error> unreadable(const std::string& what) const;

    const char* noun_;
    const char* smaller_;
    ImportLimits limits_;
    std::chrono::steady_clock::duration left_;
    Process worker_;
};

}  // namespace relief

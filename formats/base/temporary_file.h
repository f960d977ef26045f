// SPDX-License-Identifier: Apache-2.0
// The file that a new version is written into before it takes the place of the older one.
#pragma once

#include <sys/types.h>

#include <filesystem>
#include <optional>
#include <span>

#include "formats/base/descriptor.h"

namespace relief {

/// A temporary file beside the file that it will replace, `.relief-PID-N-RANDOM.tmp`. Removed unless it has been renamed: by
/// the destructor, and by removeAll(). After SIGKILL or a power cut it stays, until removeLeftovers().
class TemporaryFile {
  public:
    TemporaryFile() = default;
    TemporaryFile(const TemporaryFile&) = delete;
    TemporaryFile& operator=(const TemporaryFile&) = delete;
    ~TemporaryFile();

    /// All members: \return 0 or an errno.
    [[nodiscard]] int create(const std::filesystem::path& folder, mode_t mode);
    /// Writes, sets the permissions, syncs. The file stays locked until renameTo().
    [[nodiscard]] int fill(std::span<const std::byte> bytes, std::optional<mode_t> mode);
    [[nodiscard]] int renameTo(const std::filesystem::path& target);

    /// Removes all of this process, before it ends. Safe in a signal handler.
    static void removeAll();

    /// Removes those in a folder whose process has ended: own regular files of exactly such a name that no process has locked,
    /// so that those of another machine or container stay while they are written.
    static void removeLeftovers(const std::filesystem::path& folder);

  private:
    struct Slot;

    [[nodiscard]] int createOnce(const std::filesystem::path& folder, mode_t mode);

    Descriptor file_;
    Descriptor lock_;       // of the closed file, for the time until it is renamed
    Slot* slot_ = nullptr;  // of the list of names
};

/// For the start of main(): SIGINT, SIGTERM, SIGHUP and SIGQUIT remove the temporary files, then end the program as
/// they would have done anyway; a shell reports 128 + n. One that is ignored, as by nohup, stays ignored. SIGXFSZ is ignored:
/// the write that failed reports EFBIG.
void endCleanlyOnSignals();

}  // namespace relief

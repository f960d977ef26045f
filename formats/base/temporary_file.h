// SPDX-License-Identifier: Apache-2.0
// Temporary file for atomic replacement.
#pragma once

#include <sys/types.h>

#include <filesystem>
#include <optional>
#include <span>

#include "formats/base/descriptor.h"

namespace relief {

/// A temporary file, `.relief-PID-N-RANDOM.tmp`, beside the file that it will replace. The destructor and removeAll()
/// remove it unless it was renamed. After SIGKILL or a power failure it remains until removeLeftovers().
class TemporaryFile {
  public:
    ~TemporaryFile();

    /// create(), fill() and renameTo() return 0 or an errno.
    [[nodiscard]] int create(const std::filesystem::path& folder, mode_t mode);
    /// Writes the bytes, sets the permissions and syncs. The file stays locked until renameTo().
    [[nodiscard]] int fill(std::span<const std::byte> bytes, std::optional<mode_t> mode);
    [[nodiscard]] int renameTo(const std::filesystem::path& target);

    /// Removes all temporary files of this process. Safe in a signal handler.
    static void removeAll();

    /// Removes the temporary files of ended processes from a folder: regular files of this user that are named as above
    /// and not locked. The lock protects files that another machine or container is writing.
    static void removeLeftovers(const std::filesystem::path& folder);

  private:
    struct Slot;

    [[nodiscard]] int createOnce(const std::filesystem::path& folder, mode_t mode);

    Descriptor file_;
    Descriptor lock_;       // keeps the file locked from fill() to renameTo()
    Slot* slot_ = nullptr;  // entry in the list of names
};

/// Call at the start of main(). SIGINT, SIGTERM, SIGHUP and SIGQUIT then remove the temporary files before their
/// default action; a shell reports 128 + the signal number. Ignored signals, as under nohup, stay ignored. SIGXFSZ is
/// ignored so that the failed write reports EFBIG.
void endCleanlyOnSignals();

}  // namespace relief

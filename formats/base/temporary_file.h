// The file that a new version is written into before it takes the place of the older one.
#pragma once

#include <sys/types.h>

#include <filesystem>
#include <optional>
#include <span>

#include "formats/base/descriptor.h"

namespace relief {

/// A temporary file beside the file that it will replace, `.relief-PID-N-RANDOM.tmp`. Removed unless it has
/// been renamed: by the destructor, by a signal that removeTemporaryFiles() is called for, and after SIGKILL
/// or a power cut by the next program that writes into the folder. Its writer holds a lock on it (flock), so
/// that no other program takes it for a dead one's.
///
/// O_TMPFILE would need no name until the end, but a name then: linkat replaces no file. And not all file
/// systems have it.
class TemporaryFile {
  public:
    TemporaryFile() = default;
    TemporaryFile(const TemporaryFile&) = delete;
    TemporaryFile& operator=(const TemporaryFile&) = delete;
    ~TemporaryFile();

    /// All members: \return 0 or an errno.
    [[nodiscard]] int create(const std::filesystem::path& folder, mode_t mode);
    /// Writes, sets the permissions, syncs.
    [[nodiscard]] int fill(std::span<const std::byte> bytes, std::optional<mode_t> mode);
    [[nodiscard]] int renameTo(const std::filesystem::path& target);

  private:
    [[nodiscard]] int createNamed(const std::filesystem::path& name, mode_t mode);
    void forget();

    std::filesystem::path name_;
    Descriptor file_;
    Descriptor lock_;  // the same file again, for the lock has to outlive file_
    int slot_ = -1;
};

/// Removes the temporary files of this process. For a signal handler that ends the program: calls only what
/// is safe there, and whoever creates such a file afterwards stands still. Waits for those that are being
/// created, for a second at most.
void removeTemporaryFiles();

/// Removes temporary files in a folder whose writers are dead. What cannot be locked or removed stays.
void removeStaleTemporaryFiles(const std::filesystem::path& folder);

}  // namespace relief

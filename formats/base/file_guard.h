// SPDX-License-Identifier: Apache-2.0
// Prevents an output of a run from replacing an input, a cache file or another output of that run.
#pragma once

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <functional>
#include <map>
#include <memory>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "formats/base/result.h"

namespace relief {

/// Names of a numbered series of files, such as frames/frame_0000.png.
struct NumberedFiles {
    std::filesystem::path folder;
    std::string head;         ///< "frame_"
    std::string ending;       ///< ".png"
    std::uint32_t count = 0;  ///< numbers start at 0

    /// Returns the path of a file; its number is padded to four digits.
    [[nodiscard]] std::filesystem::path path(std::uint32_t number) const;
    /// Returns whether a file name belongs to the series.
    [[nodiscard]] bool hold(const std::string& name) const;
};

/// All present and future files with this ending in a folder, such as the containers of a world.
struct FilesByEnding {
    std::filesystem::path folder;
    std::string ending;  ///< ".relief"
};

/// Compares files by identity, not by name: it resolves symbolic links (including dangling ones), hard links, and the
/// files behind standard input and output. Register every file before writing the first one. Devices may be registered
/// any number of times.
class FileGuard {
  public:
    enum class Use : std::uint8_t {
        kRead,
        kWritten,
        kOneOfMany,  ///< an output in NumberedFiles or FilesByEnding
        kKept,       ///< registered by keeps()
    };
    /// A file that the run reads or writes.
    struct File {
        std::filesystem::path path;  ///< as the user gave it
        std::string option;          ///< option of an output; empty for inputs
        Use use = Use::kWritten;
    };

    /// Registers an input. "-" is standard input; an empty path is ignored.
    /// Errors: kUsage if it is an output.
    [[nodiscard]] Result<void> reads(const std::filesystem::path& path);
    /// Registers an output. "-" is standard output; an empty path is ignored.
    /// \param option  the option that names the file, for messages: "--dump".
    /// \param made    a folder that the run creates (with its parents) and fills; may contain the file.
    /// Errors: those of preflightFile; kUsage if it is an input, another output, or a link out of `made`.
    [[nodiscard]] Result<void> writes(const std::filesystem::path& path, std::string_view option,
                                      const std::filesystem::path& made = {});
    /// Registers files in a folder. The folder need not exist. Errors: kUsage, as above, or if one of the files is a
    /// link that leaves the folder; kIo (the folder's path cannot be followed).
    [[nodiscard]] Result<void> writes(const NumberedFiles& files, std::string_view option);
    [[nodiscard]] Result<void> writes(const FilesByEnding& files, std::string_view option);
    /// Creates a folder for outputs with preflightFolder(). The destructor of the guard's last copy removes the created
    /// folders that are still empty, unless keepFolders() was called.
    [[nodiscard]] Result<void> makes(const std::filesystem::path& folder, std::string_view option);
    void keepFolders() { folders_->made.clear(); }
    /// Registers a cache file. A link at that path is replaced, not followed. Several caches may share one file, and
    /// the folder need not exist. \param option  the option that names the folder. Errors: kUsage, as for writes().
    [[nodiscard]] Result<void> keeps(const std::filesystem::path& path, std::string_view option);

    /// Registers an output whose folder may not exist yet; does not check that the output is writable.
    /// \return the registered file that the output would replace, or nullopt if there is none.
    [[nodiscard]] std::optional<File> claim(const std::filesystem::path& path, std::string_view option);

  private:
    /// Identities of a path, in this order: the location of a symbolic link itself, the inode of a regular file, the
    /// destination of the path ("-" for standard output). Devices have none.
    using Keys = std::vector<std::string>;
    using HoldsName = std::function<bool(const std::string& name)>;
    struct Series {
        File folder;
        HoldsName holds;
    };
    struct MadeFolders {
        MadeFolders() = default;
        MadeFolders(const MadeFolders&) = delete;
        MadeFolders& operator=(const MadeFolders&) = delete;
        ~MadeFolders();
        std::vector<std::filesystem::path> made;  // parents before children
    };

    [[nodiscard]] static Keys keysOf(const std::filesystem::path& path, int standard);
    [[nodiscard]] std::optional<File> find(const Keys& keys) const;
    [[nodiscard]] Result<void> writesSeries(const std::filesystem::path& folder, const HoldsName& holds,
                                            std::string_view option);
    void add(const Keys& keys, File file);
    [[nodiscard]] static Result<void> refusal(const File& file, const File& other);

    std::shared_ptr<MadeFolders> folders_ = std::make_shared<MadeFolders>();
    std::vector<File> files_;
    std::map<std::string, std::size_t> by_key_;  // index into files_
    std::multimap<std::string, Series> series_;  // key: destination of the folder
};

}  // namespace relief

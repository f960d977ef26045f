// SPDX-License-Identifier: Apache-2.0
// Keeps the files of a run apart: no output replaces a file that the run reads or owns, or another output.
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

#include "formats/base/made_folders.h"
#include "formats/base/result.h"

namespace relief {

/// The names of files that are written one after the other: frames/frame_0000.png and so on.
struct NumberedFiles {
    std::filesystem::path folder;
    std::string head;         ///< "frame_"
    std::string ending;       ///< ".png"
    std::uint32_t count = 0;  ///< they are numbered from 0

    /// The folder's file of this number, which has four digits or more.
    [[nodiscard]] std::filesystem::path path(std::uint32_t number) const;
    /// Whether a file of the folder is one of them.
    [[nodiscard]] bool hold(const std::string& name) const;
};

/// Every file of a folder whose name ends so, there or not yet: the containers of a world.
struct FilesByEnding {
    std::filesystem::path folder;
    std::string ending;  ///< ".relief"
};

/// Knows files by what they are and not by how they are named: through symbolic links, dangling ones included, through
/// hard links, and behind standard input and output. Name every file before the first one is written. Devices may be
/// named as often as one likes.
class FileGuard {
  public:
    enum class Use : std::uint8_t {
        kRead,
        kWritten,
        kOneOfMany,  ///< written, of NumberedFiles or FilesByEnding
        kKept,       ///< by keeps()
    };
    /// A file that the run reads or writes.
    struct File {
        std::filesystem::path path;  ///< as it was named
        std::string option;          ///< that names an output; empty for an input
        Use use = Use::kWritten;
    };

    /// A file that the run reads; "-" is standard input, an empty path none.
    /// Errors: kUsage: it is an output.
    [[nodiscard]] Result<void> reads(const std::filesystem::path& path);
    /// A file that the run writes; "-" is standard output, an empty path none.
    /// \param option  that names it, for messages: "--dump".
    /// \param made    a folder that the run fills, and makes later with its parents, which may hold the file.
    /// Errors: those of preflightFile; kUsage: it is an input, or another output, or a link out of `made`.
    [[nodiscard]] Result<void> writes(const std::filesystem::path& path, std::string_view option,
                                      const std::filesystem::path& made = {});
    /// Files that the run writes into a folder, which may be missing. Errors: kUsage, as the last one; a link out of the folder
    /// that one of them would be written through.
    [[nodiscard]] Result<void> writes(const NumberedFiles& files, std::string_view option);
    [[nodiscard]] Result<void> writes(const FilesByEnding& files, std::string_view option);
    /// A folder that the run fills: MadeFolders::make(). Without keepFolders(), and if nothing is in it then, the last copy of
    /// this guard removes it.
    [[nodiscard]] Result<void> makes(const std::filesystem::path& folder, std::string_view option) {
        return folders_->make(folder, option);
    }
    void keepFolders() { folders_->keep(); }
    /// A cache. A link of that name is replaced, not followed; several caches may be one file. The folder may be missing.
    /// \param option  that names its folder. Errors: kUsage, as writes().
    [[nodiscard]] Result<void> keeps(const std::filesystem::path& path, std::string_view option);

    /// As the first writes(), for a file whose folder may still be missing: whether it can be written is not checked.
    /// \return the file that it would replace; nullopt: none, and the guard knows it now.
    [[nodiscard]] std::optional<File> claim(const std::filesystem::path& path, std::string_view option);

  private:
    /// Identities of a path: a symbolic link's own place, the number of a regular file, and last its destination, "-" for
    /// standard output. None of devices.
    using Keys = std::vector<std::string>;
    using HoldsName = std::function<bool(const std::string& name)>;
    struct Series {
        File folder;
        HoldsName holds;
    };

    [[nodiscard]] static Keys keysOf(const std::filesystem::path& path, int standard);
    [[nodiscard]] std::optional<File> find(const Keys& keys) const;
    [[nodiscard]] Result<void> writesSeries(const std::filesystem::path& folder, const HoldsName& holds,
                                            std::string_view option);
    void add(const Keys& keys, File file);
    [[nodiscard]] static Result<void> refusal(const File& file, const File& other);

    std::shared_ptr<MadeFolders> folders_ = std::make_shared<MadeFolders>();
    std::vector<File> files_;
    std::map<std::string, std::size_t> by_key_;  // in files_
    std::multimap<std::string, Series> series_;  // by the folder's destination
};

}  // namespace relief

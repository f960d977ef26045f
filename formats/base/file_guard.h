// Keeps the files of a run apart: nothing that it reads is lost to what it writes, and no two outputs are one file.
#pragma once

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <map>
#include <string>
#include <string_view>
#include <vector>

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

/// Knows files by what they are and not by how they are named: through symbolic links, dangling ones included, through
/// hard links, and behind standard input and output. Name every file before the first one is written. Devices may be
/// named as often as one likes.
class FileGuard {
  public:
    /// A file that the run reads or writes.
    struct File {
        std::filesystem::path path;  ///< as it was named
        std::string option;          ///< that names an output; empty for an input
        bool input = false;
    };

    /// A file that the run reads; "-" is standard input, an empty path none.
    /// Errors: kUsage: it is an output.
    [[nodiscard]] Result<void> reads(const std::filesystem::path& path);
    /// A file that the run writes; "-" is standard output, an empty path none.
    /// \param option  that names it, for messages: "--dump".
    /// Errors: those of preflightFile; kUsage: it is an input, or another output.
    [[nodiscard]] Result<void> writes(const std::filesystem::path& path, std::string_view option);
    /// Files that the run writes, into a folder that it makes.
    /// Errors: as the last one's kUsage.
    [[nodiscard]] Result<void> writes(const NumberedFiles& files, std::string_view option);

    /// As the first writes(), for a file whose folder may still be missing: whether it can be written is not checked.
    /// \return the file that it would replace, valid until the next call; null: none, and the guard knows it now.
    [[nodiscard]] const File* claim(const std::filesystem::path& path, std::string_view option);

  private:
    /// Identities of a path: the number of a regular file, and its destination, "-" for standard output. None of devices.
    using Keys = std::vector<std::string>;
    struct Series {
        NumberedFiles files;  ///< in the folder's destination
        std::size_t file;     ///< in files_
    };

    [[nodiscard]] static Keys keysOf(const std::filesystem::path& path, int standard);
    [[nodiscard]] const File* find(const Keys& keys) const;
    void add(const Keys& keys, File file);
    [[nodiscard]] static Result<void> refusal(const File& file, const File& other);

    std::vector<File> files_;
    std::map<std::string, std::size_t> by_key_;  // in files_
    std::vector<Series> series_;
};

}  // namespace relief

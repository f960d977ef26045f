// SPDX-License-Identifier: Apache-2.0
// Patterns of file names, as recipes have them: rocks/*.obj, **/*.glb.
//
// A pattern is a relative path. In a part of it `*` stands for any characters, `?` for one, `[a-f]` and
// `[!a-f]` for one of some, and a backslash takes the next character as it is; a part that is `**` alone
// stands for any number of folders, none included. No wildcard stands for a dot at the start of a name. Bytes
// are compared, whatever the locale. A slash at the end makes it a pattern of folders.
#pragma once

#include <filesystem>
#include <string>
#include <string_view>
#include <vector>

#include "formats/base/result.h"

namespace relief {

class GlobPattern {
  public:
    /// Errors: kInvalidInput: empty, absolute, a zero byte, a part `..`, `**` at the end; kLimit: more than
    /// 64 parts. The message goes on from the pattern: "names no file; …".
    [[nodiscard]] static Result<GlobPattern> parse(std::string_view text);

    /// Whether any part has a wildcard.
    [[nodiscard]] bool wild() const { return wild_; }
    /// Whether folders are meant, and no files.
    [[nodiscard]] bool ofFolders() const { return of_folders_; }
    /// \param path  relative, without `.` and `..`, parts separated by one `/`.
    [[nodiscard]] bool matches(std::string_view path) const;

    /// Which parts the next name of a path may be: see glob.cpp.
    using State = std::vector<bool>;
    [[nodiscard]] State start() const;
    /// \param link  the name is a symbolic link, which `**` does not follow: links can lead in circles.
    [[nodiscard]] State step(const State& state, const char* name, bool link) const;
    [[nodiscard]] bool accepts(const State& state) const { return state.back(); }

  private:
    std::vector<std::string> parts_;
    bool wild_ = false;
    bool of_folders_ = false;
};

struct GlobResult {
    std::vector<std::string> files;    ///< from `folder`, parts separated by `/`; sorted by their bytes
    std::vector<std::string> folders;  ///< that were looked through, from `folder`, "" for itself; sorted
};

/// The files below a folder that a pattern matches: regular files, or folders; symbolic links to such included.
/// \param folder  empty for the current one.
/// Errors: kIo (a folder cannot be read), kLimit (a million names looked at, 100,000 files found, 64 deep).
[[nodiscard]] Result<GlobResult> globFiles(const std::filesystem::path& folder, const GlobPattern& pattern);

}  // namespace relief

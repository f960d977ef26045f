// SPDX-License-Identifier: Apache-2.0
// Patterns of file names in recipes: rocks/*.obj, **/*.glb.
//
// A pattern is a relative path; slashes separate its parts. Within a part, `*` matches any characters, `?` matches one
// character, and `[a-f]` and `[!a-f]` match one character in or not in a range. A backslash escapes the next character.
// The part `**` matches any number of folders, including none. No wildcard matches a dot at the start of a name. Bytes
// are compared, regardless of the locale. A trailing slash makes the pattern match folders.
#pragma once

#include <filesystem>
#include <string>
#include <string_view>
#include <vector>

#include "formats/base/result.h"

namespace relief {

class GlobPattern {
  public:
    /// Parses a pattern.
    /// Errors: kInvalidInput (empty, absolute, a zero byte, a part `..`, `**` at the end), kLimit (more than 64 parts).
    /// The caller puts the pattern before the message: "names no file; …".
    [[nodiscard]] static Result<GlobPattern> parse(std::string_view text);

    /// Whether any part has a wildcard.
    [[nodiscard]] bool wild() const { return wild_; }
    /// Whether it matches folders, not files.
    [[nodiscard]] bool ofFolders() const { return of_folders_; }
    /// \param path  relative, without `.` and `..`; parts are separated by one `/`.
    [[nodiscard]] bool matches(std::string_view path) const;

    /// The parts that may match the next name of a path: see glob.cpp.
    using State = std::vector<bool>;
    [[nodiscard]] State start() const;
    /// \param link  the name is a symbolic link, which `**` does not follow: links may form cycles.
    [[nodiscard]] State step(const State& state, const char* name, bool link) const;
    [[nodiscard]] bool accepts(const State& state) const { return state.back(); }

  private:
    std::vector<std::string> parts_;
    bool wild_ = false;
    bool of_folders_ = false;
};

struct GlobResult {
    std::vector<std::string> files;    ///< relative to `folder`, parts separated by `/`; sorted by bytes
    std::vector<std::string> folders;  ///< searched folders, in the same form; "" is `folder`
};

/// Returns the files below a folder that match a pattern: regular files or folders, including symbolic links to them.
/// \param folder  empty for the current folder.
/// Errors: kIo (a folder cannot be read), kLimit (a million names visited, 100,000 files found, depth 64).
[[nodiscard]] Result<GlobResult> globFiles(const std::filesystem::path& folder, const GlobPattern& pattern);

}  // namespace relief

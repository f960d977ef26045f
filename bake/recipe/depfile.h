// SPDX-License-Identifier: Apache-2.0
// Writes depfiles: the input files of an output, in the syntax of Make and Ninja.
#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "formats/base/result.h"

namespace relief {

/// A file that was read to make an output.
struct InputFile {
    std::string path;  ///< as it was opened
    std::string hash;  ///< XXH3-128 of the bytes read

    bool operator==(const InputFile&) const = default;
};

/// Returns "OUT…: IN…", and an empty rule for each input except the first, so that Make continues if one was deleted.
/// Escapes spaces, `#`, `$` and `:`.
/// \param targets  at least one.
/// \param inputs   the primary one first; duplicates are written once.
/// Errors: kUnsupported for a name that Make or Ninja would misread: with a control character, a `;` or `=`, a
/// backslash before an escaped character or at the end; a target with `%`; an empty name.
[[nodiscard]] Result<std::string> depfileText(const std::vector<std::string>& targets,
                                              const std::vector<std::string>& inputs);

/// Writes depfileText() to a file. Errors: those of depfileText, kIo.
[[nodiscard]] Result<void> writeDepfile(const std::filesystem::path& path,
                                        const std::vector<std::string>& targets,
                                        const std::vector<std::string>& inputs);

}  // namespace relief

// SPDX-License-Identifier: Apache-2.0
// Depfiles: which files an output was made from, in the syntax that Make and Ninja read.
#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "formats/base/result.h"

namespace relief {

/// A file that was read to make an output.
struct InputFile {
    std::string path;  ///< as it was opened
    std::string hash;  ///< XXH3-128 of what was read

    bool operator==(const InputFile&) const = default;
};

/// "OUT…: IN…", and for each input but the first an empty rule, so that Make goes on where one was deleted.
/// Spaces, `#`, `$` and `:` are escaped.
/// \param targets  at least one.
/// \param inputs   the primary one first; duplicates are written once.
/// Errors: kUnsupported for a name that Make or Ninja would read as something else: with a control character,
/// a `;` or `=`, a backslash before an escaped character or at the end; a target with `%`; an empty name.
[[nodiscard]] Result<std::string> depfileText(const std::vector<std::string>& targets,
                                              const std::vector<std::string>& inputs);

/// Errors: those of depfileText, kIo.
[[nodiscard]] Result<void> writeDepfile(const std::filesystem::path& path,
                                        const std::vector<std::string>& targets,
                                        const std::vector<std::string>& inputs);

}  // namespace relief

// SPDX-License-Identifier: Apache-2.0
// Files that are derived from fields(). The build writes schemas and fuzzer dictionaries. Files that users read in the
// source tree are checked in: scripts/generate.sh rewrites them, and the test generated.fresh fails if they are stale.
#pragma once

#include <string>
#include <vector>

namespace relief {

/// A whole file, or the part of a file between the lines "<!-- generated: PART -->" and "<!-- end of PART -->"
/// (comments with "//" or "#" in other languages).
struct GeneratedText {
    std::string path;    ///< relative to the source tree, or to the output folder if `built`
    std::string part;    ///< empty: the whole file
    std::string text;    ///< ends with a line feed
    bool built = false;  ///< written by the build into its own folder
};

using GeneratedTexts = std::vector<GeneratedText>;

}  // namespace relief

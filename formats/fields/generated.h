// SPDX-License-Identifier: Apache-2.0
// Files that are derived from fields(). Schemas and dictionaries of fuzz targets are written by the build. What users read in the
// source tree is checked in: scripts/generate.sh writes it anew, and the test generated.fresh fails if it is stale.
#pragma once

#include <string>
#include <vector>

namespace relief {

/// A whole file, or a part of one between the lines "<!-- generated: PART -->" and "<!-- end of PART -->" (in languages
/// other than Markdown behind "//" or "#" instead).
struct GeneratedText {
    std::string path;    ///< from the root of the source tree, or of the folder that is written
    std::string part;    ///< empty: the whole file
    std::string text;    ///< ends with a line feed
    bool built = false;  ///< by the build, in a folder of its own
};

using GeneratedTexts = std::vector<GeneratedText>;

}  // namespace relief

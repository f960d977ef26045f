// Files that are derived from fields(), and checked in where users read them. scripts/generate.sh writes them anew, and the
// test generated.fresh fails where one is stale.
#pragma once

#include <string>
#include <vector>

namespace relief {

/// A whole file, or a part of one between the lines "<!-- generated: PART -->" and "<!-- end of PART -->" (in languages
/// other than Markdown behind "//" or "#" instead).
struct GeneratedText {
    std::string path;  ///< from the root of the source tree
    std::string part;  ///< empty: the whole file
    std::string text;  ///< ends with a line feed
};

using GeneratedTexts = std::vector<GeneratedText>;

}  // namespace relief

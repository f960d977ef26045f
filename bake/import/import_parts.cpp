#include "bake/import/import_parts.h"

namespace relief {
namespace {

/// One vertex in this many may lie loose before that is worth a warning.
constexpr std::uint64_t kLooseShare = 10;

/// "1 line, 3 points and 2 free-form curves or surfaces"; "" where there are none of these.
std::string othersText(const MeshParts& parts) {
    std::vector<std::string> words;
    const auto add = [&words](std::uint64_t count, const char* one, const char* many) {
        if (count > 0) {
            words.push_back(std::to_string(count) + " " + (count == 1 ? one : many));
        }
    };
    add(parts.lines, "line", "lines");
    add(parts.points, "point", "points");
    add(parts.free_forms, "free-form curve or surface", "free-form curves or surfaces");
    std::string text;
    for (std::size_t i = 0; i < words.size(); ++i) {
        text += (i == 0 ? "" : i + 1 == words.size() ? " and " : ", ") + words[i];
    }
    return text;
}

}  // namespace

std::optional<std::string> partsRefusal(const MeshParts& parts) {
    if (parts.polygons > 0) {
        return std::nullopt;
    }
    if (const std::string others = othersText(parts); !others.empty()) {
        return "no triangles, but " + others + "; export the surface as polygons";
    }
    if (parts.vertices > 0) {
        return std::to_string(parts.vertices) + (parts.vertices == 1 ? " vertex" : " vertices") +
               " but no faces; if it is a scan, make a surface of its points first, for example in MeshLab";
    }
    return std::nullopt;
}

void warnOfParts(const MeshParts& parts, std::vector<std::string>& warnings) {
    if (const std::string others = othersText(parts); !others.empty()) {
        warnings.push_back("left out " + others + ": only polygons have a surface");
    }
    if (parts.unplaced > 0) {
        warnings.push_back("left out " + std::to_string(parts.unplaced) + " of its " +
                           std::to_string(parts.meshes) + " meshes: no node of its scene places them");
    }
    if (parts.loose > parts.vertices / kLooseShare) {
        warnings.push_back(std::to_string(parts.loose) + " of its " + std::to_string(parts.vertices) +
                           (parts.loose == 1 ? " vertices belongs" : " vertices belong") +
                           " to no polygon: faces may be missing; compare the count of "
                           "triangles with that of the program that wrote it");
    }
}

}  // namespace relief

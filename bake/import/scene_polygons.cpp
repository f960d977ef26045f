// SPDX-License-Identifier: Apache-2.0
#include "bake/import/import_scene.h"

#include <algorithm>
#include <map>
#include <span>
#include <string_view>
#include <utility>

#include "bake/import/polygon_cutter.h"

namespace relief {
namespace {

/// Warns if more than 1 in kLooseOneIn vertices is loose.
constexpr std::uint64_t kLooseOneIn = 10;

/// Returns "1 line, 3 points and 2 free-form curves or surfaces"; "" if there are none.
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

/// Triangulates polygons, run by run.
class PolygonRuns {
  public:
    PolygonRuns(const PolygonMesh& polygons, bool apart)
        : polygons_(polygons),
          apart_(apart),
          has_polygons_(std::ranges::any_of(polygons.sizes, [](std::uint32_t size) { return size > 3; })) {}

    /// Triangulates the polygons from the end of the previous run to index `end`.
    /// \param other  whether they belong to a different surface than the previous run.
    ScenePart upTo(std::size_t end, bool other) {
        ScenePart part;
        std::vector<glm::vec3> places;
        for (; next_ < end; first_ += polygons_.sizes[next_++]) {
            const auto corners = std::span(polygons_.corners).subspan(first_, polygons_.sizes[next_]);
            if (corners.size() < 3) {
                continue;
            }
            held_ = other || held_ > kHeldMax ? 0 : held_;
            other = false;
            places.clear();
            for (const std::uint32_t corner : corners) {
                places.push_back(polygons_.positions[corner]);
            }
            const std::size_t begin = part.triangles.size();
            for (const glm::uvec3& t : cutter_.cut(places)) {
                part.triangles.push_back(apart_ ? t + held_
                                                : glm::uvec3(corners[t.x], corners[t.y], corners[t.z]));
            }
            const std::span triangles = std::span(part.triangles).subspan(begin);
            if (has_polygons_) {
                starts_.turn(triangles);
            }
            if (apart_) {
                for (glm::uvec3& t : triangles) {
                    t += static_cast<std::uint32_t>(part.positions.size()) - held_;
                }
                held_ += static_cast<std::uint32_t>(places.size());
                part.positions.insert(part.positions.end(), places.begin(), places.end());
            }
        }
        if (!apart_ && !part.triangles.empty()) {
            part.positions = polygons_.positions;
        }
        return part;
    }

  private:
    /// Number of vertices after which the indices for TriangleStarts restart, so that bakes stay byte-identical.
    static constexpr std::uint32_t kHeldMax = 100'000;

    const PolygonMesh& polygons_;
    bool apart_;
    bool has_polygons_;
    PolygonCutter cutter_;
    TriangleStarts starts_;
    std::size_t next_ = 0;   // polygon
    std::size_t first_ = 0;  // index of its first corner
    std::uint32_t held_ = 0;
};

}  // namespace

MeshParts partsOf(const PolygonMesh& mesh) {
    MeshParts parts = mesh.others;
    constexpr std::uint8_t kByOther = 1;
    constexpr std::uint8_t kByPolygon = 2;
    std::vector<std::uint8_t> used = mesh.used_by_others;
    used.resize(mesh.positions.size(), 0);
    auto corner = mesh.corners.begin();
    for (const std::uint32_t size : mesh.sizes) {
        parts.polygons += size >= 3 ? 1 : 0;
        parts.lines += size == 2 ? 1 : 0;
        parts.points += size == 1 ? 1 : 0;
        for (std::uint32_t i = 0; i < size; ++i, ++corner) {
            used[*corner] |= size >= 3 ? kByPolygon : kByOther;
        }
    }
    parts.vertices = used.size();
    for (const std::uint8_t use : used) {
        parts.unused += (use & kByPolygon) == 0 ? 1 : 0;
        parts.loose += use == 0 ? 1 : 0;
    }
    return parts;
}

Result<void> addPolygons(const PolygonMesh& polygons, bool apart, const ImportJob& job, ImportScene& scene) {
    std::uint64_t triangles = 0;
    for (const std::uint32_t size : polygons.sizes) {
        triangles += size >= 3 ? size - 2 : 0;
    }
    if (triangles > job.triangle_max) {
        return tooManyTriangles(job);
    }
    scene.counts = partsOf(polygons);
    scene.warnings = polygons.warnings;
    scene.roots = {0};
    scene.nodes.push_back({.names = {job.file_name}});
    PolygonRuns runs(polygons, apart);
    std::map<std::string_view, std::uint32_t> indices;  // groups with equal names are one node
    const PolygonGroup unnamed;
    const PolygonGroup* last = nullptr;
    for (std::size_t i = 0; i <= polygons.groups.size(); ++i) {
        const PolygonGroup& group = i == 0 ? unnamed : polygons.groups[i - 1];
        const bool other = last == nullptr || last->node != group.node || last->material != group.material;
        ScenePart part =
            runs.upTo(i < polygons.groups.size() ? polygons.groups[i].begin : polygons.sizes.size(), other);
        if (part.triangles.empty()) {
            continue;
        }
        const auto next = static_cast<std::uint32_t>(indices.size() + 1);
        const std::uint32_t index = i == 0 ? 0 : indices.try_emplace(group.node, next).first->second;
        last = i == 0 ? nullptr : &group;
        part.material = group.material;
        part.names = group.names;
        scene.nodes[0].children.push_back(static_cast<std::uint32_t>(scene.nodes.size()));
        scene.nodes.push_back(
            {.shown = group.node, .index = index, .parts = {static_cast<std::uint32_t>(scene.parts.size())}});
        scene.parts.push_back(std::move(part));
    }
    return {};
}

ScenePart triangulatePolygons(const PolygonMesh& polygons) {
    return PolygonRuns(polygons, false).upTo(polygons.sizes.size(), false);
}

std::optional<std::string> partsError(const MeshParts& parts) {
    if (parts.polygons > 0) {
        return std::nullopt;
    }
    if (const std::string others = othersText(parts); !others.empty()) {
        return "no triangles, but " + others + "; export the surface as polygons";
    }
    if (parts.vertices > 0) {
        return std::to_string(parts.vertices) + (parts.vertices == 1 ? " vertex" : " vertices") +
               " but no faces; if it is a scan, reconstruct a surface from its points first, for example in "
               "MeshLab";
    }
    return std::nullopt;
}

void warnAboutParts(const MeshParts& parts, std::vector<std::string>& warnings) {
    if (const std::string others = othersText(parts); !others.empty()) {
        warnings.push_back("left out " + others + ": only polygons have a surface");
    }
    if (parts.unplaced > 0) {
        warnings.push_back("left out " + std::to_string(parts.unplaced) + " of its " +
                           std::to_string(parts.meshes) + " meshes: no node of its scene places them");
    }
    if (parts.loose > parts.vertices / kLooseOneIn) {
        warnings.push_back(std::to_string(parts.loose) + " of its " + std::to_string(parts.vertices) +
                           (parts.loose == 1 ? " vertices belongs" : " vertices belong") +
                           " to no polygon: faces may be missing; compare its triangle count "
                           "with that of the exporting program");
    }
}

}  // namespace relief

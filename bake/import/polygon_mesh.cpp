#include "bake/import/polygon_mesh.h"

#include <algorithm>
#include <map>
#include <span>
#include <string_view>
#include <utility>

#include "bake/import/import_instances.h"
#include "bake/import/import_names.h"
#include "bake/import/polygon_cutter.h"
#include "formats/base/text.h"

namespace relief {
namespace {

/// Calls visit(polygon, its corners) for all polygons in order.
template <class Visit>
void forEachPolygon(const PolygonMesh& mesh, const Visit& visit) {
    std::size_t first = 0;
    for (std::size_t i = 0; i < mesh.sizes.size(); ++i) {
        visit(i, std::span(mesh.corners).subspan(first, mesh.sizes[i]));
        first += mesh.sizes[i];
    }
}

std::uint8_t markOf(const PolygonGroup& group, NameMarks& marks) {
    std::uint8_t mark = 0;
    for (const std::string& name : group.words_names) {
        mark = std::max(mark, marks.meet(name));
        std::string_view rest = name;
        for (std::string_view word = takeWord(rest); !word.empty(); word = takeWord(rest)) {
            mark = std::max(mark, marks.meet(word));
        }
    }
    for (const std::string& name : group.names) {
        mark = std::max(mark, marks.meet(name));
    }
    return mark;
}

/// Collects triangles of one mark.
class Triangles {
  public:
    Triangles(const PolygonMesh& polygons, bool apart)
        : polygons_(polygons),
          apart_(apart),
          has_polygons_(std::any_of(polygons.sizes.begin(), polygons.sizes.end(),
                                    [](std::uint32_t size) { return size > 3; })) {}

    void add(std::span<const std::uint32_t> corners) {
        const auto base = static_cast<std::uint32_t>(positions_.size());
        places_.clear();
        for (const std::uint32_t corner : corners) {
            places_.push_back(polygons_.positions[corner]);
        }
        if (apart_) {
            positions_.insert(positions_.end(), places_.begin(), places_.end());
        }
        const std::size_t first = triangles_.size();
        for (const glm::uvec3& t : cutter_.cut(places_)) {
            triangles_.push_back(apart_ ? t + base : glm::uvec3(corners[t.x], corners[t.y], corners[t.z]));
        }
        if (has_polygons_) {
            starts_.turn(std::span(triangles_).subspan(first));
        }
    }

    /// Of those since the last call.
    void handOver(const Transform& transform, std::uint8_t mark, MeshInstances& instances) {
        if (!triangles_.empty()) {
            instances.add(apart_ ? std::span<const glm::vec3>(positions_) : polygons_.positions, triangles_,
                          transform, mark);
        }
        positions_.clear();
        triangles_.clear();
    }

    /// Handing over in parts avoids a second copy of the whole mesh.
    [[nodiscard]] bool isFull() const { return positions_.size() > kHeldMax; }

  private:
    static constexpr std::size_t kHeldMax = 100'000;

    const PolygonMesh& polygons_;
    bool apart_;
    bool has_polygons_;
    PolygonCutter cutter_;
    TriangleStarts starts_;
    std::vector<glm::vec3> places_;  // of one polygon
    std::vector<glm::vec3> positions_;
    std::vector<glm::uvec3> triangles_;
};

}  // namespace

MeshParts partsOf(const PolygonMesh& mesh) {
    MeshParts parts = mesh.others;
    constexpr std::uint8_t kByOther = 1;
    constexpr std::uint8_t kByPolygon = 2;
    std::vector<std::uint8_t> used = mesh.in_others;
    used.resize(mesh.positions.size(), 0);
    forEachPolygon(mesh, [&](std::size_t /*polygon*/, std::span<const std::uint32_t> corners) {
        parts.polygons += corners.size() >= 3 ? 1 : 0;
        parts.lines += corners.size() == 2 ? 1 : 0;
        parts.points += corners.size() == 1 ? 1 : 0;
        for (const std::uint32_t corner : corners) {
            used[corner] |= corners.size() >= 3 ? kByPolygon : kByOther;
        }
    });
    parts.vertices = used.size();
    for (const std::uint8_t use : used) {
        parts.unused += (use & kByPolygon) == 0 ? 1 : 0;
        parts.loose += use == 0 ? 1 : 0;
    }
    return parts;
}

Result<TriangleMesh> flatten(const PolygonMesh& polygons, bool apart, const glm::dmat3& linear,
                             const ImportJob& job, TriangleMesh mesh) {
    const Transform root{linear, glm::dvec3(0.0)};
    MeshInstances instances(job.shown, job.triangle_max, std::move(mesh));
    std::uint64_t triangles = 0;
    std::uint64_t vertices = apart ? 0 : polygons.positions.size();
    for (const std::uint32_t size : polygons.sizes) {
        triangles += size >= 3 ? size - 2 : 0;
        vertices += apart && size >= 3 ? size : 0;
    }
    if (!instances.count(vertices, triangles, root)) {
        return instances.tooMany();
    }
    NameMarks marks(job.options.names, job.file_name);
    const std::uint8_t file_mark = marks.any() ? marks.meet(job.file_name) : std::uint8_t{0};
    instances.begin(marks.any());
    Triangles cut(polygons, apart);
    std::uint8_t mark = file_mark;
    std::map<std::string_view, std::uint32_t> nodes;
    SurfaceName surface;
    instances.surface(surface);
    std::size_t group = 0;
    bool met = false;  // a triangle of the last group that was begun
    forEachPolygon(polygons, [&](std::size_t polygon, std::span<const std::uint32_t> corners) {
        while (group < polygons.groups.size() && polygons.groups[group].begin <= polygon) {
            ++group;
            met = false;
        }
        if (corners.size() < 3) {
            return;
        }
        if (!met && group > 0) {
            const PolygonGroup& begun = polygons.groups[group - 1];
            const std::uint8_t next =
                marks.any() ? std::max(file_mark, markOf(begun, marks)) : std::uint8_t{0};
            const auto node = static_cast<std::uint32_t>(nodes.size() + 1);
            const SurfaceName name{nodes.try_emplace(begun.node, node).first->second, begun.node,
                                   begun.material};
            if (next != mark || name != surface) {
                cut.handOver(root, mark, instances);
                mark = next;
                surface = name;
                instances.surface(surface);
            }
            met = true;
        }
        cut.add(corners);
        if (cut.isFull()) {
            cut.handOver(root, mark, instances);
        }
    });
    cut.handOver(root, mark, instances);
    return instances.finish(marks);
}

tl::unexpected<Error> unreadable(const std::string& shown, const Error& error) {
    const bool cured = error.message.find(';') != std::string::npos;
    return fail(error.code, "cannot read the mesh " + shown + ": " + error.message +
                                (cured ? "" : "; repair the file or export it again"));
}

}  // namespace relief

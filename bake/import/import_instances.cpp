#include "bake/import/import_instances.h"

#include <algorithm>
#include <cmath>
#include <glm/geometric.hpp>
#include <utility>

#include "formats/base/text.h"

namespace relief {
namespace {

/// A transform whose determinant is this small, relative to the product of its columns' lengths, leaves no volume.
constexpr double kFlat = 1e-9;

double determinant(const glm::dmat3& m) {
    return m[0][0] * (m[1][1] * m[2][2] - m[2][1] * m[1][2]) -
           m[1][0] * (m[0][1] * m[2][2] - m[2][1] * m[0][2]) +
           m[2][0] * (m[0][1] * m[1][2] - m[1][1] * m[0][2]);
}

}  // namespace

bool Transform::mirrors() const {
    return determinant(linear) < 0.0;
}

bool Transform::flattens() const {
    const double lengths = glm::length(linear[0]) * glm::length(linear[1]) * glm::length(linear[2]);
    return std::abs(determinant(linear)) <= kFlat * lengths;
}

Transform operator*(const Transform& outer, const Transform& inner) {
    return {outer.linear * inner.linear, outer.apply(inner.offset)};
}

tl::unexpected<Error> tooManyTriangles(const std::string& shown, std::uint64_t triangle_max) {
    const bool least = triangle_max < kTriangleMax;
    return fail(ErrorCode::kLimit,
                shown + ": more than " + std::to_string(triangle_max) +
                    " triangles or thrice as many vertices, instances counted one by one; simplify the mesh" +
                    (least ? ", or raise --max-triangles" : ""));
}

bool MeshInstances::count(std::uint64_t vertices, std::uint64_t triangles, const Transform& transform) {
    triangles_ += triangles;
    vertices_ += vertices;
    flat_ += transform.flattens() ? 1 : 0;
    return triangles_ <= triangle_max_ && vertices_ <= 3 * triangle_max_;
}

void MeshInstances::begin(bool marked) {
    marked_ = marked;
    mesh_.positions.reserve(vertices_);
    mesh_.triangles.reserve(triangles_);
    mesh_.marks.reserve(marked ? triangles_ : 0);
}

void MeshInstances::surface(SurfaceName name) {
    name.node = cleanUtf8(name.node, kAskedNameBytesMax);
    name.material = cleanUtf8(name.material, kAskedNameBytesMax);
    surface_ = std::move(name);
}

std::uint32_t MeshInstances::labelOfSurface() {
    std::vector<SurfaceName>& names = mesh_.surface_names;
    if (names.empty() || names[label_] != surface_) {
        if (const auto found = labels_.find(surface_); found != labels_.end()) {
            label_ = found->second;
        } else if (names.size() < kSurfaceNamesMax) {
            label_ = static_cast<std::uint32_t>(names.size());
            names.push_back(names.size() + 1 < kSurfaceNamesMax ? surface_ : SurfaceName());
            labels_.emplace(surface_, label_);
        } else {
            label_ = kSurfaceNamesMax - 1;
        }
    }
    return label_;
}

void MeshInstances::add(std::span<const glm::vec3> positions, std::span<const glm::uvec3> triangles,
                        const Transform& transform, std::uint8_t mark) {
    const auto base = static_cast<std::uint32_t>(mesh_.positions.size());
    for (const glm::vec3& position : positions) {
        mesh_.positions.emplace_back(transform.apply(position));
    }
    const bool mirrors = transform.mirrors();
    for (const glm::uvec3& t : triangles) {
        mesh_.triangles.emplace_back(base + t.x, base + (mirrors ? t.z : t.y), base + (mirrors ? t.y : t.z));
    }
    mesh_.marks.resize(marked_ ? mesh_.triangles.size() : 0, mark);
    if (!triangles.empty()) {
        mesh_.labels.resize(mesh_.triangles.size(), labelOfSurface());
    }
}

Result<TriangleMesh> MeshInstances::finish(const NameMarks& names) {
    if (mesh_.triangles.empty()) {
        return fail(ErrorCode::kInvalidInput,
                    shown_ + ": no triangles; export the surface as polygons, not as points or lines");
    }
    RELIEF_TRY(names.allMet(shown_));
    if (mesh_.surface_names.size() < 2) {
        mesh_.surface_names.clear();
        mesh_.labels.clear();
    }
    if (flat_ > 0) {
        mesh_.warnings.push_back(std::to_string(flat_) +
                                 " of its parts are scaled to nothing in some direction, and hold no volume");
    }
    return std::move(mesh_);
}

}  // namespace relief

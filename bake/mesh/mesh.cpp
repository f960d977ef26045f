// SPDX-License-Identifier: Apache-2.0
#include "bake/mesh/mesh.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "formats/base/text.h"

namespace relief {
namespace {

// Limits in object units, so that squares of map coordinates and the scales of a map fit into floats.
constexpr float kCoordinateMax = 1e15F;
constexpr float kSizeMin = 1e-15F;

/// Beyond this coordinate, a whole triangle may round to one point.
constexpr float kFar = 1e6F;

tl::unexpected<Error> noArea(const TriangleMesh& mesh) {
    float farthest = 0.0F;
    for (const glm::vec3& p : mesh.positions) {
        farthest = std::max({farthest, std::abs(p.x), std::abs(p.y), std::abs(p.z)});
    }
    const float step = std::nextafter(farthest, 2.0F * farthest) - farthest;
    return invalidInput(mesh.name + ": no triangle has an area; " +
                        (farthest >= kFar
                             ? "its coordinates reach " + shortest(farthest) + ", where floats are " +
                                   shortest(step) + " apart: move it to the origin"
                             : "export the surface as polygons, not as points or lines"));
}

/// Maximum boxesOnLine() of an ordinary mesh.
constexpr double kOrdinaryBoxes = 32.0;

double halfArea(const Bounds& box) {
    const glm::dvec3 size = box.size();
    return size.x * size.y + size.y * size.z + size.z * size.x;
}

}  // namespace

void moveTriangle(TriangleMesh& mesh, std::size_t from, std::size_t to) {
    mesh.triangles[to] = mesh.triangles[from];
    if (!mesh.marks.empty()) {
        mesh.marks[to] = mesh.marks[from];
    }
    if (!mesh.labels.empty()) {
        mesh.labels[to] = mesh.labels[from];
    }
}

void keepTriangles(TriangleMesh& mesh, std::size_t count) {
    mesh.triangles.resize(count);
    mesh.marks.resize(std::min(count, mesh.marks.size()));
    mesh.labels.resize(std::min(count, mesh.labels.size()));
}

void dropSingleLabel(TriangleMesh& mesh) {
    if (mesh.surface_names.size() < 2) {
        mesh.labels.clear();
        if (!mesh.surface_names.empty() && mesh.surface_names[0].material.empty()) {
            mesh.surface_names.clear();
        }
    }
}

Bounds boundsOf(std::span<const glm::vec3> positions) {
    Bounds bounds;
    for (const glm::vec3& p : positions) {
        bounds.add(p);
    }
    return bounds;
}

TriangleMesh meshOfSource(const TriangleMesh& source) {
    TriangleMesh mesh;
    mesh.name = source.name;
    mesh.content_hash = source.content_hash;
    mesh.unit = source.unit;
    mesh.dropped_triangles = source.dropped_triangles;
    mesh.dependencies = source.dependencies;
    mesh.dependency_hashes = source.dependency_hashes;
    mesh.warnings = source.warnings;
    return mesh;
}

Result<TriangleMesh> finishMesh(TriangleMesh mesh) {
    if (mesh.triangles.size() > kTriangleMax) {
        return fail(ErrorCode::kLimit, mesh.name + ": " + std::to_string(mesh.triangles.size()) +
                                           " triangles are more than the limit of " +
                                           std::to_string(kTriangleMax) + "; simplify the mesh");
    }
    std::size_t kept = 0;
    for (std::size_t triangle = 0; triangle < mesh.triangles.size(); ++triangle) {
        const glm::uvec3 t = mesh.triangles[triangle];
        if (std::max({t.x, t.y, t.z}) >= mesh.positions.size()) {
            return invalidInput(mesh.name + ": a triangle uses vertex " +
                                std::to_string(std::max({t.x, t.y, t.z})) + " but there are " +
                                std::to_string(mesh.positions.size()) + "; export it again");
        }
        for (const std::uint32_t i : {t.x, t.y, t.z}) {
            const glm::vec3& p = mesh.positions[i];
            // Written to reject NaN.
            if (!(std::abs(p.x) <= kCoordinateMax && std::abs(p.y) <= kCoordinateMax &&
                  std::abs(p.z) <= kCoordinateMax)) {
                return invalidInput(mesh.name + ": vertex " + std::to_string(i) +
                                    " has a coordinate that is not a number or beyond 1e15; repair the mesh");
            }
        }
        if (hasArea(planeOf(mesh.positions, t))) {
            moveTriangle(mesh, triangle, kept++);
        }
    }
    mesh.dropped_triangles += mesh.triangles.size() - kept;
    keepTriangles(mesh, kept);
    if (kept == 0) {
        return noArea(mesh);
    }

    constexpr std::uint32_t kUnused = std::numeric_limits<std::uint32_t>::max();
    std::vector<std::uint32_t> new_index(mesh.positions.size(), kUnused);
    for (const glm::uvec3& t : mesh.triangles) {
        new_index[t.x] = new_index[t.y] = new_index[t.z] = 0;
    }
    std::uint32_t used = 0;
    mesh.bounds = {};
    for (std::size_t i = 0; i < mesh.positions.size(); ++i) {
        if (new_index[i] != kUnused) {
            mesh.bounds.add(mesh.positions[i]);
            mesh.positions[used] = mesh.positions[i];
            new_index[i] = used++;
        }
    }
    if (used != mesh.positions.size()) {
        mesh.positions.resize(used);
        for (glm::uvec3& t : mesh.triangles) {
            t = {new_index[t.x], new_index[t.y], new_index[t.z]};
        }
    }
    if (mesh.bounds.longestSide() < kSizeMin) {
        return invalidInput(mesh.name + ": the mesh is smaller than 1e-15 units; scale it up");
    }
    return mesh;
}

double boxesOnLine(const TriangleMesh& mesh) {
    // Cauchy: a line through a convex body meets another body inside it with a probability equal to the ratio of their
    // areas.
    double sum = 0.0;
    for (std::uint32_t i = 0; i < mesh.triangles.size(); ++i) {
        sum += halfArea(boundsOf(cornersOf(mesh, i)));
    }
    const double whole = halfArea(mesh.bounds);
    return whole > 0.0 ? sum / whole : static_cast<double>(mesh.triangles.size());
}

double affordableRays(const TriangleMesh& mesh) {
    return std::min(1.0, kOrdinaryBoxes / std::max(boxesOnLine(mesh), 1.0));
}

}  // namespace relief

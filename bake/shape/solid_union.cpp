// SPDX-License-Identifier: Apache-2.0
#include "bake/shape/solid_union.h"

#include <utility>

namespace relief {

SolidUnion::SolidUnion(const TriangleMesh& source) : source_(source), positions_(source.positions) {}

void SolidUnion::addSource(const std::vector<std::uint32_t>& triangles,
                           std::span<const std::uint32_t> part_of, std::uint32_t body) {
    for (const std::uint32_t i : triangles) {
        surface_.triangles.push_back(source_.triangles[i]);
        surface_.bodies.push_back(body);
        surface_.parts.push_back(part_of[i]);
    }
}

void SolidUnion::add(std::span<const glm::vec3> positions, std::span<const glm::uvec3> triangles,
                     std::span<const std::uint32_t> parts, std::size_t surface, std::uint32_t body) {
    const auto first = static_cast<std::uint32_t>(positions_.size());
    positions_.insert(positions_.end(), positions.begin(), positions.end());
    for (std::size_t i = 0; i < triangles.size(); ++i) {
        Half& half = i < surface ? surface_ : caps_;
        half.triangles.push_back(triangles[i] + first);
        half.bodies.push_back(body);
        half.parts.push_back(i < surface ? parts[i] : kNoLabel);
    }
}

Result<PreparedMesh> SolidUnion::finish(double shell_thickness) {
    TriangleMesh mesh;
    mesh.name = source_.name;
    mesh.content_hash = source_.content_hash;
    mesh.unit = source_.unit;
    mesh.dropped_triangles = source_.dropped_triangles;
    mesh.dependencies = source_.dependencies;
    mesh.dependency_hashes = source_.dependency_hashes;
    mesh.warnings = source_.warnings;
    mesh.source_triangles = source_.sourceTriangles();
    mesh.positions = std::move(positions_);
    mesh.triangles = std::move(surface_.triangles);
    mesh.triangles.insert(mesh.triangles.end(), caps_.triangles.begin(), caps_.triangles.end());
    mesh.cap_triangles = caps_.triangles.size();
    mesh.closed_holes = holes_;
    mesh.shell_thickness = shell_thickness;
    std::vector<std::uint32_t> bodies = std::move(surface_.bodies);
    bodies.insert(bodies.end(), caps_.bodies.begin(), caps_.bodies.end());
    surface_.parts.insert(surface_.parts.end(), caps_.parts.begin(), caps_.parts.end());
    mesh = RELIEF_TRY(finishMesh(std::move(mesh)));
    if (mesh.triangles.size() != bodies.size()) {
        return fail(ErrorCode::kFailure,
                    mesh.name + ": a shell has triangles without area; change --thickness");
    }
    return PreparedMesh::unionOf(std::move(mesh), std::move(bodies));
}

}  // namespace relief

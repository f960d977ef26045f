// SPDX-License-Identifier: Apache-2.0
#include "bake/shape/solids.h"

#include <utility>

namespace relief {

SolidPart extruded(const Sheet& sheet, int axis, float bottom) {
    PartBuilder builder;
    const auto count = static_cast<std::uint32_t>(sheet.positions.size());
    for (const glm::vec3& p : sheet.positions) {
        builder.addPosition(p);
    }
    for (glm::vec3 p : sheet.positions) {
        p[axis] = bottom;
        builder.addPosition(p);
    }
    // Upwards, regardless of the sheet's winding.
    const bool turn = !(shadowOf(sheet).signed_area[axis] > 0.0);
    const auto corners = [&](std::uint32_t i) {
        const glm::uvec3& t = sheet.triangles[i];
        return turn ? glm::uvec3(t.x, t.z, t.y) : t;
    };
    for (std::uint32_t i = 0; i < sheet.triangles.size(); ++i) {
        const glm::uvec3 t = corners(i);
        builder.addTriangle(i, t.x, t.y, t.z);
    }
    builder.endSurface();
    for (std::uint32_t i = 0; i < sheet.triangles.size(); ++i) {
        const glm::uvec3 t = corners(i);
        builder.addTriangle(i, count + t.x, count + t.z, count + t.y);
        for (int side = 0; side < 3; ++side) {
            if (sheet.neighbours[i][side] == Sheet::kNoTriangle) {
                const glm::uvec3& s = sheet.triangles[i];
                const auto [from, to] = std::pair{s[side], s[(side + 1) % 3]};
                const auto [a, b] = turn ? std::pair{to, from} : std::pair{from, to};
                builder.addWall(i, {a, count + a}, {b, count + b});
            }
        }
    }
    return builder.take();
}

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
    TriangleMesh mesh = meshOfSource(source_);
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

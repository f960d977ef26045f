// SPDX-License-Identifier: Apache-2.0
// Closed-form meshes, closed and wound outward, and helpers to bake and query them.
#pragma once

#include <gtest/gtest.h>

#include <filesystem>
#include <glm/mat3x3.hpp>
#include <glm/vec3.hpp>
#include <string>
#include <string_view>
#include <vector>

#include "bake/maps/bake_maps.h"
#include "bake/mesh/mesh.h"
#include "bake/mesh/mesh_query.h"
#include "tests/formats/rotation.h"
#include "tests/results.h"
#include "tests/temporary_folder.h"

namespace relief::test {

/// Distance from the surface of a box around the origin, negative inside.
[[nodiscard]] double boxDistance(const glm::dvec3& p, const glm::dvec3& half);

[[nodiscard]] TriangleMesh finished(std::vector<glm::vec3> positions, std::vector<glm::uvec3> triangles);

/// Columns of `axes` are the box's axes.
[[nodiscard]] TriangleMesh makeBoxMesh(const glm::dvec3& center, const glm::dvec3& half,
                                       const glm::dmat3& axes = glm::dmat3(1.0));
/// An icosahedron subdivided `levels` times; vertices on the sphere.
[[nodiscard]] TriangleMesh makeIcosphere(const glm::dvec3& center, double radius, int levels);
/// The axis is z.
[[nodiscard]] TriangleMesh makeTorusMesh(double ring_radius, double tube_radius, unsigned around,
                                         unsigned across);
/// n × n squares of y = height over [−1, 1]²; normals are +y.
[[nodiscard]] TriangleMesh makePlane(float height, unsigned n);

inline constexpr float kHillsHalf = 100.0F;  ///< half the extent of the hills along x and z
[[nodiscard]] float hillsAt(float x, float z);
/// n × n squares of hills above a floor at y = −20.
[[nodiscard]] TriangleMesh makeHills(std::uint32_t n);

/// A square of side 3 at `at` on an axis, perpendicular to it, with a square window of side `window` in its middle.
[[nodiscard]] TriangleMesh makePanel(int axis, double at, double window = 0.0);
/// Six panels of side 3 that intersect at ±0.5 and form the 27 rooms of a cube. The middle room is sealed, except for a
/// square window of side `window`.
[[nodiscard]] TriangleMesh makeRooms(double window = 0.0);

/// Reverses every `step`-th triangle, beginning with the first.
[[nodiscard]] TriangleMesh reversed(TriangleMesh mesh, std::size_t step = 1);
/// Merges meshes into one.
[[nodiscard]] TriangleMesh joined(const std::vector<TriangleMesh>& meshes);

/// Maps each vertex p to to(p).
template <class To>
[[nodiscard]] TriangleMesh moved(TriangleMesh mesh, const To& to) {
    for (glm::vec3& p : mesh.positions) {
        p = glm::vec3(to(glm::dvec3(p)));
    }
    return finished(mesh.positions, mesh.triangles);
}

/// Removes the triangles whose centroid satisfies `gone`.
template <class Gone>
[[nodiscard]] TriangleMesh without(const TriangleMesh& mesh, const Gone& gone) {
    std::vector<glm::uvec3> kept;
    for (const glm::uvec3& t : mesh.triangles) {
        const glm::dvec3 sum = glm::dvec3(mesh.positions[t.x]) + glm::dvec3(mesh.positions[t.y]) +
                               glm::dvec3(mesh.positions[t.z]);
        if (!gone(sum / 3.0)) {
            kept.push_back(t);
        }
    }
    return finished(mesh.positions, kept);
}

/// Fails the test if the mesh is invalid.
[[nodiscard]] MeshQuery queryOf(PreparedMesh mesh);

/// Fails the test if the bake fails.
[[nodiscard]] Collider bakeMaps(const PreparedMesh& mesh, std::vector<MapSpec> maps,
                                Quality quality = Quality::kNormal, Prefer prefer = Prefer::kNeither);
/// Bakes map specs; fails the test on errors. Maps default to the paper's texels: projected, half.
[[nodiscard]] Collider bakeSpecs(const PreparedMesh& mesh, const std::vector<std::string>& specs,
                                 std::uint32_t resolution = 64, unsigned threads = 0);
[[nodiscard]] DepthMap bakeMap(const TriangleMesh& mesh, const std::string& spec,
                               std::uint32_t resolution = 64);

}  // namespace relief::test

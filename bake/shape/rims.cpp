// SPDX-License-Identifier: Apache-2.0
#include "bake/shape/rims.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <glm/common.hpp>
#include <glm/geometric.hpp>
#include <glm/vector_relational.hpp>
#include <limits>
#include <utility>

#include "bake/mesh/mesh_query.h"
#include "bake/mesh/prepared_mesh.h"
#include "bake/repair/hole_caps.h"
#include "bake/shape/parts.h"

namespace relief {
namespace {

/// Rims face each other if all of either is this near to the other, in units of its longest side.
constexpr double kRimGap = 0.2;
/// A wall has at most this share of the volume within its outer shell.
constexpr double kWallVolume = 0.95;
/// Limit of the pairs of corners that are compared.
constexpr std::size_t kRimPairs = 100'000'000;

/// Newell's normal.
glm::dvec3 normalOf(const Rim& rim) {
    const std::vector<glm::dvec3>& at = rim.places;
    glm::dvec3 normal(0.0);
    for (std::size_t i = 0; i < at.size(); ++i) {
        normal += cross(at[i] - at[0], at[(i + 1) % at.size()] - at[0]);
    }
    return normal;
}

/// The largest distance of a rim's corners from another rim.
double distanceTo(const Rim& from, const Rim& to) {
    double largest = 0.0;
    for (const glm::dvec3& p : from.places) {
        double least = std::numeric_limits<double>::max();
        for (std::size_t i = 0; i < to.places.size(); ++i) {
            const glm::dvec3& a = to.places[i];
            const glm::dvec3& b = to.places[(i + 1) % to.places.size()];
            least = std::min(least, distance(p, closestOnTriangle(p, a, b, a)));
        }
        largest = std::max(largest, least);
    }
    return largest;
}

bool meets(const Bounds& a, const Bounds& b) {
    return glm::all(glm::lessThanEqual(a.min, b.max)) && glm::all(glm::lessThanEqual(b.min, a.max));
}

Bounds boundsOf(const Rim& rim) {
    Bounds box;
    for (const glm::dvec3& p : rim.places) {
        box.add(p);
    }
    return box;
}

bool faceEachOther(const Rim& a, const Rim& b) {
    const Bounds of_a = boundsOf(a);
    const Bounds of_b = boundsOf(b);
    const double gap = kRimGap * double{of_b.longestSide()};
    const glm::dvec3 apart =
        glm::max(glm::abs(glm::dvec3(of_a.min - of_b.min)), glm::abs(glm::dvec3(of_a.max - of_b.max)));
    return std::max({apart.x, apart.y, apart.z}) <= gap && a.places.size() * b.places.size() <= kRimPairs &&
           distanceTo(b, a) <= gap && distanceTo(a, b) <= gap;
}

/// Within a mesh whose rims are closed by fans.
double volumeWithin(const TriangleMesh& mesh, const std::vector<Rim>& rims) {
    std::vector<glm::uvec3> triangles = mesh.triangles;
    for (const Rim& rim : rims) {
        for (std::size_t i = 1; i + 1 < rim.vertices.size(); ++i) {
            triangles.emplace_back(rim.vertices[0], rim.vertices[i], rim.vertices[i + 1]);
        }
    }
    return std::abs(enclosedVolume(mesh.positions, triangles, mesh.bounds.center()).value_or(0.0));
}

/// Appends the ring between two rims that run the same way.
void addRing(TriangleMesh& mesh, const std::vector<std::uint32_t>& a, std::vector<std::uint32_t> b) {
    const auto apart = [&](std::uint32_t i, std::uint32_t k) {
        return distance(glm::dvec3(mesh.positions[i]), glm::dvec3(mesh.positions[k]));
    };
    const auto nearest = std::ranges::min_element(b, {}, [&](std::uint32_t k) { return apart(a[0], k); });
    std::rotate(b.begin(), nearest, b.end());
    std::size_t i = 0;
    std::size_t k = 0;
    while (i < a.size() || k < b.size()) {
        const std::uint32_t here = a[i % a.size()];
        const std::uint32_t there = b[k % b.size()];
        const std::uint32_t next = a[(i + 1) % a.size()];
        const std::uint32_t beyond = b[(k + 1) % b.size()];
        if (k == b.size() || (i < a.size() && apart(next, there) <= apart(here, beyond))) {
            mesh.triangles.emplace_back(here, next, there);
            ++i;
        } else {
            mesh.triangles.emplace_back(here, beyond, there);
            ++k;
        }
        ++mesh.cap_triangles;
    }
    ++mesh.closed_holes;
}

}  // namespace

OpenShell openShellOf(TriangleMesh mesh) {
    const PreparedMesh open(std::move(mesh));
    OpenShell shell{*open, {}};
    for (const BorderLoop& loop : borderLoops(open.oddEdges())) {
        Rim& rim = shell.rims.emplace_back();
        for (const BorderStep& step : loop) {
            rim.vertices.push_back(step.from);
            rim.places.emplace_back(open->positions[step.from]);
        }
    }
    return shell;
}

std::optional<TriangleMesh> wallBetween(const OpenShell& outer, const OpenShell& inner) {
    if (!meets(outer.mesh.bounds, inner.mesh.bounds)) {
        return std::nullopt;
    }
    bool turn = false;
    std::vector<bool> taken(outer.rims.size(), false);
    std::vector<std::array<const Rim*, 2>> pairs;  // outer and inner ones
    for (const Rim& rim : inner.rims) {
        for (std::size_t i = 0; i < outer.rims.size(); ++i) {
            if (!taken[i] && faceEachOther(outer.rims[i], rim)) {
                taken[i] = true;
                turn = dot(normalOf(outer.rims[i]), normalOf(rim)) > 0.0;
                pairs.push_back({&outer.rims[i], &rim});
                break;
            }
        }
    }
    if (pairs.empty() || pairs.size() < inner.rims.size()) {
        return std::nullopt;
    }
    TriangleMesh wall = outer.mesh;
    const auto first = static_cast<std::uint32_t>(wall.positions.size());
    wall.positions.insert(wall.positions.end(), inner.mesh.positions.begin(), inner.mesh.positions.end());
    for (const glm::uvec3& t : inner.mesh.triangles) {
        wall.triangles.push_back(first + (turn ? glm::uvec3(t.x, t.z, t.y) : t));
    }
    wall.labels.insert(wall.labels.end(), inner.mesh.labels.begin(), inner.mesh.labels.end());
    for (const auto& [a, b] : pairs) {
        std::vector<std::uint32_t> rim = b->vertices;
        for (std::uint32_t& vertex : rim) {
            vertex += first;
        }
        if (dot(normalOf(*a), normalOf(*b)) <= 0.0) {
            std::ranges::reverse(rim);
        }
        addRing(wall, a->vertices, std::move(rim));
    }
    wall.labels.resize(wall.triangles.size(), kNoLabel);
    if (volumeWithin(wall, {}) >= kWallVolume * volumeWithin(outer.mesh, outer.rims)) {
        return std::nullopt;  // one beside the other
    }
    return wall;
}

}  // namespace relief

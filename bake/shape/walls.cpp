// SPDX-License-Identifier: Apache-2.0
#include "bake/shape/walls.h"

#include <tbb/parallel_for.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <functional>
#include <glm/common.hpp>
#include <glm/geometric.hpp>
#include <numeric>
#include <optional>
#include <utility>

#include "bake/mesh/mesh_query.h"
#include "bake/mesh/prepared_mesh.h"
#include "bake/repair/hole_caps.h"
#include "bake/shape/parts.h"

namespace relief {
namespace {

/// Maximum distance of two facing rims from each other, in both directions, in units of the inner rim's longest side.
constexpr double kRimGap = 0.5;
/// Maximum difference between the bounds of mouths that nearly face each other, in the same units.
constexpr double kNearRimGap = 1.5;
/// Maximum area of inner rims that face no rim, as a fraction of the other rims' area.
constexpr double kUnmatchedArea = 0.5;
/// Maximum volume of a wall, as a fraction of the volume within its outer shell.
constexpr double kWallVolume = 0.95;
/// A spike's base is shorter than this fraction of its sides. Spikes are kept if more than one in kSpikesOfCorners
/// corners is a spike.
constexpr double kSpike = 0.5;
constexpr std::size_t kSpikesOfCorners = 8;
constexpr std::size_t kRimPairs = 100'000'000;

/// A border of an open shell, in the direction of a cap's triangles.
struct Rim {
    std::vector<std::uint32_t> vertices;
    std::vector<glm::dvec3> places;  ///< positions of the vertices
    Bounds bounds;
    glm::dvec3 normal{0.0};  ///< Newell's normal
    /// Triangles, absent from the mesh, that fill the spikes cut off the rim.
    std::vector<glm::uvec3> missing;
};

struct RimmedShell {
    std::size_t index = 0;  ///< of the candidate
    bool may_be_solid = false;
    TriangleMesh mesh;      ///< after finishMesh
    int axis = 0;           ///< the longest axis
    std::vector<Rim> rims;  ///< sorted by the lower bound along the axis
    double volume = 0.0;    ///< enclosed volume with closed rims
};

/// Returns the volume enclosed by a mesh whose rims are closed by fans.
double volumeWithin(const TriangleMesh& mesh, const std::vector<const Rim*>& rims, std::uint32_t first = 0) {
    std::vector<glm::uvec3> triangles = mesh.triangles;
    for (const Rim* rim : rims) {
        for (std::size_t i = 1; i + 1 < rim->vertices.size(); ++i) {
            triangles.push_back(first + glm::uvec3(rim->vertices[0], rim->vertices[i], rim->vertices[i + 1]));
        }
        for (const glm::uvec3& triangle : rim->missing) {
            triangles.push_back(first + triangle);
        }
    }
    return std::abs(enclosedVolume(mesh.positions, triangles, mesh.bounds.center()).value_or(0.0));
}

bool hasFace(const TriangleMesh& mesh, const glm::uvec3& corners) {
    return std::ranges::any_of(mesh.triangles, [&](const glm::uvec3& face) {
        const auto isCorner = [&](std::uint32_t v) { return v == face.x || v == face.y || v == face.z; };
        return isCorner(corners.x) && isCorner(corners.y) && isCorner(corners.z);
    });
}

/// Cuts spikes off a rim, each of which is a triangle that the mesh lacks, unless a large fraction of the corners are
/// spikes.
void cutSpikes(const TriangleMesh& mesh, Rim& rim) {
    const std::size_t count = rim.vertices.size();
    std::vector<bool> cut(count, false);
    for (std::size_t i = 0; i < count; ++i) {
        const std::size_t before = (i + count - 1) % count;
        const std::size_t after = (i + 1) % count;
        const double base = distance(rim.places[before], rim.places[after]);
        const double sides =
            std::min(distance(rim.places[before], rim.places[i]), distance(rim.places[i], rim.places[after]));
        const glm::uvec3 corners(rim.vertices[before], rim.vertices[i], rim.vertices[after]);
        if (!cut[before] && !cut[after] && base > 0.0 && base < kSpike * sides && !hasFace(mesh, corners)) {
            cut[i] = true;
            rim.missing.push_back(corners);
        }
    }
    if (kSpikesOfCorners * rim.missing.size() > count) {
        rim.missing.clear();
        return;
    }
    std::size_t kept = 0;
    for (std::size_t i = 0; i < count; ++i) {
        if (!cut[i]) {
            rim.vertices[kept] = rim.vertices[i];
            rim.places[kept++] = rim.places[i];
        }
    }
    rim.vertices.resize(kept);
    rim.places.resize(kept);
}

void findRims(RimmedShell& shell) {
    const glm::dvec3 size = shell.mesh.bounds.size();
    shell.axis = size.x >= std::max(size.y, size.z) ? 0 : size.y >= size.z ? 1 : 2;
    const PreparedMesh open(shell.mesh);
    for (const BorderLoop& loop : borderLoops(open.oddEdges())) {
        Rim& rim = shell.rims.emplace_back();
        for (const BorderStep& step : loop) {
            rim.vertices.push_back(step.from);
            rim.places.emplace_back(open->positions[step.from]);
        }
        cutSpikes(shell.mesh, rim);
        for (const glm::dvec3& place : rim.places) {
            rim.bounds.add(place);
        }
        for (std::size_t i = 1; i + 1 < rim.places.size(); ++i) {
            rim.normal += cross(rim.places[i] - rim.places[0], rim.places[i + 1] - rim.places[0]);
        }
    }
    std::ranges::stable_sort(shell.rims, {}, [&](const Rim& rim) { return rim.bounds.min[shell.axis]; });
    std::vector<const Rim*> all;
    for (const Rim& rim : shell.rims) {
        all.push_back(&rim);
    }
    shell.volume = volumeWithin(shell.mesh, all);
}

/// Whether every corner of one rim is within a gap of the other rim.
bool isNear(const Rim& from, const Rim& to, double gap) {
    const std::size_t count = to.places.size();
    std::size_t side = 0;  // the side that was near the previous corner
    return std::ranges::all_of(from.places, [&](const glm::dvec3& p) {
        for (std::size_t i = 0; i < count; ++i, side = (side + 1) % count) {
            const glm::dvec3& a = to.places[side];
            const glm::dvec3& b = to.places[(side + 1) % count];
            if (distance(p, closestOnTriangle(p, a, b, a)) <= gap) {
                return true;
            }
        }
        return false;
    });
}

double boxGap(const Bounds& a, const Bounds& b) {
    const glm::dvec3 most =
        glm::max(glm::abs(glm::dvec3(a.min - b.min)), glm::abs(glm::dvec3(a.max - b.max)));
    return std::max({most.x, most.y, most.z});
}

/// Returns the nearest of the outer shell's rims that faces an inner one; the number of outer rims if there is none.
std::size_t facingRim(const RimmedShell& outer, const std::vector<bool>& taken, const Rim& rim) {
    const double gap = kRimGap * double{rim.bounds.longestSide()};
    const double from = double{rim.bounds.min[outer.axis]} - gap;
    const auto low = [&](const Rim& other) { return double{other.bounds.min[outer.axis]}; };
    std::vector<std::pair<double, std::size_t>> near;
    for (auto other = std::ranges::lower_bound(outer.rims, from, {}, low);
         other != outer.rims.end() && low(*other) <= from + 2.0 * gap; ++other) {
        const auto index = static_cast<std::size_t>(other - outer.rims.begin());
        if (const double by = boxGap(other->bounds, rim.bounds); by <= gap && !taken[index]) {
            near.emplace_back(by, index);
        }
    }
    std::ranges::sort(near);
    for (const auto& [by, index] : near) {
        const Rim& other = outer.rims[index];
        if (other.places.size() * rim.places.size() <= kRimPairs && isNear(rim, other, gap) &&
            isNear(other, rim, gap)) {
            return index;
        }
    }
    return outer.rims.size();
}

/// Appends the ring between two rims of the same direction.
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

/// Returns nullopt if too few rims of the inner shell face rims of the outer one, or if it is not inside the outer one.
std::optional<ShellWall> wallBetween(const RimmedShell& outer, const RimmedShell& inner) {
    if (!outer.mesh.bounds.meets(inner.mesh.bounds)) {
        return std::nullopt;
    }
    std::vector<bool> taken(outer.rims.size(), false);
    std::vector<std::array<const Rim*, 2>> pairs;  // outer, inner
    std::vector<const Rim*> unmatched;             // inner rims
    double largest = 0.0;
    double area = 0.0;
    bool turn = false;
    for (const Rim& rim : inner.rims) {
        const std::size_t index = facingRim(outer, taken, rim);
        const double size = length(rim.normal);
        if (index == outer.rims.size()) {
            unmatched.push_back(&rim);
            area -= size / kUnmatchedArea;
            continue;
        }
        taken[index] = true;
        area += size;
        pairs.push_back({&outer.rims[index], &rim});
        if (size >= largest) {
            largest = size;
            turn = dot(outer.rims[index].normal, rim.normal) > 0.0;
        }
    }
    if (pairs.empty() || area < 0.0) {
        return std::nullopt;
    }
    TriangleMesh wall = outer.mesh;
    const TriangleMesh& within = inner.mesh;
    const auto first = static_cast<std::uint32_t>(wall.positions.size());
    wall.positions.insert(wall.positions.end(), within.positions.begin(), within.positions.end());
    for (const glm::uvec3& t : within.triangles) {
        wall.triangles.push_back(first + (turn ? glm::uvec3(t.x, t.z, t.y) : t));
    }
    wall.labels.insert(wall.labels.end(), within.labels.begin(), within.labels.end());
    for (const auto& [a, b] : pairs) {
        wall.triangles.insert(wall.triangles.end(), a->missing.begin(), a->missing.end());
        for (const glm::uvec3& t : b->missing) {
            wall.triangles.push_back(first + (turn ? glm::uvec3(t.x, t.z, t.y) : t));
        }
        wall.cap_triangles += a->missing.size() + b->missing.size();
        std::vector<std::uint32_t> rim = b->vertices;
        for (std::uint32_t& vertex : rim) {
            vertex += first;
        }
        if (dot(a->normal, b->normal) <= 0.0) {
            std::ranges::reverse(rim);
        }
        addRing(wall, a->vertices, std::move(rim));
    }
    wall.labels.resize(wall.triangles.size(), kNoLabel);
    if (volumeWithin(wall, unmatched, first) >= kWallVolume * outer.volume) {
        return std::nullopt;  // side by side
    }
    return ShellWall{outer.index, inner.index, turn, std::move(wall)};
}

/// Whether a shell is inside another one and their largest rims nearly face each other.
bool nearlyFace(const RimmedShell& outer, const RimmedShell& inner) {
    const auto largest = [](const RimmedShell& shell) {
        return std::ranges::max_element(shell.rims, {}, [](const Rim& rim) { return length(rim.normal); });
    };
    if (outer.rims.empty() || inner.rims.empty() || inner.volume < (1.0 - kWallVolume) * outer.volume) {
        return false;
    }
    const Bounds mouth = largest(inner)->bounds;
    return outer.mesh.bounds.contains(inner.mesh.bounds.center()) &&
           boxGap(mouth, largest(outer)->bounds) <= kNearRimGap * double{mouth.longestSide()};
}

/// Minimum extent of the smaller shell, as a fraction of the larger one's.
constexpr double kShellExtent = 0.25;

/// Returns whether a sheet is wound against the file; nullopt if only some of its triangles are.
std::optional<bool> turnedSinceImport(const Sheet& sheet, const TriangleMesh& mesh,
                                      const std::vector<bool>& turned) {
    std::size_t count = 0;
    for (std::size_t i = 0; i < sheet.triangles.size(); ++i) {
        const glm::dvec3 normal = planeOf(sheet.positions, sheet.triangles[i]).normal;
        const bool against = dot(normal, planeOf(mesh, sheet.sources[i]).normal) < 0.0;
        count += against != turned[sheet.sources[i]] ? 1 : 0;
    }
    return count == 0 || count == sheet.triangles.size() ? std::optional(count > 0) : std::nullopt;
}

/// Per candidate, whether some other candidate may be the second shell of its wall.
std::vector<bool> mayBeWalls(const std::vector<WallCandidate>& candidates) {
    std::vector<Bounds> bounds;
    for (const WallCandidate& candidate : candidates) {
        bounds.push_back(boundsOf(candidate.sheet->positions));
    }
    const auto mayFace = [&](std::size_t a, std::size_t b) {
        const auto [least, most] = std::minmax({bounds[a].longestSide(), bounds[b].longestSide()});
        return least >= static_cast<float>(kShellExtent) * most &&
               (bounds[a].contains(bounds[b].center()) || bounds[b].contains(bounds[a].center()));
    };
    std::vector<std::size_t> order(candidates.size());
    std::iota(order.begin(), order.end(), std::size_t{0});
    std::ranges::sort(order, {}, [&](std::size_t i) { return std::pair(bounds[i].min.x, i); });
    std::vector<bool> may_be_wall(candidates.size(), false);
    for (std::size_t i = 0; i < order.size(); ++i) {
        const std::size_t a = order[i];
        for (std::size_t k = i + 1; k < order.size() && bounds[order[k]].min.x <= bounds[a].max.x; ++k) {
            const std::size_t b = order[k];
            if ((candidates[a].may_be_solid || candidates[b].may_be_solid) && mayFace(a, b)) {
                may_be_wall[a] = may_be_wall[b] = true;
            }
        }
    }
    return may_be_wall;
}

/// Joins each outer shell to an inner one.
ShellWalls joinRims(std::vector<RimmedShell>& shells) {
    tbb::parallel_for(std::size_t{0}, shells.size(), [&](std::size_t i) { findRims(shells[i]); });
    std::ranges::stable_sort(shells, std::greater(), [](const RimmedShell& shell) {
        const glm::dvec3 size = shell.mesh.bounds.size();
        return size.x * size.y * size.z;
    });
    const auto mayBeWall = [&](std::size_t i, std::size_t k) {
        return shells[i].may_be_solid || shells[k].may_be_solid;
    };
    ShellWalls joined;
    std::vector<bool> done(shells.size(), false);
    for (std::size_t i = 0; i < shells.size(); ++i) {
        for (std::size_t k = i + 1; k < shells.size() && !done[i]; ++k) {
            if (done[k] || !mayBeWall(i, k)) {
                continue;
            }
            if (std::optional<ShellWall> wall = wallBetween(shells[i], shells[k])) {
                joined.walls.push_back(std::move(*wall));
                done[i] = done[k] = true;
            }
        }
    }
    for (std::size_t k = 0; k < shells.size(); ++k) {
        for (std::size_t i = 0; i < k && !done[k]; ++i) {
            if (mayBeWall(i, k) && nearlyFace(shells[i], shells[k])) {
                joined.unjoined.push_back({shells[i].index, shells[k].index});
            }
        }
    }
    return joined;
}

}  // namespace

ShellWalls findWalls(const std::vector<WallCandidate>& candidates, const std::string& name) {
    const std::vector<bool> may_be_wall = mayBeWalls(candidates);
    std::vector<RimmedShell> shells;
    for (std::size_t i = 0; i < candidates.size(); ++i) {
        if (!candidates[i].may_join || !may_be_wall[i]) {
            continue;
        }
        if (Result<TriangleMesh> mesh =
                finishMesh(meshOf(*candidates[i].sheet, name))) {  // else too small for a mesh
            shells.push_back({.index = i,
                              .may_be_solid = candidates[i].may_be_solid,
                              .mesh = std::move(*mesh),
                              .rims = {}});
        }
    }
    return joinRims(shells);
}

bool isAmbiguous(const ShellWall& wall, const std::vector<WallCandidate>& candidates,
                 const TriangleMesh& mesh, const std::vector<bool>& turned) {
    const std::optional<bool> outer = turnedSinceImport(*candidates[wall.outer].sheet, mesh, turned);
    const std::optional<bool> inner = turnedSinceImport(*candidates[wall.inner].sheet, mesh, turned);
    return !outer || !inner || wall.alike != (outer != inner);
}

}  // namespace relief

// SPDX-License-Identifier: Apache-2.0
#include "bake/bench/sheet_truth.h"

#include <algorithm>
#include <cmath>
#include <glm/common.hpp>
#include <glm/geometric.hpp>
#include <utility>

#include "bake/mesh/loops.h"
#include "bake/mesh/surface_sampler.h"
#include "bake/shape/parts.h"

namespace relief {
namespace {

/// Minimum cosine between the normal of the nearest triangle and the direction from the nearest point. Below it, the
/// nearest point is on an edge.
constexpr double kFacing = 0.98;

/// Returns a mesh of only these triangles.
TriangleMesh subset(const TriangleMesh& mesh, const std::vector<std::uint32_t>& triangles) {
    TriangleMesh part;
    part.name = mesh.name;
    part.positions = mesh.positions;
    for (const std::uint32_t i : triangles) {
        part.triangles.push_back(mesh.triangles[i]);
    }
    return part;
}

double distanceToBox(const glm::dvec3& p, const Bounds& box) {
    return length(glm::max(glm::max(glm::dvec3(box.min) - p, p - glm::dvec3(box.max)), 0.0));
}

}  // namespace

Result<SheetTruth> SheetTruth::build(const PreparedMesh& source, const ShapedMesh& shaped) {
    SheetTruth truth;
    const ShapeReport& report = shaped.report;
    truth.others_ = report.solids + report.solids_with_holes + report.terrains + report.voids > 0;
    const std::vector<Part> parts = partsOf(*source, source.edges());
    SurfaceParts found;
    for (const Part& part : parts) {
        found.add(*source, part.triangles, PartKind::kSurface);
    }
    const std::vector<SurfacePart>& known = shaped.parts.parts;
    if (!report.named.empty() || found.parts.size() != known.size()) {
        return truth;
    }
    double area = 0.0;
    for (const Part& part : parts) {
        const SurfacePart& first = known[found.part_of[part.triangles.front()]];
        if (first.kind == PartKind::kSheet) {
            TriangleMesh sheet = RELIEF_TRY(finishMesh(subset(*source, part.triangles)));
            for (const glm::uvec3& t : sheet.triangles) {
                area += 0.5 * length(planeOf(sheet.positions, t).normal);
            }
            MeshQuery query = RELIEF_TRY(MeshQuery::build(std::move(sheet)));
            static_cast<void>(query.prepared().areas());  // computed before threads use it
            truth.sheets_.push_back({std::move(query), first.thickness, area});
        }
    }
    return truth;
}

std::optional<bool> SheetTruth::inside(const glm::vec3& p) const {
    bool unclear = false;
    for (const Sheet& sheet : sheets_) {
        if (distanceToBox(p, sheet.query.mesh().bounds) > sheet.thickness) {
            continue;
        }
        const ClosestPoint closest = sheet.query.closest(p);
        const glm::dvec3 offset = glm::dvec3(p) - closest.point;
        const glm::dvec3 normal = unitNormal(sheet.query.mesh(), closest.triangle);
        const bool faces = std::abs(dot(offset, normal)) >= kFacing * closest.distance;
        if (faces && closest.distance < 0.5 * sheet.thickness) {
            return true;
        }
        unclear = unclear || (!faces && closest.distance < sheet.thickness);
    }
    return unclear ? std::nullopt : std::optional(false);
}

std::vector<TruthPoint> SheetTruth::sample(const MeshQuery& solid, const AccuracyOptions& options) const {
    std::vector<std::optional<TruthPoint>> drawn(empty() ? 0 : options.samples);
    forEachIndex(0, drawn.size(), 64, [&](std::size_t i) {
        MersenneRandom random(options.seed, i);
        const double at = random.uniform() * sheets_.back().area;
        const Sheet& sheet =
            *std::ranges::upper_bound(sheets_.begin(), std::prev(sheets_.end()), at, {}, &Sheet::area);
        const TriangleMesh& mesh = sheet.query.mesh();
        const SurfaceDraw on = drawOnSurface(mesh, sheet.query.prepared().areas(), random.uniform(), random);
        const glm::vec3 p = on.position + sheet.thickness * (2.0 * random.uniform() - 1.0) * on.normal;
        const std::optional<bool> is_inside = inside(p);
        if (is_inside && (*is_inside || !others_ || !solid.inside(p))) {
            drawn[i] = TruthPoint{p, *is_inside ? -1.0F : 1.0F};
        }
    });
    std::vector<TruthPoint> points;
    for (const std::optional<TruthPoint>& point : drawn) {
        if (point) {
            points.push_back(*point);
        }
    }
    return points;
}

}  // namespace relief

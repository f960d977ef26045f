// SPDX-License-Identifier: Apache-2.0
#include "bake/shape/shape.h"

#include <tbb/parallel_for.h>

#include <algorithm>
#include <array>
#include <limits>
#include <optional>
#include <span>
#include <utility>
#include <vector>

#include "bake/mesh/mesh_edges.h"
#include "bake/mesh/mesh_query.h"
#include "bake/repair/hole_caps.h"
#include "bake/repair/winding.h"
#include "bake/shape/open_part.h"
#include "bake/shape/parts.h"
#include "bake/shape/sealed_voids.h"
#include "bake/shape/solids.h"
#include "bake/shape/walls.h"

namespace relief {
namespace {

/// A closed part is a two-sided sheet if more than this fraction of its triangles coincide in pairs.
constexpr double kTwice = 0.9;
/// Depth of the ground below a terrain, in units of the longest side.
constexpr double kGround = 0.05;

class Shaper {
  public:
    /// \param turned  per triangle: flipped before windOutwards; empty: none.
    Shaper(const PreparedMesh& mesh, const ShapeOptions& options, std::vector<bool> turned = {})
        : prepared_(mesh), mesh_(*mesh), options_(options), turned_(std::move(turned)), union_(mesh_) {
        turned_.resize(mesh_.triangles.size(), false);
        for (std::size_t i = 0; i < mesh.turned().size(); ++i) {
            turned_[i] = turned_[i] != mesh.turned()[i];
        }
        report_.as = options.as;
        for (const NamedShape& named : options.named) {
            report_.named.push_back({named, 0});
        }
    }

    Result<ShapedMesh> run() {
        const MeshEdges& edges = prepared_.edges();
        welded_ = edges.welded;
        parts_ = partsOf(mesh_, edges);
        kinds_ = kindsOfTriangles();
        if (!kinds_.empty()) {
            keepSolidsWhole();
            parts_ = partsOf(mesh_, edges, kinds_);
        }
        prepared_.freeEdges();
        if (const std::vector<std::uint32_t> copies = copiesInSolids(mesh_, welded_, parts_);
            !copies.empty()) {
            ShapedMesh shaped = RELIEF_TRY(runWithout(copies, ""));
            shaped.report.coincident_triangles += copies.size();
            return shaped;
        }
        std::vector<const Part*> solids;
        std::vector<const Part*> others;
        for (const Part& part : parts_) {
            const bool solid = isSolid(part);
            collected_.add(mesh_, part.triangles, solid ? PartKind::kSolid : PartKind::kSurface);
            (solid ? solids : others).push_back(&part);
        }
        if (const NearCopies copies = nearCopies(mesh_, solids); copies.parts > 0) {
            ShapedMesh shaped = RELIEF_TRY(runWithout(copies.triangles, copies.text()));
            shaped.report.near_copies += copies.parts;
            return shaped;
        }
        if (others.empty()) {
            report_.solids = solids.size();
            return ShapedMesh{prepared_, report_, std::move(collected_)};
        }
        for (const Part* part : solids) {
            union_.addSource(part->triangles, collected_.part_of, part->balanced ? 0 : ++bodies_);
        }
        report_.solids = solids.size();
        makeSheets(others);
        RELIEF_TRY(classifyOpenParts(open_, prepared_, kinds_, parts_.size()));
        RELIEF_TRY(closeParts());
        RELIEF_TRY(checkThickness());
        RELIEF_TRY(addSheets());
        PreparedMesh mesh = RELIEF_TRY(union_.finish(report_.thickness));
        std::vector<std::uint32_t> part_of = union_.takePartOf();
        if (options_.voids == VoidMode::kFill && std::ranges::any_of(open_, seals)) {
            mesh = RELIEF_TRY(fillVoids(std::move(mesh), part_of));
        }
        return ShapedMesh{std::move(mesh), report_, {std::move(collected_.parts), std::move(part_of)}};
    }

  private:
    /// Restarts without copies, which hide the inside; the remaining triangles must be wound again. \param warning  for
    /// the mesh, or "".
    Result<ShapedMesh> runWithout(const std::vector<std::uint32_t>& copies, const std::string& warning) {
        TriangleMesh rest = mesh_;
        if (!warning.empty()) {
            rest.warnings.push_back(mesh_.name + ": " + warning);
        }
        rest.source_triangles = mesh_.sourceTriangles();
        std::vector<bool> turned = turned_;
        std::size_t kept = 0;
        for (std::size_t i = 0, next = 0; i < mesh_.triangles.size(); ++i) {
            if (next < copies.size() && copies[next] == i) {
                ++next;
            } else {
                turned[kept] = turned_[i];
                moveTriangle(rest, i, kept++);
            }
        }
        keepTriangles(rest, kept);
        rest = RELIEF_TRY(finishMesh(std::move(rest)));
        const Winding winding = RELIEF_TRY(windOutwards(std::move(rest)));
        ShapedMesh shaped = RELIEF_TRY(Shaper(winding.mesh, options_, std::move(turned)).run());
        shaped.report.named = report_.named;
        return shaped;
    }

    /// Returns the kind of each triangle, and counts names in the report. Empty: all of one kind.
    [[nodiscard]] std::vector<ShapeAs> kindsOfTriangles() {
        if (options_.named.empty() || mesh_.marks.size() != mesh_.triangles.size()) {
            return {};
        }
        std::vector<ShapeAs> kinds(mesh_.marks.size(), options_.as);
        for (std::size_t i = 0; i < kinds.size(); ++i) {
            if (const std::size_t mark = mesh_.marks[i]; mark >= 1 && mark <= report_.named.size()) {
                NamedTriangles& named = report_.named[mark - 1];
                ++named.triangles;
                kinds[i] = named.shape.as;
            }
        }
        return kinds;
    }

    /// Makes a closed part of several kinds a solid, unless a piece of it must be a shell.
    void keepSolidsWhole() {
        for (const Part& part : parts_) {
            const auto count = [&](ShapeAs as) {
                return static_cast<std::size_t>(std::ranges::count(
                    part.triangles, as, [&](std::uint32_t triangle) { return kinds_[triangle]; }));
            };
            const bool mixed = count(kinds_[part.triangles[0]]) < part.triangles.size();
            if (part.closed && mixed && count(ShapeAs::kShell) == 0 && !isFlat(part)) {
                for (const std::uint32_t triangle : part.triangles) {
                    kinds_[triangle] = ShapeAs::kSolid;
                }
            }
        }
    }

    [[nodiscard]] ShapeAs kindOf(const Part& part) const {
        return kinds_.empty() ? options_.as : kinds_[part.triangles.front()];
    }

    [[nodiscard]] bool isSolid(const Part& part) const {
        const ShapeAs as = kindOf(part);
        return part.closed && as != ShapeAs::kShell && (as == ShapeAs::kSolid || !isFlat(part));
    }

    /// Whether a closed part has no volume, such as a two-sided sheet.
    [[nodiscard]] bool isFlat(const Part& part) const {
        std::vector<glm::uvec3> triangles;
        triangles.reserve(part.triangles.size());
        for (const std::uint32_t i : part.triangles) {
            triangles.push_back(mesh_.triangles[i]);
        }
        if (!enclosedVolume(mesh_.positions, triangles, mesh_.bounds.center())) {
            return true;
        }
        if (part.manifold) {
            return false;  // a coincident pair with manifold edges is a separate part without volume
        }
        std::vector<SortedTriangle> sorted = sortedTriangles(mesh_, welded_, part.triangles);
        const auto repeats = static_cast<double>(dropRepeats(sorted));
        return 2.0 * repeats > kTwice * static_cast<double>(part.triangles.size());
    }

    /// Turns all open parts into sheets; classifyOpenParts() finds the other kinds.
    void makeSheets(const std::vector<const Part*>& parts) {
        open_.resize(parts.size());
        tbb::parallel_for(std::size_t{0}, parts.size(), [&](std::size_t i) {
            open_[i] = {sheetOf(mesh_, welded_, parts[i]->triangles), kindOf(*parts[i]), {}};
        });
        for (const OpenPart& part : open_) {
            report_.coincident_triangles += part.sheet.duplicates;
        }
    }

    /// Returns the parts of some source triangles, and sets their kind.
    [[nodiscard]] std::vector<std::uint32_t> partsFor(std::span<const std::uint32_t> sources, PartKind kind) {
        std::vector<std::uint32_t> parts;
        parts.reserve(sources.size());
        for (const std::uint32_t source : sources) {
            parts.push_back(source == kNoLabel ? kNoLabel : collected_.part_of[source]);
            if (parts.back() != kNoLabel) {
                collected_.parts[parts.back()].kind = kind;
            }
        }
        return parts;
    }

    void add(const ClosedPart& closed) {
        const TriangleMesh& mesh = **closed.mesh;
        union_.add(mesh.positions, mesh.triangles, partsFor(mesh.labels, PartKind::kSolidWithHoles),
                   mesh.sourceTriangles(), closed.balanced ? 0 : ++bodies_);
        union_.countHoles(mesh.closed_holes);
    }

    /// Closes each part with holes separately, then the rest together (panels whose seams do not meet).
    Result<void> closeParts() {
        const std::vector<bool> joined = RELIEF_TRY(addWalls());
        std::vector<OpenPart*> holed;
        for (std::size_t i = 0; i < open_.size(); ++i) {
            OpenKind& kind = open_[i].role.kind;
            if (joined[i]) {
                kind = OpenKind::kJoined;
            } else if (kind == OpenKind::kHoled || kind == OpenKind::kPossiblyHoled) {
                holed.push_back(&open_[i]);
            }
        }
        std::vector<Result<ClosedPart>> closed(holed.size(), ClosedPart{});
        tbb::parallel_for(std::size_t{0}, holed.size(), [&](std::size_t i) {
            const Result<TriangleMesh> mesh = finishMesh(meshOf(holed[i]->sheet, mesh_.name));
            if (mesh) {  // else too small for a mesh
                closed[i] = closePart(*mesh, holed[i]->role.kind == OpenKind::kHoled, mesh_.unit.empty());
            }
        });
        std::array<std::vector<OpenPart*>, kWordsOf<ShapeAs>.size()> left;  // by kind
        for (std::size_t i = 0; i < holed.size(); ++i) {
            const ClosedPart part = RELIEF_TRY(std::move(closed[i]));
            if (part.mesh && part.is_body) {
                holed[i]->full = true;
                add(part);
                ++report_.solids_with_holes;
            } else if (holed[i]->role.kind == OpenKind::kPossiblyHoled) {
                holed[i]->role.kind = OpenKind::kSheet;
                report_.closable_sheets += part.mesh ? 1 : 0;
            } else {
                left[static_cast<std::size_t>(holed[i]->as)].push_back(holed[i]);
            }
        }
        for (const std::vector<OpenPart*>& parts : left) {
            if (!parts.empty()) {
                RELIEF_TRY(closeTogether(parts));
            }
        }
        std::optional<std::size_t> counted;
        for (const auto& [outer, inner] : unjoined_) {
            if ((open_[outer].full || open_[inner].full) && counted != inner) {
                counted = inner;
                ++report_.unjoined_shells;
            }
        }
        return {};
    }

    /// Adds the walls of joined shells; the space within stays free. \return per part, whether it was joined to another
    /// one.
    Result<std::vector<bool>> addWalls() {
        std::vector<WallCandidate> candidates;
        for (const OpenPart& part : open_) {
            const bool automatic = part.as == ShapeAs::kAuto;
            const OpenKind kind = part.role.kind;
            candidates.push_back(
                {&part.sheet, automatic && kind != OpenKind::kTerrain,
                 automatic && (kind == OpenKind::kHoled || kind == OpenKind::kPossiblyHoled)});
        }
        ShellWalls walls = findWalls(candidates, mesh_.name);
        unjoined_ = std::move(walls.unjoined);
        std::vector<bool> joined(open_.size(), false);
        for (ShellWall& wall : walls.walls) {
            const TriangleMesh finished = RELIEF_TRY(finishMesh(std::move(wall.mesh)));
            const ClosedPart solid = RELIEF_TRY(closePart(finished, true, mesh_.unit.empty()));
            if (solid.mesh) {
                add(solid);
                ++report_.solids_with_holes;
                joined[wall.outer] = joined[wall.inner] = true;
                report_.ambiguous_walls += isAmbiguous(wall, candidates, mesh_, turned_) ? 1 : 0;
            }
        }
        return joined;
    }

    /// \param parts  all of one kind.
    Result<void> closeTogether(const std::vector<OpenPart*>& parts) {
        TriangleMesh rest;
        rest.name = mesh_.name;
        for (const OpenPart* part : parts) {
            const auto first = static_cast<std::uint32_t>(rest.positions.size());
            rest.positions.insert(rest.positions.end(), part->sheet.positions.begin(),
                                  part->sheet.positions.end());
            for (const glm::uvec3& t : part->sheet.triangles) {
                rest.triangles.push_back(t + first);
            }
            rest.labels.insert(rest.labels.end(), part->sheet.sources.begin(), part->sheet.sources.end());
        }
        rest = RELIEF_TRY(finishMesh(std::move(rest)));
        const ClosedPart closed = RELIEF_TRY(closePart(rest, true, mesh_.unit.empty()));
        if (closed.mesh) {
            add(closed);
            ++report_.solids_with_holes;
            return {};
        }
        const MeshQuery query = RELIEF_TRY(MeshQuery::build(rest));
        const Enclosure enclosure = measureEnclosure(query);
        if (parts.front()->as == ShapeAs::kSolid ||
            (enclosure.one_sided >= kOneSided && enclosure.agreement >= kAgreement)) {
            union_.add(rest.positions, rest.triangles, partsFor(rest.labels, PartKind::kSolidWithHoles),
                       rest.triangles.size(), ++bodies_);
            ++report_.solids_with_holes;
            return {};
        }
        for (OpenPart* part : parts) {
            part->role.kind = OpenKind::kSheet;
        }
        return {};
    }

    /// A given thickness must suit the smallest sheet, and the resolution of floats.
    [[nodiscard]] Result<void> checkThickness() const {
        double smallest = std::numeric_limits<double>::max();
        for (const OpenPart& part : open_) {
            if (part.role.kind == OpenKind::kSheet) {
                smallest = std::min(smallest, sizeOf(part.sheet));
            }
        }
        if (options_.thickness_by_part || smallest == std::numeric_limits<double>::max()) {
            return {};
        }
        return checkShellThickness(options_.thickness, smallest, mesh_);
    }

    Result<void> addSheets() {
        for (const OpenPart& part : open_) {
            if (part.role.kind == OpenKind::kSheet) {
                const double size = sizeOf(part.sheet);
                const double thickness =
                    options_.thickness_by_part
                        ? partThickness(options_.thickness, size, options_.thickness_by_texel)
                        : options_.thickness;
                const double right =
                    options_.thickness_by_part ? targetThickness(thickness, size) : thickness;
                TriangleMesh finished = RELIEF_TRY(finishMesh(meshOf(part.sheet, mesh_.name)));
                const MeshQuery query = RELIEF_TRY(MeshQuery::build(std::move(finished)));
                add(part.sheet, thickened(part.sheet, query, thickness), PartKind::kSheet);
                for (const std::uint32_t source : part.sheet.sources) {
                    SurfacePart& piece = collected_.parts[collected_.part_of[source]];
                    piece.thickness = thickness;
                    piece.target_thickness = right;
                }
                report_.thickness = std::max(report_.thickness, thickness);
                report_.thickness_min =
                    report_.sheets == 0 ? thickness : std::min(report_.thickness_min, thickness);
                ++report_.sheets;
            } else if (part.role.kind == OpenKind::kTerrain) {
                const int axis = part.role.axis;
                const float low = boundsOf(part.sheet.positions).min[axis];
                const float depth = static_cast<float>(kGround) * mesh_.bounds.longestSide();
                add(part.sheet, extruded(part.sheet, axis, low - depth), PartKind::kTerrain);
                ++report_.terrains;
            }
        }
        report_.default_thickness =
            options_.thickness_by_part && report_.sheets > 0 ? options_.thickness : 0.0;
        return {};
    }

    /// Whether a part can seal a void. Shells requested with --as cannot: they have free space on both sides.
    static bool seals(const OpenPart& part) {
        return part.role.kind == OpenKind::kSheet && part.as != ShapeAs::kShell;
    }

    Result<PreparedMesh> fillVoids(PreparedMesh mesh, std::vector<std::uint32_t>& part_of) {
        std::vector<Wall> of_part(collected_.parts.size(), Wall::kSolid);
        for (const OpenPart& part : open_) {
            if (part.role.kind == OpenKind::kSheet) {
                for (const std::uint32_t source : part.sheet.sources) {
                    of_part[collected_.part_of[source]] = seals(part) ? Wall::kSheet : Wall::kNothing;
                }
            }
        }
        std::vector<Wall> walls(part_of.size(), Wall::kSheet);
        for (std::size_t i = 0; i < walls.size(); ++i) {
            if (part_of[i] != kNoLabel) {
                walls[i] = of_part[part_of[i]];
            }
        }
        const MeshQuery query = RELIEF_TRY(MeshQuery::build(mesh));
        Voids voids = sealedVoids(query, walls);
        report_.voids = voids.count;
        return voids.count > 0 ? withVoids(query, std::move(voids), part_of) : mesh;
    }

    void add(const Sheet& sheet, const SolidPart& solid, PartKind kind) {
        std::vector<std::uint32_t> sources;
        sources.reserve(solid.sources.size());
        for (const std::uint32_t triangle : solid.sources) {
            sources.push_back(sheet.sources[triangle]);
        }
        union_.add(solid.positions, solid.triangles, partsFor(sources, kind), solid.surface_triangles, 0);
    }

    const PreparedMesh& prepared_;
    const TriangleMesh& mesh_;
    const ShapeOptions& options_;
    std::vector<bool> turned_;  // by triangle; flipped relative to the file
    std::vector<std::uint32_t> welded_;
    std::vector<Part> parts_;
    std::vector<ShapeAs> kinds_;                        // by triangle; empty: options_.as
    std::vector<OpenPart> open_;                        // from parts_
    std::vector<std::array<std::size_t, 2>> unjoined_;  // ShellWalls::unjoined, as indices of open_
    std::uint32_t bodies_ = 0;                          // bodies that use parity, numbered from 1
    SurfaceParts collected_;
    SolidUnion union_;
    ShapeReport report_;
};

}  // namespace

SurfaceParts surfacePartsOf(const PreparedMesh& mesh) {
    SurfaceParts parts;
    for (const Part& part : partsOf(*mesh, mesh.edges())) {
        parts.add(*mesh, part.triangles, PartKind::kSurface);
    }
    return parts;
}

Result<ShapedMesh> shapeMesh(const PreparedMesh& mesh, const ShapeOptions& options) {
    return Shaper(mesh, options).run();
}

}  // namespace relief

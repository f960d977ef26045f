// SPDX-License-Identifier: Apache-2.0
#include "bake/shape/shape.h"

#include <tbb/parallel_for.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <glm/common.hpp>
#include <limits>
#include <optional>
#include <span>
#include <utility>
#include <vector>

#include "bake/mesh/inside.h"
#include "bake/mesh/mesh_edges.h"
#include "bake/mesh/mesh_query.h"
#include "bake/mesh/ray_cost.h"
#include "bake/mesh/surface_sampler.h"
#include "bake/repair/hole_caps.h"
#include "bake/repair/winding.h"
#include "bake/shape/near_copies.h"
#include "bake/shape/parts.h"
#include "bake/shape/sealed_voids.h"
#include "bake/shape/sheet.h"
#include "bake/shape/shell.h"
#include "bake/shape/solid_union.h"
#include "bake/shape/terrain.h"
#include "bake/shape/walls.h"

namespace relief {
namespace {

/// Sight samples of all open parts together, and the minimum for each part.
constexpr std::size_t kSightPoints = 4096;
constexpr std::size_t kSightPointsMin = 8;
/// Minimum number of probes for closing the holes of a part.
constexpr std::size_t kPartProbesMin = 64;
/// Sheet: more than this fraction of the rays from its darker side escape.
constexpr double kSheetSight = 0.1;
/// Visible part: more than this fraction of the rays from its lighter side escape.
constexpr double kSeen = 0.02;
/// A sheet that may be a solid with larger holes has at least this fraction of the mesh's extent. At most the second
/// fraction of its projected area has no opposite.
constexpr double kBodyExtent = 0.25;
constexpr double kMouthMax = 0.5;
/// A body cut off at its foot. The hole is flat: the mean normal of its triangles has at least this length. It faces
/// down by at least this cosine. At least this fraction of the surface does not see the hole from behind, tested at
/// this many points.
constexpr double kFootFlat = 0.9;
constexpr double kFootDown = 0.5;
constexpr double kFootHidden = 0.05;
constexpr int kFootPoints = 16;
/// Two-sided sheet: this fraction of a closed part's triangles coincide in pairs.
constexpr double kTwice = 0.9;
/// Minimum fraction of its rectangle that a terrain covers, minimum number of triangles, and minimum fraction of the
/// mesh's extent.
constexpr double kTerrainCover = 0.98;
constexpr std::size_t kTerrainTriangles = 200;
constexpr double kTerrainExtent = 0.8;
/// Depth of the ground below a terrain, in units of the longest side.
constexpr double kGround = 0.05;

/// Returns, for each side of a sheet, the fraction of rays that escape from the mesh; a lower bound if both exceed
/// kSheetSight.
std::array<double, 2> sightOf(const Sheet& sheet, std::size_t samples, const MeshQuery& query) {
    const double side = query.mesh().bounds.longestSide();
    const TriangleMesh mesh = meshOf(sheet, "");
    const AreaTable areas(mesh);
    MersenneRandom random(1);
    std::array<double, 2> out{};
    const auto rays = static_cast<double>(samples * kParityDirections.size());
    const auto isSheet = [&] { return std::min(out[0], out[1]) > kSheetSight * rays; };
    for (std::size_t k = 0; k < samples && !isSheet(); ++k) {
        const double at = (static_cast<double>(k) + random.uniform()) / static_cast<double>(samples);
        const auto [on, normal] = drawOnSurface(mesh, areas, at, random);
        for (std::size_t i = 0; i < kParityDirections.size() && !isSheet(); ++i) {
            const glm::dvec3& direction = kParityDirections[i];
            for (std::size_t face = 0; face < 2; ++face) {
                const glm::dvec3 towards = face == 0 ? normal : -normal;
                const glm::dvec3 from = on + kSurfaceStep * side * towards;
                const glm::dvec3 ray = dot(direction, towards) < 0.0 ? -direction : direction;
                out[face] += query.segmentIsFree(from, from + 4.0 * side * ray) ? 1.0 : 0.0;
            }
        }
    }
    return {out[0] / rays, out[1] / rays};
}

/// Whether a part with holes, after closing, is a body cut off at its foot, such as a statue open below, and not a
/// vessel. A vessel's mouth faces up, or all of its inside sees the mouth.
Result<bool> isCutOffBelow(const PreparedMesh& closed, bool z_is_up) {
    glm::dvec3 mouth(0.0);
    double area = 0.0;
    const auto caps = static_cast<std::uint32_t>(closed->surfaceTriangles());
    for (std::uint32_t i = caps; i < closed->triangles.size(); ++i) {
        const glm::dvec3 normal = planeOf(*closed, i).normal;
        mouth += normal;
        area += length(normal);
    }
    const double down = std::max(-mouth.y, z_is_up ? -mouth.z : -mouth.y);
    if (closed->closed_holes != 1 || length(mouth) < kFootFlat * area || down < kFootDown * length(mouth)) {
        return false;
    }
    const MeshQuery query = RELIEF_TRY(MeshQuery::build(closed));
    const double step = kSurfaceStep * double{closed->bounds.longestSide()};
    MersenneRandom random(1);
    std::size_t hidden = 0;
    for (std::size_t k = 0; k < kEnclosureProbes; ++k) {
        const double at = (static_cast<double>(k) + random.uniform()) / kEnclosureProbes;
        const auto [on, normal] = drawOnSurface(*closed, closed.areas(), at, random);
        bool seen = false;
        for (int i = 0; i < kFootPoints && !seen; ++i) {
            const auto cap = static_cast<std::uint32_t>(random.below(closed->cap_triangles));
            const glm::dvec3 from = on - step * normal;
            const glm::dvec3 to = drawOnTriangle(*closed, caps + cap, random).position;
            const std::optional<FirstHit> hit = query.firstHit(from, to - from);
            seen = hit && hit->triangle >= caps;
        }
        hidden += seen ? 0 : 1;
    }
    return static_cast<double>(hidden) > kFootHidden * kEnclosureProbes;
}

class Shaper {
  public:
    /// \param turned  per triangle: flipped before windOutwards; empty: none.
    Shaper(const PreparedMesh& mesh, const ShapeOptions& options, std::vector<bool> turned = {})
        : prepared_(mesh),
          mesh_(*mesh),
          options_(options),
          turned_(std::move(turned)),
          collected_(mesh_),
          union_(mesh_) {
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
            Result<ShapedMesh> shaped = runWithout(copies, "");
            if (shaped) {
                shaped->report.coincident_triangles += copies.size();
            }
            return shaped;
        }
        std::vector<const Part*> solids;
        std::vector<const Part*> others;
        for (const Part& part : parts_) {
            const bool solid = isSolid(part);
            collected_.add(part.triangles, solid ? PartKind::kSolid : PartKind::kSurface);
            (solid ? solids : others).push_back(&part);
        }
        if (const NearCopies copies = nearCopies(mesh_, solids); copies.parts > 0) {
            Result<ShapedMesh> shaped = runWithout(copies.triangles, copies.text());
            if (shaped) {
                shaped->report.near_copies += copies.parts;
            }
            return shaped;
        }
        if (others.empty()) {
            report_.solids = solids.size();
            return ShapedMesh{prepared_, report_, {std::move(collected_.parts()), collected_.partOf()}};
        }
        for (const Part* part : solids) {
            union_.addSource(part->triangles, collected_.partOf(), part->balanced ? 0 : ++bodies_);
        }
        report_.solids = solids.size();
        makeSheets(others);
        RELIEF_TRY(sortSheets());
        RELIEF_TRY(closeParts());
        RELIEF_TRY(checkThickness());
        RELIEF_TRY(addSheets());
        PreparedMesh mesh = RELIEF_TRY(union_.finish(report_.thickness));
        std::vector<std::uint32_t> part_of = union_.takePartOf();
        if (options_.voids == VoidsAs::kFull && hasSealingSheet()) {
            mesh = RELIEF_TRY(fillVoids(std::move(mesh), part_of));
        }
        return ShapedMesh{std::move(mesh), report_, {std::move(collected_.parts()), std::move(part_of)}};
    }

  private:
    enum class Kind : std::uint8_t { kHoled, kPerhapsHoled, kJoined, kSheet, kTerrain };
    struct Role {
        Kind kind = Kind::kSheet;
        int axis = 1;  ///< up axis of a terrain
    };

    /// An open part.
    struct Open {
        Sheet sheet;
        ShapeAs as = ShapeAs::kAuto;
        Role role;
        bool full = false;  ///< closed separately, and a solid
    };

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

    /// Turns all open parts into sheets; sortSheets() finds the other kinds.
    void makeSheets(const std::vector<const Part*>& parts) {
        open_.resize(parts.size());
        tbb::parallel_for(std::size_t{0}, parts.size(), [&](std::size_t i) {
            open_[i] = {sheetOf(mesh_, welded_, parts[i]->triangles), kindOf(*parts[i]), {}};
        });
        for (const Open& part : open_) {
            report_.coincident_triangles += part.sheet.duplicates;
        }
    }

    /// Finds the solids with holes and the terrains among the open parts.
    Result<void> sortSheets() {
        std::vector<Open*> unclear;
        for (Open& part : open_) {
            if (part.as == ShapeAs::kTerrain) {
                part.role = {Kind::kTerrain, terrainAxis(part.sheet).value_or(flattestAxis(part.sheet))};
            } else if (part.as == ShapeAs::kSolid) {
                part.role.kind = Kind::kHoled;
            } else if (part.as == ShapeAs::kAuto) {
                unclear.push_back(&part);
            }
        }
        if (unclear.empty()) {
            return {};
        }
        const MeshQuery query = RELIEF_TRY(MeshQuery::build(opaque()));
        const auto least = static_cast<std::size_t>(
            std::ceil(affordableRays(query.mesh()) * static_cast<double>(kSightPointsMin)));
        const std::size_t samples = std::max(least, kSightPoints / unclear.size());
        tbb::parallel_for(std::size_t{0}, unclear.size(), [&](std::size_t i) {
            Open& part = *unclear[i];
            const std::array<double, 2> sight = sightOf(part.sheet, samples, query);
            const auto [dark, light] = std::minmax(sight[0], sight[1]);
            if (dark <= kSheetSight && light > kSeen) {
                part.role.kind = Kind::kHoled;
            } else if (const std::optional<int> axis = terrainAxis(part.sheet)) {
                part.role = {Kind::kTerrain, *axis};
            } else if (const Shadow shadow = shadowOf(part.sheet);
                       sizeOf(part.sheet) >= kBodyExtent * mesh_.bounds.longestSide() &&
                       length(shadow.signed_area) <= kMouthMax * length(shadow.area)) {
                part.role.kind = Kind::kPerhapsHoled;
            }
        });
        return {};
    }

    /// Returns the mesh without future shells, which have free space on both sides, however dark.
    [[nodiscard]] PreparedMesh opaque() const {
        TriangleMesh mesh;
        for (std::size_t i = 0; i < kinds_.size(); ++i) {
            if (kinds_[i] != ShapeAs::kShell) {
                mesh.triangles.push_back(mesh_.triangles[i]);
            }
        }
        if (mesh.triangles.size() == kinds_.size()) {
            return prepared_;
        }
        mesh.name = mesh_.name;
        mesh.positions = mesh_.positions;
        Result<TriangleMesh> finished = finishMesh(std::move(mesh));
        return finished ? PreparedMesh(std::move(*finished)) : prepared_;  // may be too small for a mesh
    }

    /// Returns the up axis of a sheet that is the ground of its mesh.
    [[nodiscard]] std::optional<int> terrainAxis(const Sheet& sheet) const {
        if (sheet.triangles.size() < kTerrainTriangles) {
            return std::nullopt;
        }
        const glm::dvec3 size = boundsOf(sheet.positions).size();
        const glm::dvec3 whole = mesh_.bounds.size();
        const Shadow shadow = shadowOf(sheet);
        // If the mesh has a unit, the importer has rotated it to +Y up. Otherwise +z may also be up.
        for (const int axis : {1, 2}) {
            const int across = (axis + 1) % 3;
            const int along = (axis + 2) % 3;
            const double rectangle = size[across] * size[along];
            const bool ground = size[axis] < 0.7 * std::min(size[across], size[along]) &&
                                size[across] >= kTerrainExtent * whole[across] &&
                                size[along] >= kTerrainExtent * whole[along];
            // All triangles face the same way, so nothing is covered twice.
            const bool heights = std::abs(shadow.signed_area[axis]) >= 0.9999 * shadow.area[axis] &&
                                 0.5 * shadow.area[axis] >= kTerrainCover * rectangle;
            if (ground && heights && (axis == 1 || (mesh_.unit.empty() && parts_.size() == 1))) {
                return axis;
            }
        }
        return std::nullopt;
    }

    /// Returns the axis of the largest projection.
    static int flattestAxis(const Sheet& sheet) {
        const glm::dvec3 area = glm::abs(shadowOf(sheet).signed_area);
        return area.y >= std::max(area.x, area.z) ? 1 : area.z >= area.x ? 2 : 0;
    }

    /// Returns the parts of some source triangles, and sets their kind.
    [[nodiscard]] std::vector<std::uint32_t> partsFor(std::span<const std::uint32_t> sources, PartKind kind) {
        std::vector<std::uint32_t> parts;
        parts.reserve(sources.size());
        for (const std::uint32_t source : sources) {
            parts.push_back(source == kNoLabel ? kNoLabel : collected_.partOf()[source]);
            if (parts.back() != kNoLabel) {
                collected_.parts()[parts.back()].kind = kind;
            }
        }
        return parts;
    }

    /// A part with holes, after closing.
    struct Closed {
        std::optional<PreparedMesh> mesh;
        bool balanced = true;
        bool is_body = true;  ///< not a vessel
    };

    /// Closes a part. Returns no mesh if the holes cannot be closed, or if the result encloses nothing. \param is_body
    /// already known to be a body.
    [[nodiscard]] Result<Closed> close(const TriangleMesh& open, bool is_body) const {
        const std::size_t probes = std::clamp(open.triangles.size() / 8, kPartProbesMin, kEnclosureProbes);
        const PreparedMesh closed = RELIEF_TRY(closeHoles(open, probes));
        if (!closed.closed()) {
            return Closed{};
        }
        const std::optional<double> volume =
            enclosedVolume(closed->positions, closed->triangles, closed->bounds.center());
        if (!volume) {
            return Closed{};
        }
        bool balanced = true;
        for (const Part& part : partsOf(*closed, closed.edges())) {
            balanced = balanced && part.balanced;
        }
        closed.freeEdges();
        const std::vector<bool> turn(closed->triangles.size(), *volume < 0.0);
        const PreparedMesh wound = PreparedMesh(closed).woundOutwards(turn);
        return Closed{wound, balanced, is_body || RELIEF_TRY(isCutOffBelow(wound, mesh_.unit.empty()))};
    }

    void add(const Closed& closed) {
        const TriangleMesh& mesh = **closed.mesh;
        union_.add(mesh.positions, mesh.triangles, partsFor(mesh.labels, PartKind::kSolidWithHoles),
                   mesh.sourceTriangles(), closed.balanced ? 0 : ++bodies_);
        union_.countHoles(mesh.closed_holes);
    }

    /// Closes each part with holes separately, then the rest together (panels whose seams do not meet).
    Result<void> closeParts() {
        const std::vector<bool> joined = RELIEF_TRY(addWalls());
        std::vector<Open*> holed;
        for (std::size_t i = 0; i < open_.size(); ++i) {
            Kind& kind = open_[i].role.kind;
            if (joined[i]) {
                kind = Kind::kJoined;
            } else if (kind == Kind::kHoled || kind == Kind::kPerhapsHoled) {
                holed.push_back(&open_[i]);
            }
        }
        std::vector<Result<Closed>> closed(holed.size(), Closed{});
        tbb::parallel_for(std::size_t{0}, holed.size(), [&](std::size_t i) {
            const Result<TriangleMesh> mesh = finishMesh(meshOf(holed[i]->sheet, mesh_.name));
            if (mesh) {  // else too small for a mesh
                closed[i] = close(*mesh, holed[i]->role.kind == Kind::kHoled);
            }
        });
        std::array<std::vector<Open*>, kWordsOf<ShapeAs>.size()> left;  // by kind
        for (std::size_t i = 0; i < holed.size(); ++i) {
            const Closed part = RELIEF_TRY(std::move(closed[i]));
            if (part.mesh && part.is_body) {
                holed[i]->full = true;
                add(part);
                ++report_.solids_with_holes;
            } else if (holed[i]->role.kind == Kind::kPerhapsHoled) {
                holed[i]->role.kind = Kind::kSheet;
                report_.closable_sheets += part.mesh ? 1 : 0;
            } else {
                left[static_cast<std::size_t>(holed[i]->as)].push_back(holed[i]);
            }
        }
        for (const std::vector<Open*>& parts : left) {
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

    static bool mayBeHoled(const Open& part) {
        return (part.role.kind == Kind::kHoled || part.role.kind == Kind::kPerhapsHoled) &&
               part.as == ShapeAs::kAuto;
    }

    /// Adds the walls of joined shells; the space within stays free. \return per part, whether it was joined to another
    /// one.
    Result<std::vector<bool>> addWalls() {
        std::vector<WallCandidate> candidates;
        for (const Open& part : open_) {
            candidates.push_back({&part.sheet, part.as == ShapeAs::kAuto && part.role.kind != Kind::kTerrain,
                                  mayBeHoled(part)});
        }
        ShellWalls walls = wallsAmong(candidates, mesh_.name);
        unjoined_ = std::move(walls.unjoined);
        std::vector<bool> joined(open_.size(), false);
        for (ShellWall& wall : walls.walls) {
            const TriangleMesh finished = RELIEF_TRY(finishMesh(std::move(wall.mesh)));
            const Closed solid = RELIEF_TRY(close(finished, true));
            if (solid.mesh) {
                add(solid);
                ++report_.solids_with_holes;
                joined[wall.outer] = joined[wall.inner] = true;
                report_.unclear_walls += isUnclear(wall, candidates, mesh_, turned_) ? 1 : 0;
            }
        }
        return joined;
    }

    /// \param parts  all of one kind.
    Result<void> closeTogether(const std::vector<Open*>& parts) {
        TriangleMesh rest;
        rest.name = mesh_.name;
        for (const Open* part : parts) {
            const auto first = static_cast<std::uint32_t>(rest.positions.size());
            rest.positions.insert(rest.positions.end(), part->sheet.positions.begin(),
                                  part->sheet.positions.end());
            for (const glm::uvec3& t : part->sheet.triangles) {
                rest.triangles.push_back(t + first);
            }
            rest.labels.insert(rest.labels.end(), part->sheet.sources.begin(), part->sheet.sources.end());
        }
        rest = RELIEF_TRY(finishMesh(std::move(rest)));
        const Closed closed = RELIEF_TRY(close(rest, true));
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
        for (Open* part : parts) {
            part->role.kind = Kind::kSheet;
        }
        return {};
    }

    static double sizeOf(const Sheet& sheet) { return double{boundsOf(sheet.positions).longestSide()}; }

    /// A given thickness must suit the smallest sheet, and the resolution of floats.
    [[nodiscard]] Result<void> checkThickness() const {
        double smallest = std::numeric_limits<double>::max();
        for (const Open& part : open_) {
            if (part.role.kind == Kind::kSheet) {
                smallest = std::min(smallest, sizeOf(part.sheet));
            }
        }
        if (options_.thickness_by_part || smallest == std::numeric_limits<double>::max()) {
            return {};
        }
        return checkShellThickness(options_.thickness, smallest, mesh_);
    }

    Result<void> addSheets() {
        for (const Open& part : open_) {
            if (part.role.kind == Kind::kSheet) {
                const double size = sizeOf(part.sheet);
                const double thickness =
                    options_.thickness_by_part
                        ? partThickness(options_.thickness, size, options_.thickness_by_texel)
                        : options_.thickness;
                const double right = options_.thickness_by_part ? rightThickness(thickness, size) : thickness;
                TriangleMesh finished = RELIEF_TRY(finishMesh(meshOf(part.sheet, mesh_.name)));
                const MeshQuery query = RELIEF_TRY(MeshQuery::build(std::move(finished)));
                add(part.sheet, thickened(part.sheet, query, thickness), PartKind::kSheet);
                for (const std::uint32_t source : part.sheet.sources) {
                    SurfacePart& piece = collected_.parts()[collected_.partOf()[source]];
                    piece.thickness = thickness;
                    piece.right_thickness = right;
                }
                report_.thickness = std::max(report_.thickness, thickness);
                report_.thickness_least =
                    report_.sheets == 0 ? thickness : std::min(report_.thickness_least, thickness);
                ++report_.sheets;
            } else if (part.role.kind == Kind::kTerrain) {
                addTerrain(part.sheet, part.role.axis);
            }
        }
        report_.default_thickness =
            options_.thickness_by_part && report_.sheets > 0 ? options_.thickness : 0.0;
        return {};
    }

    /// Shells on request have free space on both sides.
    static bool seals(const Open& part) {
        return part.role.kind == Kind::kSheet && part.as != ShapeAs::kShell;
    }
    [[nodiscard]] bool hasSealingSheet() const { return std::ranges::any_of(open_, seals); }

    Result<PreparedMesh> fillVoids(PreparedMesh mesh, std::vector<std::uint32_t>& part_of) {
        std::vector<Wall> of_part(collected_.parts().size(), Wall::kSolid);
        for (const Open& part : open_) {
            if (part.role.kind == Kind::kSheet) {
                for (const std::uint32_t source : part.sheet.sources) {
                    of_part[collected_.partOf()[source]] = seals(part) ? Wall::kSheet : Wall::kNothing;
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

    void addTerrain(const Sheet& sheet, int axis) {
        const float low = boundsOf(sheet.positions).min[axis];
        add(sheet, extruded(sheet, axis, low - static_cast<float>(kGround) * mesh_.bounds.longestSide()),
            PartKind::kTerrain);
        ++report_.terrains;
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
    std::vector<Open> open_;                            // from parts_
    std::vector<std::array<std::size_t, 2>> unjoined_;  // ShellWalls::unjoined, as indices of open_
    std::uint32_t bodies_ = 0;                          // bodies that use parity, numbered from 1
    SurfacePartsBuilder collected_;
    SolidUnion union_;
    ShapeReport report_;
};

}  // namespace

SurfaceParts surfacePartsOf(const PreparedMesh& mesh) {
    SurfacePartsBuilder builder(*mesh);
    for (const Part& part : partsOf(*mesh, mesh.edges())) {
        builder.add(part.triangles, PartKind::kSurface);
    }
    return {std::move(builder.parts()), builder.partOf()};
}

Result<ShapedMesh> shapeMesh(const PreparedMesh& mesh, const ShapeOptions& options) {
    return Shaper(mesh, options).run();
}

}  // namespace relief

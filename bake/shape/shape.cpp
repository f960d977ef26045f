#include "bake/shape/shape.h"

#include <tbb/parallel_for.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <glm/common.hpp>
#include <span>
#include <utility>
#include <vector>

#include "bake/mesh/inside.h"
#include "bake/mesh/mesh_edges.h"
#include "bake/mesh/mesh_query.h"
#include "bake/mesh/surface_sampler.h"
#include "bake/mesh/triangle_plane.h"
#include "bake/repair/hole_caps.h"
#include "bake/shape/parts.h"
#include "bake/shape/sheet.h"
#include "bake/shape/solid_union.h"
#include "formats/base/text.h"

namespace relief {
namespace {

/// Points of all open parts that are asked what they see, and of each at least.
constexpr std::size_t kSightPoints = 4096;
constexpr std::size_t kSightPointsMin = 8;
/// Probes of a small part whose holes are to be closed.
constexpr std::size_t kPartProbesMin = 64;
/// A part is a sheet if more than this share of the rays from its darker side lead out.
constexpr double kSheetSight = 0.1;
/// A part is seen from outside at all if more than this share of the rays from its lighter side lead out.
constexpr double kSeen = 0.02;
/// Share of the area of a closed part that lies twice in the same place: a sheet with two sides.
constexpr double kTwice = 0.9;
/// A terrain covers this share of its rectangle, has as many triangles, and is this part of the mesh's extent.
constexpr double kTerrainCover = 0.98;
constexpr std::size_t kTerrainTriangles = 200;
constexpr double kTerrainExtent = 0.8;
/// The ground below a terrain, in units of the longest side.
constexpr double kGround = 0.05;

constexpr std::array<std::string_view, 4> kAsNames = {"auto", "solid", "shell", "terrain"};
const std::string kAsOption = " --as ";
const std::string kThicknessOption = " --thickness ";

/// A sheet as a mesh of its own, not finished.
TriangleMesh meshOf(const Sheet& sheet, const std::string& name) {
    TriangleMesh mesh;
    mesh.name = name;
    mesh.positions = sheet.positions;
    mesh.triangles = sheet.triangles;
    return mesh;
}

/// Share of the rays that lead out of the mesh, from either side of a sheet of it.
std::array<double, 2> sightOf(const Sheet& sheet, std::size_t asked, const MeshQuery& query) {
    const double side = query.mesh().bounds.longestSide();
    const TriangleMesh mesh = meshOf(sheet, "");
    const AreaTable areas(mesh);
    MersenneRandom random(1);
    std::array<double, 2> out{};
    for (std::size_t k = 0; k < asked; ++k) {
        const double at = (static_cast<double>(k) + random.uniform()) / static_cast<double>(asked);
        const auto [on, normal] = drawOnSurface(mesh, areas, at, random);
        for (std::size_t face = 0; face < 2; ++face) {
            const glm::dvec3 towards = face == 0 ? normal : -normal;
            const glm::dvec3 from = on + kSurfaceStep * side * towards;
            for (const glm::dvec3& way : kParityDirections) {
                const glm::dvec3 ray = dot(way, towards) < 0.0 ? -way : way;
                out[face] += query.segmentIsFree(from, from + 4.0 * side * ray) ? 1.0 : 0.0;
            }
        }
    }
    const auto rays = static_cast<double>(asked * kParityDirections.size());
    return {out[0] / rays, out[1] / rays};
}

/// Takes a mesh apart and puts it together again.
class Shaper {
  public:
    Shaper(const PreparedMesh& mesh, const ShapeOptions& options)
        : prepared_(mesh), mesh_(*mesh), options_(options), union_(mesh_) {
        report_.as = options.as;
    }

    Result<ShapedMesh> run() {
        {
            const MeshEdges& edges = prepared_.edges();
            parts_ = partsOf(mesh_, edges);
            welded_ = edges.welded;
        }
        prepared_.freeEdges();
        std::vector<const Part*> solids;
        std::vector<const Part*> others;
        for (const Part& part : parts_) {
            (isSolid(part) ? solids : others).push_back(&part);
        }
        if (others.empty()) {
            report_.solids = solids.size();
            return ShapedMesh{prepared_, report_};
        }
        for (const Part* part : solids) {
            union_.addSource(part->triangles, part->balanced ? 0 : ++bodies_);
        }
        report_.solids = solids.size();
        makeSheets(others);
        if (!sheets_.empty()) {
            RELIEF_TRY(sortSheets());
            RELIEF_TRY(closeParts());
            addSheets();
        }
        return ShapedMesh{RELIEF_TRY(union_.finish(report_.thickness)), report_};
    }

  private:
    enum class Kind : std::uint8_t { kHoled, kSheet, kTerrain };
    struct Role {
        Kind kind = Kind::kSheet;
        int axis = 1;  ///< of a terrain's heights
    };

    [[nodiscard]] bool isSolid(const Part& part) const {
        return part.closed && options_.as != ShapeAs::kShell &&
               (options_.as == ShapeAs::kSolid || !isFlat(part));
    }

    /// Closed, but without a volume, as a sheet with two sides is; or copies of a surface.
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
            return false;  // two triangles in one place have their edges to themselves, and enclose nothing
        }
        std::vector<std::array<std::uint32_t, 3>> corners;
        for (const glm::uvec3& t : triangles) {
            corners.push_back({welded_[t.x], welded_[t.y], welded_[t.z]});
            std::sort(corners.back().begin(), corners.back().end());
        }
        std::sort(corners.begin(), corners.end());
        const auto once = static_cast<double>(std::unique(corners.begin(), corners.end()) - corners.begin());
        const auto all = static_cast<double>(part.triangles.size());
        return 2.0 * (all - once) > kTwice * all;
    }

    /// The parts as sheets for the time being, but for those that are solids once coincident triangles count once.
    void makeSheets(const std::vector<const Part*>& parts) {
        sheets_.resize(parts.size());
        tbb::parallel_for(std::size_t{0}, parts.size(),
                          [&](std::size_t i) { sheets_[i] = sheetOf(mesh_, welded_, parts[i]->triangles); });
        for (const Sheet& sheet : sheets_) {
            report_.coincident_triangles += sheet.duplicates;
        }
        if (options_.as != ShapeAs::kShell) {
            std::erase_if(sheets_, [&](const Sheet& sheet) { return addSolidOf(sheet); });
        }
        roles_.assign(sheets_.size(), {});
    }

    /// Adds a part that is closed once its coincident triangles count once, as copies of a solid are.
    bool addSolidOf(const Sheet& sheet) {
        if (sheet.duplicates == 0 || !sheet.closed) {
            return false;
        }
        const std::optional<double> volume =
            enclosedVolume(sheet.positions, sheet.triangles, mesh_.bounds.center());
        if (!volume) {
            return false;
        }
        std::vector<glm::uvec3> triangles = sheet.triangles;
        for (glm::uvec3& t : triangles) {
            t = *volume < 0.0 ? glm::uvec3(t.x, t.z, t.y) : t;
        }
        union_.add(sheet.positions, triangles, triangles.size(), 0);
        ++report_.solids;
        return true;
    }

    /// Which of the sheets are solids with holes, and which terrains.
    Result<void> sortSheets() {
        if (options_.as == ShapeAs::kShell) {
            return {};
        }
        if (options_.as == ShapeAs::kTerrain) {
            for (std::size_t i = 0; i < sheets_.size(); ++i) {
                roles_[i] = {Kind::kTerrain, terrainAxis(sheets_[i]).value_or(flattestAxis(sheets_[i]))};
            }
            return {};
        }
        const MeshQuery query = RELIEF_TRY(MeshQuery::build(prepared_));
        const std::size_t asked = std::max(kSightPointsMin, kSightPoints / sheets_.size());
        tbb::parallel_for(std::size_t{0}, sheets_.size(), [&](std::size_t i) {
            const std::array<double, 2> sight = sightOf(sheets_[i], asked, query);
            const auto [dark, light] = std::minmax(sight[0], sight[1]);
            if (options_.as == ShapeAs::kSolid || (dark <= kSheetSight && light > kSeen)) {
                roles_[i].kind = Kind::kHoled;
            } else if (const std::optional<int> axis = terrainAxis(sheets_[i])) {
                roles_[i] = {Kind::kTerrain, *axis};
            }
        });
        return {};
    }

    /// The axis of the heights of a sheet that is the ground of its mesh.
    [[nodiscard]] std::optional<int> terrainAxis(const Sheet& sheet) const {
        if (sheet.triangles.size() < kTerrainTriangles) {
            return std::nullopt;
        }
        Bounds bounds;
        for (const glm::vec3& p : sheet.positions) {
            bounds.add(p);
        }
        const glm::dvec3 size = bounds.size();
        const glm::dvec3 whole = mesh_.bounds.size();
        const Shadow shadow = shadowOf(sheet);
        // Where the file says its unit, the importer has turned +y upwards. Elsewhere +z may point there as well.
        for (const int axis : {1, 2}) {
            const int across = (axis + 1) % 3;
            const int along = (axis + 2) % 3;
            const double rectangle = size[across] * size[along];
            const bool ground = size[axis] < 0.7 * std::min(size[across], size[along]) &&
                                size[across] >= kTerrainExtent * whole[across] &&
                                size[along] >= kTerrainExtent * whole[along];
            // All of it looks one way, and so covers nothing twice.
            const bool heights = std::abs(shadow.signed_area[axis]) >= 0.9999 * shadow.area[axis] &&
                                 0.5 * shadow.area[axis] >= kTerrainCover * rectangle;
            if (ground && heights && (axis == 1 || (mesh_.unit.empty() && parts_.size() == 1))) {
                return axis;
            }
        }
        return std::nullopt;
    }

    /// The axis that sees most of a sheet.
    static int flattestAxis(const Sheet& sheet) {
        const glm::dvec3 area = glm::abs(shadowOf(sheet).signed_area);
        return area.y >= std::max(area.x, area.z) ? 1 : area.z >= area.x ? 2 : 0;
    }

    /// A part with holes, closed.
    struct Closed {
        std::optional<PreparedMesh> mesh;
        bool balanced = true;
    };

    /// \return nothing in it if its holes cannot be closed, or it encloses nothing then.
    [[nodiscard]] Result<Closed> close(const TriangleMesh& open) const {
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
        return Closed{PreparedMesh(closed).woundOutwards(turn), balanced};
    }

    void add(const Closed& closed) {
        const TriangleMesh& mesh = **closed.mesh;
        union_.add(mesh.positions, mesh.triangles, mesh.sourceTriangles(), closed.balanced ? 0 : ++bodies_);
        union_.countHoles(mesh.closed_holes);
    }

    /// Each part with holes by itself, and then what is left of them together: panels whose seams do not meet.
    Result<void> closeParts() {
        std::vector<std::uint32_t> holed;
        for (std::uint32_t i = 0; i < sheets_.size(); ++i) {
            if (roles_[i].kind == Kind::kHoled) {
                holed.push_back(i);
            }
        }
        std::vector<Result<Closed>> closed(holed.size(), Closed{});
        tbb::parallel_for(std::size_t{0}, holed.size(), [&](std::size_t i) {
            const Result<TriangleMesh> mesh = finishMesh(meshOf(sheets_[holed[i]], mesh_.name));
            if (mesh) {  // else it is too small for a mesh of its own
                closed[i] = close(*mesh);
            }
        });
        TriangleMesh rest;
        rest.name = mesh_.name;
        std::vector<std::uint32_t> left;
        for (std::size_t i = 0; i < holed.size(); ++i) {
            const Closed part = RELIEF_TRY(std::move(closed[i]));
            if (part.mesh) {
                add(part);
                ++report_.solids_with_holes;
                continue;
            }
            left.push_back(holed[i]);
            const Sheet& sheet = sheets_[holed[i]];
            const auto first = static_cast<std::uint32_t>(rest.positions.size());
            rest.positions.insert(rest.positions.end(), sheet.positions.begin(), sheet.positions.end());
            for (const glm::uvec3& t : sheet.triangles) {
                rest.triangles.push_back(t + first);
            }
        }
        return left.empty() ? Result<void>() : closeTogether(std::move(rest), left);
    }

    Result<void> closeTogether(TriangleMesh rest, const std::vector<std::uint32_t>& parts) {
        rest = RELIEF_TRY(finishMesh(std::move(rest)));
        const Closed closed = RELIEF_TRY(close(rest));
        if (closed.mesh) {
            add(closed);
            ++report_.solids_with_holes;
            return {};
        }
        const MeshQuery query = RELIEF_TRY(MeshQuery::build(rest));
        const Enclosure enclosure = measureEnclosure(query);
        if (options_.as == ShapeAs::kSolid ||
            (enclosure.one_sided >= kOneSided && enclosure.agreement >= kAgreement)) {
            union_.add(rest.positions, rest.triangles, rest.triangles.size(), 1);
            ++report_.solids_with_holes;
            return {};
        }
        for (const std::uint32_t i : parts) {
            roles_[i].kind = Kind::kSheet;
        }
        return {};
    }

    void addSheets() {
        for (std::size_t i = 0; i < sheets_.size(); ++i) {
            if (roles_[i].kind == Kind::kSheet) {
                union_.add(thickened(sheets_[i], options_.thickness));
                report_.thickness = options_.thickness;
                ++report_.sheets;
            } else if (roles_[i].kind == Kind::kTerrain) {
                addTerrain(sheets_[i], roles_[i].axis);
            }
        }
    }

    void addTerrain(const Sheet& sheet, int axis) {
        float low = sheet.positions.front()[axis];
        for (const glm::vec3& p : sheet.positions) {
            low = std::min(low, p[axis]);
        }
        union_.add(extruded(sheet, axis, low - static_cast<float>(kGround) * mesh_.bounds.longestSide()));
        ++report_.terrains;
    }

    const PreparedMesh& prepared_;
    const TriangleMesh& mesh_;
    const ShapeOptions& options_;
    std::vector<std::uint32_t> welded_;
    std::vector<Part> parts_;
    std::vector<Sheet> sheets_;  // of the parts that are not solid as they are
    std::vector<Role> roles_;    // of each of them
    std::uint32_t bodies_ = 1;   // 1: the parts that enclose something together, by parity
    SolidUnion union_;
    ShapeReport report_;
};

void append(std::string& text, std::uint64_t count, const char* one, const char* many) {
    if (count > 0) {
        text += (text.empty() ? "" : ", ") + std::to_string(count) + " " + (count == 1 ? one : many);
    }
}

}  // namespace

std::string_view shapeAsName(ShapeAs as) {
    return kAsNames[static_cast<std::size_t>(as)];
}

std::optional<ShapeAs> parseShapeAs(std::string_view name) {
    const auto found = std::find(kAsNames.begin(), kAsNames.end(), name);
    return found == kAsNames.end() ? std::nullopt
                                   : std::optional(static_cast<ShapeAs>(found - kAsNames.begin()));
}

std::string shapeOptionsText(const ShapeReport& report) {
    return (report.as == ShapeAs::kAuto ? "" : kAsOption + std::string(shapeAsName(report.as))) +
           (report.thickness > 0.0 ? kThicknessOption + shortest(static_cast<float>(report.thickness)) : "");
}

ShapeOptions shapeOptionsOf(const std::string& container_options, const ShapeOptions& otherwise) {
    const auto valueOf = [&](const std::string& option) {
        const std::size_t at = container_options.find(option);
        const std::string rest = at == std::string::npos ? "" : container_options.substr(at + option.size());
        return rest.substr(0, rest.find(' '));
    };
    ShapeOptions options = otherwise;
    options.as = parseShapeAs(valueOf(kAsOption)).value_or(options.as);
    const std::optional<float> thickness = parseFloat(valueOf(kThicknessOption));
    if (thickness && *thickness > 0.0F) {
        options.thickness = double{*thickness};
    }
    return options;
}

std::string ShapeReport::text() const {
    std::string text;
    append(text, solids, "solid", "solids");
    append(text, solids_with_holes, "solid with holes", "solids with holes");
    append(text, sheets, "sheet", "sheets");
    append(text, terrains, "terrain", "terrains");
    return text;
}

double defaultThickness(const Bounds& bounds, std::uint64_t budget_bytes) {
    const glm::dvec3 size = bounds.size();
    // Front-back maps along the axes, of eight bytes a texel, and half as many again that look from elsewhere.
    const double area = 12.0 * (size.x * size.y + size.y * size.z + size.z * size.x);
    const double texel = std::sqrt(area / static_cast<double>(std::max<std::uint64_t>(budget_bytes, 1)));
    const double side = bounds.longestSide();
    return std::clamp(1.5 * texel, 0.004 * side, 0.04 * side);
}

Result<ShapedMesh> shapeMesh(const PreparedMesh& mesh, const ShapeOptions& options) {
    return Shaper(mesh, options).run();
}

}  // namespace relief

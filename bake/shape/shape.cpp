#include "bake/shape/shape.h"

#include <tbb/parallel_for.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <glm/common.hpp>
#include <numeric>
#include <span>
#include <utility>
#include <vector>

#include "bake/mesh/inside.h"
#include "bake/mesh/mesh_edges.h"
#include "bake/mesh/mesh_query.h"
#include "bake/mesh/surface_sampler.h"
#include "bake/mesh/triangle_plane.h"
#include "bake/repair/hole_caps.h"
#include "bake/shape/sheet.h"
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
/// A closed part with less volume, in units of its area to the power of 3/2, encloses nothing. Of a sphere it is 0.094.
constexpr double kVolumeMin = 1e-5;
/// Share of the area of a closed part that lies twice in the same place: a sheet with two sides.
constexpr double kTwice = 0.9;
/// A terrain covers this share of its rectangle, has as many triangles, and is this part of the mesh's extent.
constexpr double kTerrainCover = 0.98;
constexpr std::size_t kTerrainTriangles = 200;
constexpr double kTerrainExtent = 0.8;
/// The ground below a terrain, in units of the longest side.
constexpr double kGround = 0.05;

constexpr std::array<const char*, 4> kAsNames = {"auto", "solid", "shell", "terrain"};
const std::string kAsOption = " --as ";
const std::string kThicknessOption = " --thickness ";

/// Triangles that hang together by edges.
struct Part {
    std::vector<std::uint32_t> triangles;
    bool closed = true;
    bool balanced = true;  ///< every edge runs as often one way as the other
};

std::vector<Part> partsOf(const TriangleMesh& mesh, const MeshEdges& edges) {
    DisjointSets sets(mesh.triangles.size());
    forEachEdge(edges.uses, [&](std::size_t begin, std::size_t end) {
        for (std::size_t i = begin + 1; i < end; ++i) {
            sets.join(edges.uses[begin].triangle, edges.uses[i].triangle);
        }
    });
    std::vector<std::uint32_t> part_of(mesh.triangles.size());
    std::vector<Part> parts;
    for (std::uint32_t i = 0; i < mesh.triangles.size(); ++i) {
        const std::uint32_t root = sets.find(i);
        if (root == i) {
            part_of[i] = static_cast<std::uint32_t>(parts.size());
            parts.emplace_back();
        }
        part_of[i] = part_of[root];
        parts[part_of[i]].triangles.push_back(i);
    }
    forEachEdge(edges.uses, [&](std::size_t begin, std::size_t end) {
        Part& part = parts[part_of[edges.uses[begin].triangle]];
        std::size_t down = 0;
        for (std::size_t i = begin; i < end; ++i) {
            down += edges.uses[i].down ? 1U : 0U;
        }
        part.closed = part.closed && (end - begin) % 2 == 0;
        part.balanced = part.balanced && 2 * down == end - begin;
    });
    return parts;
}

double areaOf(const TriangleMesh& mesh, const std::vector<std::uint32_t>& triangles) {
    double area = 0.0;
    for (const std::uint32_t i : triangles) {
        const glm::dvec3 n = planeOf(mesh, i).normal;
        area += 0.5 * std::sqrt(dot(n, n));
    }
    return area;
}

double volumeOf(const TriangleMesh& mesh, std::span<const std::uint32_t> triangles) {
    const glm::dvec3 center = mesh.bounds.center();
    double volume = 0.0;
    for (const std::uint32_t i : triangles) {
        const TrianglePlane plane = planeOf(mesh, i);
        volume += dot(plane.point - center, plane.normal) / 6.0;
    }
    return volume;
}

/// The closed surfaces that take the mesh's place.
class Union {
  public:
    explicit Union(const TriangleMesh& source) : source_(source) {}

    /// \param body  0: the winding counts; else triangles of one number enclose by parity.
    void add(std::span<const glm::vec3> positions, std::span<const glm::uvec3> triangles, std::size_t surface,
             std::uint32_t body) {
        const auto first = static_cast<std::uint32_t>(positions_.size());
        positions_.insert(positions_.end(), positions.begin(), positions.end());
        for (std::size_t i = 0; i < triangles.size(); ++i) {
            Half& half = i < surface ? surface_ : caps_;
            half.triangles.push_back(triangles[i] + first);
            half.bodies.push_back(body);
        }
    }
    void add(const SolidPart& part) { add(part.positions, part.triangles, part.surface_triangles, 0); }
    /// Triangles of the source, as they are.
    void addSource(const std::vector<std::uint32_t>& triangles, std::uint32_t body) {
        if (!has_source_) {
            has_source_ = true;
            source_first_ = static_cast<std::uint32_t>(positions_.size());
            positions_.insert(positions_.end(), source_.positions.begin(), source_.positions.end());
        }
        for (const std::uint32_t i : triangles) {
            surface_.triangles.push_back(source_.triangles[i] + source_first_);
            surface_.bodies.push_back(body);
        }
    }
    void countHoles(std::uint64_t holes) { holes_ += holes; }

    Result<PreparedMesh> finish(double thickness) {
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
        mesh.shell_thickness = thickness;
        std::vector<std::uint32_t> bodies = std::move(surface_.bodies);
        bodies.insert(bodies.end(), caps_.bodies.begin(), caps_.bodies.end());
        mesh = RELIEF_TRY(finishMesh(std::move(mesh)));
        if (mesh.triangles.size() != bodies.size()) {
            return fail(ErrorCode::kFailure,
                        mesh.name + ": a shell has triangles without area; give another --thickness");
        }
        return PreparedMesh::unionOf(std::move(mesh), std::move(bodies));
    }

  private:
    struct Half {
        std::vector<glm::uvec3> triangles;
        std::vector<std::uint32_t> bodies;
    };

    const TriangleMesh& source_;
    std::vector<glm::vec3> positions_;
    Half surface_;
    Half caps_;
    std::uint64_t holes_ = 0;
    bool has_source_ = false;
    std::uint32_t source_first_ = 0;
};

/// A sheet as a mesh of its own.
Result<TriangleMesh> meshOf(const Sheet& sheet, const std::string& name) {
    TriangleMesh mesh;
    mesh.name = name;
    mesh.positions = sheet.positions;
    mesh.triangles = sheet.triangles;
    return finishMesh(std::move(mesh));
}

/// Six of the axes' directions add up to this over a sheet's triangles: twice the area as each axis sees it, where the
/// two sides cancel out, and where they do not.
struct Facing {
    glm::dvec3 signed_area{0.0};
    glm::dvec3 absolute{0.0};
};

Facing facingOf(const Sheet& sheet) {
    Facing facing;
    for (const glm::uvec3& t : sheet.triangles) {
        const glm::dvec3 a = sheet.positions[t.x];
        const glm::dvec3 n =
            cross(glm::dvec3(sheet.positions[t.y]) - a, glm::dvec3(sheet.positions[t.z]) - a);
        facing.signed_area += n;
        facing.absolute += glm::abs(n);
    }
    return facing;
}

/// Share of the rays that lead out of the mesh, from either side of a sheet of it.
std::array<double, 2> sightOf(const Sheet& sheet, std::size_t asked, const MeshQuery& query) {
    const double side = query.mesh().bounds.longestSide();
    TriangleMesh mesh;
    mesh.positions = sheet.positions;
    mesh.triangles = sheet.triangles;
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
        addSolids();
        if (sheets_.empty() && report_.coincident_triangles == 0) {
            return ShapedMesh{prepared_, report_};
        }
        if (!sheets_.empty()) {
            RELIEF_TRY(sortOpenParts());
            RELIEF_TRY(closeParts());
            addSheets();
        }
        return ShapedMesh{RELIEF_TRY(union_.finish(report_.thickness)), report_};
    }

  private:
    enum class Kind : std::uint8_t { kHoled, kSheet, kTerrain };

    /// Adds the closed parts; the others become sheets for the time being.
    void addSolids() {
        std::vector<const Part*> open;
        for (const Part& part : parts_) {
            const bool solid = part.closed && options_.as != ShapeAs::kShell &&
                               (options_.as == ShapeAs::kSolid || !isFlat(part));
            if (solid) {
                union_.addSource(part.triangles, part.balanced ? 0 : ++bodies_);
                ++report_.solids;
            } else {
                open.push_back(&part);
            }
        }
        sheets_.resize(open.size());
        tbb::parallel_for(std::size_t{0}, open.size(),
                          [&](std::size_t i) { sheets_[i] = sheetOf(mesh_, welded_, open[i]->triangles); });
        for (const Sheet& sheet : sheets_) {
            report_.coincident_triangles += sheet.duplicates;
        }
        if (options_.as != ShapeAs::kShell) {
            std::erase_if(sheets_, [&](const Sheet& sheet) { return addSolidOf(sheet); });
        }
        kinds_.assign(sheets_.size(), Kind::kSheet);
    }

    /// Adds a part that is closed once its coincident triangles count once, as copies of a solid are.
    bool addSolidOf(const Sheet& sheet) {
        if (sheet.duplicates == 0 || !sheet.closed) {
            return false;
        }
        double area = 0.0;
        double volume = 0.0;
        const glm::dvec3 center = mesh_.bounds.center();
        for (const glm::uvec3& t : sheet.triangles) {
            const glm::dvec3 a = glm::dvec3(sheet.positions[t.x]) - center;
            const glm::dvec3 n = cross(glm::dvec3(sheet.positions[t.y]) - center - a,
                                       glm::dvec3(sheet.positions[t.z]) - center - a);
            area += 0.5 * std::sqrt(dot(n, n));
            volume += dot(a, n) / 6.0;
        }
        if (std::abs(volume) < kVolumeMin * area * std::sqrt(area)) {
            return false;
        }
        std::vector<glm::uvec3> triangles = sheet.triangles;
        for (glm::uvec3& t : triangles) {
            t = volume < 0.0 ? glm::uvec3(t.x, t.z, t.y) : t;
        }
        union_.add(sheet.positions, triangles, triangles.size(), 0);
        ++report_.solids;
        return true;
    }

    /// Closed, but without a volume, as a sheet with two sides is.
    [[nodiscard]] bool isFlat(const Part& part) const {
        const double area = areaOf(mesh_, part.triangles);
        if (std::abs(volumeOf(mesh_, part.triangles)) < kVolumeMin * area * std::sqrt(area)) {
            return true;
        }
        std::vector<std::array<std::uint32_t, 3>> corners;
        for (const std::uint32_t i : part.triangles) {
            const glm::uvec3& t = mesh_.triangles[i];
            corners.push_back({welded_[t.x], welded_[t.y], welded_[t.z]});
            std::sort(corners.back().begin(), corners.back().end());
        }
        std::sort(corners.begin(), corners.end());
        const auto once = static_cast<double>(std::unique(corners.begin(), corners.end()) - corners.begin());
        const auto all = static_cast<double>(part.triangles.size());
        return 2.0 * (all - once) > kTwice * all;
    }

    Result<void> sortOpenParts() {
        if (options_.as == ShapeAs::kShell || options_.as == ShapeAs::kTerrain) {
            std::fill(kinds_.begin(), kinds_.end(),
                      options_.as == ShapeAs::kShell ? Kind::kSheet : Kind::kTerrain);
            return {};
        }
        const MeshQuery query = RELIEF_TRY(MeshQuery::build(prepared_));
        const std::size_t asked = std::max(kSightPointsMin, kSightPoints / sheets_.size());
        tbb::parallel_for(std::size_t{0}, sheets_.size(), [&](std::size_t i) {
            const std::array<double, 2> sight = sightOf(sheets_[i], asked, query);
            const auto [dark, light] = std::minmax(sight[0], sight[1]);
            if (options_.as == ShapeAs::kSolid || (dark <= kSheetSight && light > kSeen)) {
                kinds_[i] = Kind::kHoled;
            } else if (terrainAxis(sheets_[i])) {
                kinds_[i] = Kind::kTerrain;
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
        const Facing facing = facingOf(sheet);
        // Where the file says its unit, the importer has turned +y upwards. Elsewhere +z may point there as well.
        for (const int axis : {1, 2}) {
            const int across = (axis + 1) % 3;
            const int along = (axis + 2) % 3;
            const double rectangle = size[across] * size[along];
            const bool ground = size[axis] < 0.7 * std::min(size[across], size[along]) &&
                                size[across] >= kTerrainExtent * whole[across] &&
                                size[along] >= kTerrainExtent * whole[along];
            // All of it looks one way, and so covers nothing twice.
            const bool heights = std::abs(facing.signed_area[axis]) >= 0.9999 * facing.absolute[axis] &&
                                 0.5 * facing.absolute[axis] >= kTerrainCover * rectangle;
            if (ground && heights && (axis == 1 || (mesh_.unit.empty() && parts_.size() == 1))) {
                return axis;
            }
        }
        return std::nullopt;
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
        std::vector<std::uint32_t> all(closed->triangles.size());
        std::iota(all.begin(), all.end(), 0U);
        const double area = areaOf(*closed, all);
        const double volume = volumeOf(*closed, all);
        if (std::abs(volume) < kVolumeMin * area * std::sqrt(area)) {
            return Closed{};
        }
        bool balanced = true;
        for (const Part& part : partsOf(*closed, closed.edges())) {
            balanced = balanced && part.balanced;
        }
        closed.freeEdges();
        std::vector<bool> turn(all.size(), volume < 0.0);
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
            if (kinds_[i] == Kind::kHoled) {
                holed.push_back(i);
            }
        }
        std::vector<Result<Closed>> closed(holed.size(), Closed{});
        tbb::parallel_for(std::size_t{0}, holed.size(), [&](std::size_t i) {
            const Result<TriangleMesh> mesh = meshOf(sheets_[holed[i]], mesh_.name);
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
            kinds_[i] = Kind::kSheet;
        }
        return {};
    }

    void addSheets() {
        for (std::size_t i = 0; i < sheets_.size(); ++i) {
            if (kinds_[i] == Kind::kSheet) {
                union_.add(thickened(sheets_[i], options_.thickness));
                report_.thickness = options_.thickness;
                ++report_.sheets;
            } else if (kinds_[i] == Kind::kTerrain) {
                addTerrain(sheets_[i]);
            }
        }
    }

    void addTerrain(const Sheet& sheet) {
        int axis = terrainAxis(sheet).value_or(-1);
        if (axis < 0) {  // --as terrain
            const glm::dvec3 area = glm::abs(facingOf(sheet).signed_area);
            axis = area.y >= std::max(area.x, area.z) ? 1 : area.z >= area.x ? 2 : 0;
        }
        float low = sheet.positions.front()[axis];
        for (const glm::vec3& p : sheet.positions) {
            low = std::min(low, p[axis]);
        }
        union_.add(
            extruded(sheet, axis, true, low - static_cast<float>(kGround) * mesh_.bounds.longestSide()));
        ++report_.terrains;
    }

    const PreparedMesh& prepared_;
    const TriangleMesh& mesh_;
    const ShapeOptions& options_;
    std::vector<std::uint32_t> welded_;
    std::vector<Part> parts_;
    std::vector<Sheet> sheets_;  // of the parts that are not solid as they are
    std::vector<Kind> kinds_;    // of each of them
    std::uint32_t bodies_ = 1;   // 1: the parts that enclose something together, by parity
    Union union_;
    ShapeReport report_;
};

void append(std::string& text, std::uint64_t count, const char* one, const char* many) {
    if (count > 0) {
        text += (text.empty() ? "" : ", ") + std::to_string(count) + " " + (count == 1 ? one : many);
    }
}

}  // namespace

const char* shapeAsName(ShapeAs as) {
    return kAsNames[static_cast<std::size_t>(as)];
}

std::string shapeOptionsText(const ShapeReport& report) {
    return (report.as == ShapeAs::kAuto ? "" : std::string(kAsOption) + shapeAsName(report.as)) +
           (report.thickness > 0.0 ? kThicknessOption + shortest(static_cast<float>(report.thickness)) : "");
}

ShapeOptions shapeOptionsOf(const std::string& container_options, const ShapeOptions& otherwise) {
    const auto valueOf = [&](const std::string& option) {
        const std::size_t at = container_options.find(option);
        const std::string rest = at == std::string::npos ? "" : container_options.substr(at + option.size());
        return rest.substr(0, rest.find(' '));
    };
    ShapeOptions options = otherwise;
    const auto name = std::find(kAsNames.begin(), kAsNames.end(), valueOf(kAsOption));
    if (name != kAsNames.end()) {
        options.as = static_cast<ShapeAs>(name - kAsNames.begin());
    }
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

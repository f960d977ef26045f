#include "bake/materials/material_tree.h"

#include <tbb/parallel_for.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <glm/common.hpp>
#include <limits>
#include <map>
#include <optional>
#include <utility>

#include "bake/mesh/mesh_query.h"
#include "formats/base/text.h"

namespace relief {
namespace {

/// Of the smallest texel: how far off the surface a contact may lie.
constexpr double kMargin = 0.5;
/// The least component of unit normals along the axis that tells two sides apart.
constexpr double kSideMin = 0.5;
constexpr double kDiagonal = 0.70710678118654752;
/// Bytes of a material in the container, beside its name.
constexpr std::size_t kMaterialBytes = 40;

/// A triangle in double precision.
struct Face {
    std::array<glm::dvec3, 3> corners;
    glm::dvec3 normal;  ///< of length 1

    [[nodiscard]] double squareTo(const glm::dvec3& p) const {
        const glm::dvec3 off = closestOnTriangle(p, corners[0], corners[1], corners[2]) - p;
        return dot(off, off);
    }
};

/// Whether a triangle meets a cube, by separating axes: Akenine-Möller, "Fast 3D triangle-box overlap testing" (2001).
bool meets(const Face& face, const glm::dvec3& center, double half) {
    const std::array<glm::dvec3, 3> v{face.corners[0] - center, face.corners[1] - center,
                                      face.corners[2] - center};
    const auto apart = [&](const glm::dvec3& axis) {
        const double a = dot(axis, v[0]);
        const double b = dot(axis, v[1]);
        const double c = dot(axis, v[2]);
        const double reach = half * (std::abs(axis.x) + std::abs(axis.y) + std::abs(axis.z));
        return std::max({a, b, c}) < -reach || std::min({a, b, c}) > reach;
    };
    for (int i = 0; i < 3; ++i) {
        glm::dvec3 axis(0.0);
        axis[i] = 1.0;
        if (apart(axis)) {
            return false;
        }
    }
    if (apart(face.normal)) {
        return false;
    }
    for (std::size_t edge = 0; edge < 3; ++edge) {
        const glm::dvec3 along = v[(edge + 1) % 3] - v[edge];
        for (int i = 0; i < 3; ++i) {
            glm::dvec3 axis(0.0);
            axis[i] = 1.0;
            if (apart(cross(axis, along))) {
                return false;
            }
        }
    }
    return true;
}

/// A cell that is split, and the triangles near it.
struct Cell {
    std::size_t node = 0;
    glm::dvec3 center{0.0};
    std::vector<std::uint32_t> faces;
};

/// The finding of an octant.
struct Octant {
    std::vector<std::uint32_t> faces;
    std::optional<std::uint8_t> single;  ///< material of all of them
    std::optional<MaterialSides> sides;  ///< else, where their normals tell them apart
    std::uint8_t nearest = 0;            ///< material of the one nearest to its middle
};

class TreeBuilder {
  public:
    TreeBuilder(const MaterialSource& source, const MaterialTreeOptions& options)
        : source_(source), options_(options) {
        result_.list = source.list;
    }

    Materials build() {
        margin_ = kMargin * options_.texel;
        const double size = double{options_.box.longestSide()} + 4.0 * options_.texel;
        result_.size = static_cast<float>(size);
        const glm::dvec3 middle(options_.box.center());
        result_.origin = glm::vec3(middle - 0.5 * size);
        while (levels_ < kMaterialLevelsMax && std::ldexp(size, -levels_) > options_.texel) {
            ++levels_;
        }
        Cell root{0, glm::dvec3(result_.origin) + 0.5 * double{result_.size}, {}};
        prepareFaces(root);
        if (const std::optional<std::uint8_t> only = singleOf(root.faces); only || root.faces.empty()) {
            keepOnly(only.value_or(0));
            return std::move(result_);
        }
        most_ = std::min(kMaterialNodesMax, mostNodes());
        result_.nodes.resize(1);
        std::vector<Cell> level;
        level.push_back(std::move(root));
        for (int depth = 1; !level.empty(); ++depth) {
            level = split(level, depth);
        }
        return std::move(result_);
    }

  private:
    void prepareFaces(Cell& root) {
        const double half = 0.5 * double{result_.size} + margin_;
        for (std::size_t i = 0; i < source_.triangles.size(); ++i) {
            const glm::uvec3& t = source_.triangles[i];
            const TrianglePlane plane = planeOf(source_.positions, t);
            faces_.push_back({{glm::dvec3(source_.positions[t.x]), glm::dvec3(source_.positions[t.y]),
                               glm::dvec3(source_.positions[t.z])},
                              unit(plane.normal)});
            if (meets(faces_.back(), root.center, half)) {
                root.faces.push_back(static_cast<std::uint32_t>(i));
            }
        }
    }

    /// A part of a mesh that has a single material.
    void keepOnly(std::uint8_t id) {
        result_.list = {source_.list[id]};
        result_.origin = glm::vec3(0.0F);
        result_.size = 0.0F;
    }

    [[nodiscard]] std::size_t mostNodes() const {
        std::size_t taken = 0;
        for (const Material& one : source_.list) {
            taken += one.name.size() + kMaterialBytes;
        }
        return std::max<std::size_t>((options_.most - std::min(taken, options_.most)) / sizeof(MaterialNode),
                                     1);
    }

    [[nodiscard]] std::optional<std::uint8_t> singleOf(const std::vector<std::uint32_t>& faces) const {
        if (faces.empty()) {
            return std::nullopt;
        }
        const std::uint8_t first = source_.ids[faces.front()];
        return std::all_of(faces.begin(), faces.end(),
                           [&](std::uint32_t face) { return source_.ids[face] == first; })
                   ? std::optional(first)
                   : std::nullopt;
    }

    [[nodiscard]] std::optional<MaterialSides> sidesOf(const std::vector<std::uint32_t>& faces) const {
        for (int axis = 0; axis < kMaterialAxes && source_.sides; ++axis) {
            std::array<int, 2> ids{-1, -1};  // of those that face along the axis, and against it
            const bool apart = std::all_of(faces.begin(), faces.end(), [&](std::uint32_t face) {
                const double along =
                    (axis < 3 ? 1.0 : kDiagonal) * alongMaterialAxis(faces_[face].normal, axis);
                int& id = ids[along < 0.0 ? 1 : 0];
                id = id < 0 ? source_.ids[face] : id;
                return std::abs(along) >= kSideMin && id == source_.ids[face];
            });
            if (apart && ids[0] >= 0 && ids[1] >= 0) {
                return MaterialSides{static_cast<std::uint8_t>(axis), static_cast<std::uint8_t>(ids[0]),
                                     static_cast<std::uint8_t>(ids[1])};
            }
        }
        return std::nullopt;
    }

    [[nodiscard]] std::uint8_t nearest(const std::vector<std::uint32_t>& faces, const glm::dvec3& p) const {
        double least = std::numeric_limits<double>::infinity();
        std::uint8_t id = 0;
        for (const std::uint32_t face : faces) {
            if (const double square = faces_[face].squareTo(p); square < least) {
                least = square;
                id = source_.ids[face];
            }
        }
        return id;
    }

    [[nodiscard]] static glm::dvec3 middleOf(const Cell& cell, std::size_t octant, double quarter) {
        return cell.center + quarter * glm::dvec3((octant & 1) != 0 ? 1.0 : -1.0,
                                                  (octant & 2) != 0 ? 1.0 : -1.0,
                                                  (octant & 4) != 0 ? 1.0 : -1.0);
    }

    [[nodiscard]] Octant examined(const Cell& cell, const glm::dvec3& middle, double half) const {
        Octant octant;
        for (const std::uint32_t face : cell.faces) {
            if (meets(faces_[face], middle, half + margin_)) {
                octant.faces.push_back(face);
            }
        }
        octant.single = singleOf(octant.faces);
        if (!octant.single) {
            octant.sides = octant.faces.empty() ? std::nullopt : sidesOf(octant.faces);
            octant.nearest = nearest(octant.faces.empty() ? cell.faces : octant.faces, middle);
        }
        return octant;
    }

    /// The leaf that stands for a pair of sides; nullopt: there are too many pairs.
    [[nodiscard]] std::optional<std::uint8_t> leafOf(const MaterialSides& sides) {
        const auto found = std::find(result_.sides.begin(), result_.sides.end(), sides);
        const auto index = static_cast<std::size_t>(found - result_.sides.begin());
        if (found == result_.sides.end()) {
            if (result_.list.size() + result_.sides.size() > kMaterialSidesMax) {
                return std::nullopt;
            }
            result_.sides.push_back(sides);
        }
        return static_cast<std::uint8_t>(result_.list.size() + index);
    }

    /// \param depth  of their octants. \return the octants that are to be split.
    std::vector<Cell> split(const std::vector<Cell>& cells, int depth) {
        const double half = std::ldexp(double{result_.size}, -depth - 1);
        std::vector<Octant> octants(8 * cells.size());
        tbb::parallel_for(std::size_t{0}, octants.size(), [&](std::size_t i) {
            octants[i] = examined(cells[i / 8], middleOf(cells[i / 8], i % 8, half), half);
        });
        std::vector<Cell> next;
        for (std::size_t i = 0; i < octants.size(); ++i) {
            Octant& octant = octants[i];
            const Cell& cell = cells[i / 8];
            std::optional<std::uint8_t> leaf = octant.single;
            if (!leaf && octant.sides) {
                leaf = leafOf(*octant.sides);
            }
            if (!leaf && (octant.faces.empty() || depth >= levels_ || result_.nodes.size() >= most_)) {
                leaf = octant.nearest;
            }
            if (leaf) {
                result_.nodes[cell.node].leaves[i % 8] = *leaf;
                continue;
            }
            MaterialNode& node = result_.nodes[cell.node];
            const std::size_t made = result_.nodes.size();
            node.head |=
                1U << (i % 8) | ((node.head & 0xFFU) == 0 ? static_cast<std::uint32_t>(made) << 8U : 0U);
            next.push_back({made, middleOf(cell, i % 8, half), std::move(octant.faces)});
            result_.nodes.emplace_back();
        }
        return next;
    }

    const MaterialSource& source_;
    const MaterialTreeOptions& options_;
    Materials result_;
    std::vector<Face> faces_;
    double margin_ = 0.0;
    int levels_ = 1;
    std::size_t most_ = 1;
};

double areaOf(const TriangleMesh& mesh, std::uint32_t triangle) {
    return 0.5 * length(planeOf(mesh, triangle).normal);
}

/// The number of a material by its name, which is new or has the response that it had.
Result<std::size_t> idOf(const SurfaceName& name, const TriangleMesh& mesh,
                         std::map<std::string, std::size_t>& known, std::vector<Material>& list) {
    const auto [found, added] = known.try_emplace(name.material, list.size());
    if (added) {
        list.push_back({name.material, name.restitution, name.friction});
    }
    const Material& one = list[found->second];
    if (one.restitution != name.restitution || one.friction != name.friction) {
        return invalidInput(mesh.name + ": its material '" + name.material + "' has restitution " +
                            shortest(one.restitution) + " and friction " + shortest(one.friction) +
                            " in one place, and " + shortest(name.restitution) + " and " +
                            shortest(name.friction) + " at '" + name.node +
                            "'; give the two names of their own, or bake with --materials none");
    }
    return found->second;
}

}  // namespace

Result<MaterialSource> materialSource(const TriangleMesh& mesh, bool single) {
    const bool one_surface = mesh.labels.empty();
    if (one_surface && (!single || mesh.surface_names.empty())) {
        return MaterialSource();
    }
    std::vector<double> area(mesh.surface_names.size(), 0.0);
    double whole = 0.0;
    for (std::uint32_t i = 0; i < mesh.triangles.size(); ++i) {
        const std::uint32_t label = one_surface ? 0 : mesh.labels[i];
        if (label < area.size()) {
            const double its = areaOf(mesh, i);
            area[label] += its;
            whole += its;
        }
    }
    MaterialSource source;
    std::map<std::string, std::size_t> known;
    std::vector<std::size_t> id_of_label(area.size(), 0);
    std::vector<double> shares;
    for (std::size_t label = 0; label < area.size(); ++label) {
        if (area[label] > 0.0) {
            id_of_label[label] = RELIEF_TRY(idOf(mesh.surface_names[label], mesh, known, source.list));
            shares.resize(source.list.size(), 0.0);
            shares[id_of_label[label]] += area[label] / whole;
        }
    }
    if (source.list.size() < 2 && !(single && source.list.size() == 1 && !source.list[0].name.empty())) {
        return MaterialSource();
    }
    if (source.list.size() > kMaterialsMax) {
        return fail(ErrorCode::kLimit, mesh.name + ": it has " + std::to_string(source.list.size()) +
                                           " materials, and a collider keeps at most " +
                                           std::to_string(kMaterialsMax) +
                                           "; join some, or bake with --materials none");
    }
    for (std::size_t i = 0; i < shares.size(); ++i) {
        source.list[i].area_share = static_cast<float>(std::min(shares[i], 1.0));
    }
    source.positions = mesh.positions;
    for (std::uint32_t i = 0; i < mesh.triangles.size(); ++i) {
        const std::uint32_t label = one_surface ? 0 : mesh.labels[i];
        if (label < area.size()) {
            source.triangles.push_back(mesh.triangles[i]);
            source.ids.push_back(static_cast<std::uint8_t>(id_of_label[label]));
        }
    }
    return source;
}

Materials makeMaterials(const MaterialSource& source, const MaterialTreeOptions& options) {
    return TreeBuilder(source, options).build();
}

Materials materialsFor(const Collider& collider, const MaterialSource* source) {
    if (source == nullptr) {
        return {};
    }
    MaterialTreeOptions options;
    options.box = collider.bounds;
    options.texel = double{finestTexel(collider)};
    options.most =
        std::max(static_cast<std::size_t>(kMaterialsShare * static_cast<double>(collider.gpuBytes())),
                 kMaterialsBytesMin);
    return makeMaterials(*source, options);
}

}  // namespace relief

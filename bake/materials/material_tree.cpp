// SPDX-License-Identifier: Apache-2.0
#include "bake/materials/material_tree.h"

#include <tbb/parallel_for.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <glm/common.hpp>
#include <limits>
#include <optional>
#include <queue>
#include <tuple>
#include <utility>

#include "bake/materials/material_samples.h"
#include "bake/mesh/mesh_query.h"
#include "formats/base/text.h"

namespace relief {
namespace {

/// Maximum distance between a contact and the surface, in units of the smallest texel.
constexpr double kMargin = 0.5;
/// Minimum component of unit normals along the axis that separates two sides.
constexpr double kSideMin = 0.5;
constexpr double kDiagonal = 0.70710678118654752;
/// Nodes to try per node to keep: a split may improve nothing by itself, but its descendants may.
constexpr std::size_t kTriedPerNode = 2;
/// Maximum number of faces in open cells; beyond it, cells are not split. Coplanar faces share even the smallest cells.
constexpr std::size_t kFacesHeldMax = std::size_t{1} << 26;
/// Bytes of a material in the container, excluding its name.
constexpr std::size_t kMaterialBytes = 40;

struct MaterialTreeOptions {
    Bounds box;              ///< of the collider
    double texel = 0.0;      ///< smallest texel of its maps, object units; no cell is smaller than half of it
    std::size_t budget = 0;  ///< bytes; once it is spent, cells are not split
};

/// A triangle in double precision.
struct Face {
    std::array<glm::dvec3, 3> corners;
    glm::dvec3 normal;  ///< unit length

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

/// The leaf that fits a cell's samples best.
struct Fit {
    std::optional<MaterialSides> sides;
    std::uint8_t single = 0;  ///< if `sides` is nullopt
    std::size_t wrong = 0;    ///< weight of wrong samples
};

struct Cell {
    glm::dvec3 center{0.0};
    int depth = 0;
    std::vector<std::uint32_t> faces;
    std::vector<std::uint32_t> samples;
    Fit fit;
    bool final = false;                      ///< is not split further
    bool kept = false;                       ///< is a node of the result, with its octants
    std::array<std::uint32_t, 8> octants{};  ///< cells; 0: a leaf
};

/// Repeatedly splits the leaf with the most wrong samples.
class TreeBuilder {
  public:
    TreeBuilder(const MaterialSource& source, const MaterialTreeOptions& options,
                std::vector<MaterialSample> samples)
        : source_(source), options_(options), samples_(std::move(samples)) {
        result_.list = source.list;
    }

    Materials build() {
        result_.size = static_cast<float>(double{options_.box.longestSide()} + 4.0 * options_.texel);
        const double size = double{result_.size};
        result_.origin = glm::vec3(glm::dvec3(options_.box.center()) - 0.5 * size);
        while (levels_ < kMaterialLevelsMax && std::ldexp(size, -levels_) > options_.texel) {
            ++levels_;
        }
        Cell root;
        root.center = glm::dvec3(result_.origin) + 0.5 * size;
        prepare(root);
        if (const std::optional<std::uint8_t> only = singleOf(root.faces); only || root.faces.empty()) {
            Materials single;  // a tile
            single.list = {source_.list[only.value_or(0)]};
            return single;
        }
        held_ = root.faces.size();
        cells_.push_back(std::move(root));
        split({0});
        std::size_t left = kTriedPerNode * nodesWithin(0) - 1;
        while (!open_.empty() && left > 0) {
            // A fixed batch size, for parallelism and determinism.
            constexpr std::size_t kAtOnce = 32;
            std::vector<std::uint32_t> next;
            while (!open_.empty() && next.size() < std::min(kAtOnce, left)) {
                next.push_back(~open_.top().second);
                open_.pop();
            }
            left -= next.size();
            split(next);
        }
        // Pairs of sides use bytes, too, and a tree with fewer nodes may have other pairs.
        for (std::size_t pairs = 0;;) {
            keepBest(nodesWithin(pairs));
            const std::size_t used = pairsKept();
            if (used <= pairs) {
                break;
            }
            pairs = used;
        }
        writeNodes();
        return std::move(result_);
    }

  private:
    void prepare(Cell& root) {
        const double half = 0.5 * double{result_.size} + margin_;
        for (std::size_t i = 0; i < source_.triangles.size(); ++i) {
            const glm::uvec3& t = source_.triangles[i];
            // A tile's tree needs only faces in the tile.
            const Bounds box =
                boundsOf(std::array{source_.positions[t.x], source_.positions[t.y], source_.positions[t.z]});
            if (glm::any(glm::greaterThan(glm::dvec3(box.min), root.center + half)) ||
                glm::any(glm::lessThan(glm::dvec3(box.max), root.center - half))) {
                continue;
            }
            const Face face{{glm::dvec3(source_.positions[t.x]), glm::dvec3(source_.positions[t.y]),
                             glm::dvec3(source_.positions[t.z])},
                            unit(planeOf(source_.positions, t).normal)};
            if (meets(face, root.center, half)) {
                root.faces.push_back(static_cast<std::uint32_t>(faces_.size()));
                faces_.push_back(face);
                ids_.push_back(source_.ids[i]);
            }
        }
        for (std::size_t i = 0; i < samples_.size(); ++i) {
            root.samples.push_back(static_cast<std::uint32_t>(i));
        }
    }

    /// Returns the maximum number of nodes within the budget. \param pairs  number of pairs of sides.
    [[nodiscard]] std::size_t nodesWithin(std::size_t pairs) const {
        std::size_t used = pairs * sizeof(MaterialSides);
        for (const Material& one : source_.list) {
            used += one.name.size() + kMaterialBytes;
        }
        return std::clamp<std::size_t>(
            (options_.budget - std::min(used, options_.budget)) / sizeof(MaterialNode), 1, kMaterialNodesMax);
    }

    [[nodiscard]] std::optional<std::uint8_t> singleOf(const std::vector<std::uint32_t>& faces) const {
        if (faces.empty()) {
            return std::nullopt;
        }
        const std::uint8_t first = ids_[faces.front()];
        return std::ranges::all_of(faces, [&](std::uint32_t face) { return ids_[face] == first; })
                   ? std::optional(first)
                   : std::nullopt;
    }

    static double along(const glm::dvec3& normal, int axis) {
        return (axis < 3 ? 1.0 : kDiagonal) * alongMaterialAxis(normal, axis);
    }

    /// Returns sides that separate the materials of the faces; nullopt if there are none.
    [[nodiscard]] std::optional<MaterialSides> sidesOf(const std::vector<std::uint32_t>& faces) const {
        for (int axis = 0; axis < kMaterialAxes && source_.sides; ++axis) {
            std::array<int, 2> ids{-1, -1};  // of faces along the axis, and against it
            const bool apart = std::ranges::all_of(faces, [&](std::uint32_t face) {
                const double share = along(faces_[face].normal, axis);
                int& id = ids[share < 0.0 ? 1 : 0];
                id = id < 0 ? ids_[face] : id;
                return std::abs(share) >= kSideMin && id == ids_[face];
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
                id = ids_[face];
            }
        }
        return id;
    }

    /// Returns the most frequent index (the lowest in a tie), and the total of all other counts.
    static std::pair<std::uint8_t, std::size_t> mostFrequent(const std::vector<std::size_t>& counts) {
        const auto found = std::ranges::max_element(counts);
        std::size_t all = 0;
        for (const std::size_t count : counts) {
            all += count;
        }
        return {static_cast<std::uint8_t>(found - counts.begin()), all - *found};
    }

    [[nodiscard]] std::size_t wrongOf(const Fit& fit, const std::vector<std::uint32_t>& samples) const {
        std::size_t wrong = 0;
        for (const std::uint32_t i : samples) {
            const MaterialSample& sample = samples_[i];
            const std::uint8_t id = !fit.sides                                     ? fit.single
                                    : along(sample.normal, fit.sides->axis) >= 0.0 ? fit.sides->towards
                                                                                   : fit.sides->against;
            wrong += id == sample.id ? 0 : sample.weight;
        }
        return wrong;
    }

    /// \param otherwise  the material if there are no samples.
    [[nodiscard]] Fit fitOf(const std::vector<std::uint32_t>& samples, std::uint8_t otherwise) const {
        Fit best{std::nullopt, otherwise, 0};
        if (samples.empty()) {
            return best;
        }
        std::vector<std::size_t> counts(source_.list.size());
        for (const std::uint32_t i : samples) {
            counts[samples_[i].id] += samples_[i].weight;
        }
        std::tie(best.single, best.wrong) = mostFrequent(counts);
        for (int axis = 0; axis < kMaterialAxes && best.wrong > 0; ++axis) {
            std::array<std::vector<std::size_t>, 2> sides{std::vector<std::size_t>(counts.size()),
                                                          std::vector<std::size_t>(counts.size())};
            for (const std::uint32_t i : samples) {
                sides[along(samples_[i].normal, axis) < 0.0 ? 1 : 0][samples_[i].id] += samples_[i].weight;
            }
            const auto [towards, wrong_towards] = mostFrequent(sides[0]);
            const auto [against, wrong_against] = mostFrequent(sides[1]);
            if (wrong_towards + wrong_against < best.wrong) {
                best.sides = MaterialSides{static_cast<std::uint8_t>(axis), towards, against};
                best.wrong = wrong_towards + wrong_against;
            }
        }
        return best;
    }

    [[nodiscard]] Cell octantOf(const Cell& cell, std::size_t number) const {
        Cell octant;
        octant.depth = cell.depth + 1;
        const double half = std::ldexp(double{result_.size}, -octant.depth - 1);
        for (int i = 0; i < 3; ++i) {
            octant.center[i] = cell.center[i] + ((number >> i & 1U) != 0 ? half : -half);
        }
        for (const std::uint32_t face : cell.faces) {
            if (meets(faces_[face], octant.center, half + margin_)) {
                octant.faces.push_back(face);
            }
        }
        for (const std::uint32_t i : cell.samples) {
            const glm::dvec3 off = glm::abs(samples_[i].point - octant.center);
            if (std::max({off.x, off.y, off.z}) <= half) {
                octant.samples.push_back(i);
            }
        }
        const std::optional<std::uint8_t> single = singleOf(octant.faces);
        const std::optional<MaterialSides> sides =
            single || octant.faces.empty() ? std::nullopt : sidesOf(octant.faces);
        bool decided = single || sides;
        octant.fit = {sides, single.value_or(0), 0};
        if (decided) {
            octant.fit.wrong = wrongOf(octant.fit, octant.samples);
            decided = octant.fit.wrong == 0;
        }
        if (!decided) {  // fits the samples: a contact's face may be farther from the cell than margin_
            octant.fit = fitOf(octant.samples,
                               nearest(octant.faces.empty() ? cell.faces : octant.faces, octant.center));
        }
        octant.final = decided || (octant.faces.empty() && octant.fit.wrong == 0) || octant.depth >= levels_;
        return octant;
    }

    void split(const std::vector<std::uint32_t>& cells) {
        std::vector<Cell> octants(8 * cells.size());
        tbb::parallel_for(std::size_t{0}, octants.size(),
                          [&](std::size_t i) { octants[i] = octantOf(cells_[cells[i / 8]], i % 8); });
        for (std::size_t i = 0; i < octants.size(); ++i) {
            const auto number = static_cast<std::uint32_t>(cells_.size());
            cells_[cells[i / 8]].octants[i % 8] = number;
            held_ += octants[i].faces.size();
            if (!octants[i].final && held_ <= kFacesHeldMax) {
                open_.push({octants[i].fit.wrong, ~number});  // in a tie, the first cell
            } else {
                held_ -= octants[i].faces.size();
                octants[i].faces = {};
                octants[i].samples = {};
            }
            cells_.push_back(std::move(octants[i]));
        }
        for (const std::uint32_t cell : cells) {
            held_ -= std::min(held_, cells_[cell].faces.size());
            cells_[cell].faces = {};
            cells_[cell].samples = {};
        }
    }

    /// Returns the byte of a leaf. If there are too many pairs of sides, returns the `towards` material.
    [[nodiscard]] std::uint8_t leafOf(const Fit& fit) {
        if (!fit.sides) {
            return fit.single;
        }
        const auto found = std::ranges::find(result_.sides, *fit.sides);
        const auto index = static_cast<std::size_t>(found - result_.sides.begin());
        if (found == result_.sides.end()) {
            if (result_.list.size() + result_.sides.size() > kMaterialSidesMax) {
                return fit.sides->towards;
            }
            result_.sides.push_back(*fit.sides);
        }
        return static_cast<std::uint8_t>(result_.list.size() + index);
    }

    /// Chooses, bottom-up, which cells keep their octants, to minimize wrong + node_cost · nodes.
    /// \return the number of nodes.
    std::size_t keepCheapest(double node_cost) {
        std::vector<double> cost(cells_.size());
        for (std::size_t i = cells_.size(); i-- > 0;) {
            Cell& cell = cells_[i];
            cost[i] = static_cast<double>(cell.fit.wrong);
            if (cell.octants[0] == 0) {
                continue;
            }
            double split = node_cost;
            for (const std::uint32_t octant : cell.octants) {
                split += cost[octant];
            }
            // If nodes are free, splits without gain are kept, too: they separate surfaces between samples.
            cell.kept = i == 0 || (node_cost > 0.0 ? split < cost[i] : split <= cost[i]);
            cost[i] = cell.kept ? split : cost[i];
        }
        std::size_t nodes = 1;
        for (const Cell& cell : cells_) {
            for (const std::uint32_t octant : cell.octants) {
                cells_[octant].kept = cells_[octant].kept && (octant == 0 || cell.kept);
                nodes += octant != 0 && cells_[octant].kept ? 1 : 0;
            }
        }
        return nodes;
    }

    /// Breadth-first, from the root.
    [[nodiscard]] std::vector<std::uint32_t> keptNodes() const {
        std::vector<std::uint32_t> order{0};
        for (std::size_t i = 0; i < order.size(); ++i) {
            for (const std::uint32_t octant : cells_[order[i]].octants) {
                if (cells_[octant].kept) {
                    order.push_back(octant);
                }
            }
        }
        return order;
    }

    /// Keeps the tree with the lowest error and at most `nodes_max` nodes. Breiman et al., "Classification and
    /// Regression Trees" (1984), chapter 3: each cost per node has its own best tree, and these trees are nested.
    void keepBest(std::size_t nodes_max) {
        double small = 0.0;  // keeps too many
        if (keepCheapest(small) <= nodes_max) {
            return;
        }
        double large = static_cast<double>(kClearContact) * static_cast<double>(samples_.size()) + 1.0;
        constexpr int kHalvings = 30;
        for (int i = 0; i < kHalvings; ++i) {
            const double middle = 0.5 * (small + large);
            (keepCheapest(middle) > nodes_max ? small : large) = middle;
        }
        static_cast<void>(keepCheapest(small));
        const std::vector<std::uint32_t> candidates = keptNodes();
        std::vector<char> is_candidate(cells_.size(), 0);
        for (const std::uint32_t node : candidates) {
            is_candidate[node] = 1;
        }
        std::size_t left = nodes_max - keepCheapest(large);
        // Spends the remaining nodes on splits of equal value, upper levels first.
        std::vector<std::uint32_t> order{0};
        for (std::size_t i = 0; i < order.size(); ++i) {
            for (const std::uint32_t octant : cells_[order[i]].octants) {
                Cell& cell = cells_[octant];
                if (!cell.kept && is_candidate[octant] != 0 && left > 0) {
                    cell.kept = true;
                    --left;
                }
                if (cell.kept) {
                    order.push_back(octant);
                }
            }
        }
    }

    [[nodiscard]] std::size_t pairsKept() const {
        std::vector<MaterialSides> pairs;
        for (const std::uint32_t node : keptNodes()) {
            for (const std::uint32_t octant : cells_[node].octants) {
                const Cell& cell = cells_[octant];
                if (!cell.kept && cell.fit.sides &&
                    std::ranges::find(pairs, *cell.fit.sides) == pairs.end()) {
                    pairs.push_back(*cell.fit.sides);
                }
            }
        }
        return std::min(pairs.size(), kMaterialSidesMax + 1 - result_.list.size());
    }

    /// Breadth-first.
    void writeNodes() {
        std::vector<std::uint32_t> order{0};
        for (std::size_t i = 0; i < order.size(); ++i) {
            MaterialNode node;
            for (std::size_t k = 0; k < 8; ++k) {
                const std::uint32_t number = cells_[order[i]].octants[k];
                if (!cells_[number].kept) {
                    node.leaves[k] = leafOf(cells_[number].fit);
                    continue;
                }
                node.head |= 1U << k |
                             ((node.head & 0xFFU) == 0 ? static_cast<std::uint32_t>(order.size()) << 8U : 0U);
                order.push_back(number);
            }
            result_.nodes.push_back(node);
        }
    }

    const MaterialSource& source_;
    const MaterialTreeOptions& options_;
    std::vector<MaterialSample> samples_;
    Materials result_;
    std::vector<Face> faces_;        // those that meet the root
    std::vector<std::uint8_t> ids_;  // by face
    std::size_t held_ = 0;           // faces in cells that may still be split
    std::vector<Cell> cells_;
    std::priority_queue<std::pair<std::size_t, std::uint32_t>> open_;  // wrong samples, and ~ the cell
    double margin_ = kMargin * options_.texel;
    int levels_ = 1;
};

}  // namespace

Materials materialsFor(const Collider& collider, const MaterialSource* source) {
    if (source == nullptr) {
        return {};
    }
    MaterialTreeOptions options;
    options.box = collider.bounds;
    options.texel = double{finestTexel(collider)};
    options.budget =
        std::max(static_cast<std::size_t>(kMaterialsFractionMax * static_cast<double>(collider.texelBytes())),
                 kMaterialsBytesMin);
    return TreeBuilder(*source, options, sampleContacts(collider, *source)).build();
}

}  // namespace relief

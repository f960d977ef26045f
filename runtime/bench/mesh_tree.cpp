// SPDX-License-Identifier: Apache-2.0
#include "runtime/bench/mesh_tree.h"

#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <glm/geometric.hpp>
#include <numeric>
#include <optional>
#include <string>
#include <tuple>

#include "formats/base/portable_math.h"

namespace relief {
namespace {

constexpr std::size_t kTrianglesMax = (1U << 24U) - 1;  // 24 bits in a node
constexpr std::uint32_t kStackMax = 128;
constexpr std::size_t kBins = 16;
// Cost of a binary split in units of a triangle test. A wide node replaces up to three splits.
constexpr float kSplitCost = 2.0F;

float areaOf(const Bounds& box) {
    const glm::vec3 size = box.size();
    return size.x * size.y + size.y * size.z + size.z * size.x;
}

Bounds united(Bounds a, const Bounds& b) {
    a.add(b.min);
    a.add(b.max);
    return a;
}

/// Returns a vertex index for each position, the same for equal positions, and the number of vertices.
std::pair<std::vector<std::uint32_t>, std::uint32_t> mergedVertices(std::span<const glm::vec3> positions) {
    std::vector<std::uint32_t> order(positions.size());
    std::iota(order.begin(), order.end(), 0U);
    const auto key = [&](std::uint32_t i) {
        return std::tuple(positions[i].x, positions[i].y, positions[i].z, i);
    };
    std::ranges::sort(order, {}, key);
    std::vector<std::uint32_t> vertex(positions.size());
    std::uint32_t count = 0;
    for (std::size_t i = 0; i < order.size(); ++i) {
        count += i == 0 || positions[order[i]] != positions[order[i - 1]] ? 1 : 0;
        vertex[order[i]] = count - 1;
    }
    return {std::move(vertex), count};
}

glm::dvec3 normalOf(const std::array<glm::vec3, 3>& corners) {
    const glm::dvec3 a(corners[0]);
    return glm::cross(glm::dvec3(corners[1]) - a, glm::dvec3(corners[2]) - a);
}

/// A mesh with merged vertices, without triangles that have no area.
struct CleanMesh {
    std::vector<std::array<glm::vec3, 3>> corners;
    std::vector<std::array<std::uint32_t, 3>> vertices;
    std::uint32_t vertex_count = 0;
    std::size_t dropped = 0;
};

CleanMesh cleanMesh(std::span<const glm::vec3> positions, std::span<const glm::uvec3> triangles) {
    const auto [vertex, count] = mergedVertices(positions);
    CleanMesh mesh;
    mesh.vertex_count = count;
    for (const glm::uvec3& t : triangles) {
        const std::array<glm::vec3, 3> corners = {positions[t.x], positions[t.y], positions[t.z]};
        if (normalOf(corners) == glm::dvec3(0.0)) {
            ++mesh.dropped;
            continue;
        }
        mesh.corners.push_back(corners);
        mesh.vertices.push_back({vertex[t.x], vertex[t.y], vertex[t.z]});
    }
    return mesh;
}

/// Returns the triangle across each side 3 t + i, from corner i of triangle t to its next corner; t if there is none.
std::vector<std::uint32_t> neighbours(const CleanMesh& mesh, std::size_t& open_edges) {
    struct Side {
        std::uint32_t low, high, side;
        bool forward;
    };
    std::vector<Side> sides;
    sides.reserve(3 * mesh.vertices.size());
    std::vector<std::uint32_t> across;
    for (std::uint32_t t = 0; t < mesh.vertices.size(); ++t) {
        for (std::uint32_t i = 0; i < 3; ++i) {
            const std::uint32_t from = mesh.vertices[t][i];
            const std::uint32_t to = mesh.vertices[t][(i + 1) % 3];
            sides.push_back({std::min(from, to), std::max(from, to), 3 * t + i, from < to});
            across.push_back(t);
        }
    }
    std::ranges::sort(sides, {}, [](const Side& s) { return std::tuple(s.low, s.high, s.side); });
    for (std::size_t i = 0; i < sides.size();) {
        std::size_t end = i + 1;
        while (end < sides.size() && sides[end].low == sides[i].low && sides[end].high == sides[i].high) {
            ++end;
        }
        if (end - i == 2 && sides[i].forward != sides[i + 1].forward) {
            across[sides[i].side] = sides[i + 1].side / 3;
            across[sides[i + 1].side] = sides[i].side / 3;
        } else {
            open_edges += end - i;
        }
        i = end;
    }
    return across;
}

std::vector<glm::vec4> vertexNormals(const CleanMesh& mesh) {
    std::vector<glm::dvec3> sums(mesh.vertex_count, glm::dvec3(0.0));
    for (std::size_t t = 0; t < mesh.corners.size(); ++t) {
        const std::array<glm::vec3, 3>& corners = mesh.corners[t];
        const glm::dvec3 normal = glm::normalize(normalOf(corners));
        for (std::size_t i = 0; i < 3; ++i) {
            const glm::dvec3 a = glm::dvec3(corners[(i + 1) % 3]) - glm::dvec3(corners[i]);
            const glm::dvec3 b = glm::dvec3(corners[(i + 2) % 3]) - glm::dvec3(corners[i]);
            const double angle = portable::atan2(glm::length(glm::cross(a, b)), glm::dot(a, b));
            sums[mesh.vertices[t][i]] += angle * normal;
        }
    }
    std::vector<glm::vec4> normals;
    for (const glm::dvec3& sum : sums) {
        const double length = glm::length(sum);
        normals.emplace_back(glm::vec3(length > 0.0 ? sum / length : sum), 0.0F);
    }
    return normals;
}

struct Item {
    Bounds box;
    glm::vec3 center;
    std::uint32_t triangle;
};

/// A node of the binary tree. Leaves have no children.
struct Split {
    Bounds box;
    std::uint32_t first = 0, count = 0;  // items
    std::uint32_t left = 0, right = 0;   // 0: leaf
    [[nodiscard]] bool leaf() const { return left == 0; }
};

class BinaryTree {
  public:
    explicit BinaryTree(const CleanMesh& mesh) {
        for (std::uint32_t t = 0; t < mesh.corners.size(); ++t) {
            Item item{{}, {}, t};
            for (const glm::vec3& corner : mesh.corners[t]) {
                item.box.add(corner);
            }
            item.center = item.box.center();
            items_.push_back(item);
        }
        splits_.reserve(2 * items_.size());
        splits_.push_back(splitOf(0, static_cast<std::uint32_t>(items_.size())));
        for (std::size_t i = 0; i < splits_.size(); ++i) {  // grows
            const std::uint32_t middle = cut(splits_[i]);
            if (middle != 0) {
                const std::uint32_t first = splits_[i].first;
                const std::uint32_t end = first + splits_[i].count;
                splits_[i].left = static_cast<std::uint32_t>(splits_.size());
                splits_[i].right = splits_[i].left + 1;
                splits_.push_back(splitOf(first, middle - first));
                splits_.push_back(splitOf(middle, end - middle));
            }
        }
    }
    [[nodiscard]] const std::vector<Item>& items() const { return items_; }
    [[nodiscard]] const std::vector<Split>& splits() const { return splits_; }

  private:
    struct Bin {
        Bounds box;
        std::uint32_t count = 0;
        void add(const Bin& bin) {
            box = bin.count == 0 ? box : united(box, bin.box);
            count += bin.count;
        }
        [[nodiscard]] float cost() const {
            return count == 0 ? 0.0F : areaOf(box) * static_cast<float>(count);
        }
    };
    /// A cut below bin `bin` of an axis.
    struct Plane {
        float cost = 0.0F;
        glm::length_t axis = 0;
        std::size_t bin = 0;
    };

    [[nodiscard]] std::span<Item> itemsOf(const Split& split) {
        return std::span(items_).subspan(split.first, split.count);
    }
    [[nodiscard]] Split splitOf(std::uint32_t first, std::uint32_t count) {
        Split split{{}, first, count};
        for (const Item& item : itemsOf(split)) {
            split.box = united(split.box, item.box);
        }
        return split;
    }
    static std::size_t binOf(const Item& item, glm::length_t axis, const Bounds& centers) {
        const float fraction =
            (item.center[axis] - centers.min[axis]) / (centers.max[axis] - centers.min[axis]);
        return std::min(static_cast<std::size_t>(fraction * static_cast<float>(kBins)), kBins - 1);
    }
    std::optional<Plane> bestPlane(const Split& split, const Bounds& centers) {
        std::optional<Plane> best;
        for (glm::length_t axis = 0; axis < 3; ++axis) {
            if (!(centers.max[axis] > centers.min[axis])) {
                continue;
            }
            std::array<Bin, kBins> bins;
            for (const Item& item : itemsOf(split)) {
                bins[binOf(item, axis, centers)].add({item.box, 1});
            }
            std::array<float, kBins> above{};
            Bin sum;
            for (std::size_t i = kBins; i-- > 1;) {
                sum.add(bins[i]);
                above[i] = sum.cost();
            }
            sum = {};
            for (std::size_t i = 1; i < kBins; ++i) {
                sum.add(bins[i - 1]);
                const float cost = sum.cost() + above[i];
                if (sum.count > 0 && sum.count < split.count && (!best || cost < best->cost)) {
                    best = Plane{cost, axis, i};
                }
            }
        }
        return best;
    }
    /// Partitions the items of a split into two parts. Returns the first item of the second part, or 0 for a leaf.
    std::uint32_t cut(const Split& split) {
        Bounds centers;
        for (const Item& item : itemsOf(split)) {
            centers.add(item.center);
        }
        const std::optional<Plane> plane = bestPlane(split, centers);
        const bool small = split.count <= MeshTree::kLeafMax;
        if (!plane) {  // equal centres
            return small ? 0 : split.first + split.count / 2;
        }
        const float area = areaOf(split.box);
        if (small && plane->cost + kSplitCost * area >= area * static_cast<float>(split.count)) {
            return 0;
        }
        const auto upper = std::ranges::stable_partition(
            itemsOf(split), [&](const Item& item) { return binOf(item, plane->axis, centers) < plane->bin; });
        return split.first + split.count - static_cast<std::uint32_t>(upper.size());
    }

    std::vector<Item> items_;
    std::vector<Split> splits_;
};

/// Returns up to four descendants that replace a split, by repeatedly opening the largest one.
std::vector<std::uint32_t> childrenOf(const std::vector<Split>& splits, std::uint32_t of) {
    std::vector<std::uint32_t> children = {of};
    while (children.size() < MeshTree::kWidth) {
        std::size_t largest = children.size();
        for (std::size_t i = 0; i < children.size(); ++i) {
            const bool larger = largest == children.size() ||
                                areaOf(splits[children[i]].box) > areaOf(splits[children[largest]].box);
            largest = !splits[children[i]].leaf() && larger ? i : largest;
        }
        if (largest == children.size()) {
            break;
        }
        const Split& opened = splits[children[largest]];
        children[largest] = opened.left;
        children.insert(children.begin() + static_cast<std::ptrdiff_t>(largest) + 1, opened.right);
    }
    return children;
}

/// Encodes boxes within the box of a node in 8 bits per face, rounded outwards.
struct BoxCode {
    glm::vec3 origin;
    std::array<std::uint32_t, 3> exponents{};  // plus 127

    explicit BoxCode(const Bounds& box) : origin(box.min) {
        for (glm::length_t axis = 0; axis < 3; ++axis) {
            std::uint32_t& exponent = exponents[static_cast<std::size_t>(axis)];
            exponent = 1;
            while (upper(axis, box.max[axis]) > 255.0) {
                ++exponent;
            }
        }
    }
    [[nodiscard]] double unit(glm::length_t axis) const {
        return std::ldexp(1.0, static_cast<int>(exponents[static_cast<std::size_t>(axis)]) - 127);
    }
    [[nodiscard]] double lower(glm::length_t axis, float x) const {
        return std::floor((double{x} - double{origin[axis]}) / unit(axis));
    }
    [[nodiscard]] double upper(glm::length_t axis, float x) const {
        return std::ceil((double{x} - double{origin[axis]}) / unit(axis));
    }
};

glm::uvec4 bitsOf(const glm::vec3& p, std::uint32_t w) {
    return {std::bit_cast<std::uint32_t>(p.x), std::bit_cast<std::uint32_t>(p.y),
            std::bit_cast<std::uint32_t>(p.z), w};
}

/// Appends the texels of a node.
void packNode(MeshTree& tree, const Split& node, const std::vector<Split>& children, std::uint32_t first_node,
              std::uint32_t first_triangle) {
    const BoxCode code(node.box);
    std::array<std::uint32_t, 3> lower{}, upper{};
    std::uint32_t kinds = 0;
    for (std::size_t i = 0; i < children.size(); ++i) {
        const Split& child = children[i];
        kinds |= (child.leaf() ? child.count : MeshTree::kNodeCode) << (4 * i);
        for (glm::length_t axis = 0; axis < 3; ++axis) {
            const auto a = static_cast<std::size_t>(axis);
            lower[a] |= static_cast<std::uint32_t>(code.lower(axis, child.box.min[axis])) << (8 * i);
            upper[a] |= static_cast<std::uint32_t>(code.upper(axis, child.box.max[axis])) << (8 * i);
        }
    }
    tree.nodes.push_back(
        bitsOf(code.origin, code.exponents[0] | code.exponents[1] << 8U | code.exponents[2] << 16U));
    tree.nodes.emplace_back(first_node | (kinds & 0xffU) << 24U, first_triangle | (kinds >> 8U) << 24U,
                            lower[0], lower[1]);
    tree.nodes.emplace_back(lower[2], upper[0], upper[1], upper[2]);
}

/// Packs all nodes, breadth first. Returns the triangles in leaf order.
std::vector<std::uint32_t> packNodes(MeshTree& tree, const BinaryTree& binary) {
    const std::vector<Split>& splits = binary.splits();
    struct Pending {
        std::uint32_t split;
        std::uint32_t stack;  // entries on the stack when a traversal reaches it
    };
    std::vector<Pending> queue = {{0, 0}};
    std::vector<std::uint32_t> order;
    for (std::size_t i = 0; i < queue.size(); ++i) {  // grows
        const Pending node = queue[i];
        const auto first_node = static_cast<std::uint32_t>(queue.size());
        const auto first_triangle = static_cast<std::uint32_t>(order.size());
        const std::vector<std::uint32_t> indices = childrenOf(splits, node.split);
        const std::uint32_t stack = node.stack + static_cast<std::uint32_t>(indices.size()) - 1;
        tree.stack = std::max(tree.stack, stack);
        std::vector<Split> children;
        for (const std::uint32_t index : indices) {
            const Split& child = children.emplace_back(splits[index]);
            if (!child.leaf()) {
                queue.push_back({index, stack});
                continue;
            }
            for (std::uint32_t k = child.first; k < child.first + child.count; ++k) {
                order.push_back(binary.items()[k].triangle);
            }
        }
        packNode(tree, splits[node.split], children, first_node, first_triangle);
    }
    return order;
}

void packTriangles(MeshTree& tree, const CleanMesh& mesh, const std::vector<std::uint32_t>& order) {
    const std::vector<std::uint32_t> across = neighbours(mesh, tree.open_edges);
    std::vector<std::uint32_t> place(order.size());
    for (std::uint32_t i = 0; i < order.size(); ++i) {
        place[order[i]] = i;
    }
    for (const std::uint32_t t : order) {
        for (std::size_t i = 0; i < 3; ++i) {
            tree.triangles.push_back(bitsOf(mesh.corners[t][i], place[across[3 * std::size_t{t} + i]]));
            tree.vertices.push_back(mesh.vertices[t][i]);
        }
    }
}

}  // namespace

Result<MeshTree> buildMeshTree(std::span<const glm::vec3> positions, std::span<const glm::uvec3> triangles) {
    const CleanMesh mesh = cleanMesh(positions, triangles);
    if (mesh.corners.empty()) {
        return fail(ErrorCode::kInvalidInput, "no triangle has an area");
    }
    if (mesh.corners.size() > kTrianglesMax) {
        return fail(ErrorCode::kLimit, std::to_string(mesh.corners.size()) +
                                           " triangles; the exact rival supports at most " +
                                           std::to_string(kTrianglesMax));
    }
    MeshTree tree;
    tree.dropped = mesh.dropped;
    const BinaryTree binary(mesh);
    tree.box = binary.splits().front().box;
    packTriangles(tree, mesh, packNodes(tree, binary));
    tree.normals = vertexNormals(mesh);
    if (tree.stack > kStackMax) {
        return fail(ErrorCode::kLimit, "the tree is too deep for a shader's stack of " +
                                           std::to_string(kStackMax) + " entries; use a more uniform mesh");
    }
    return tree;
}

}  // namespace relief

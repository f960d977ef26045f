// SPDX-License-Identifier: Apache-2.0
#include "bake/bench/brick_volume.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <glm/common.hpp>
#include <glm/geometric.hpp>
#include <optional>

#include <Eigen/Cholesky>

#include "bake/bench/distance_volume.h"
#include "bake/measure/truth.h"
#include "bake/mesh/loops.h"
#include "bake/mesh/mersenne.h"

namespace relief {
namespace {

constexpr double kCodeMax = 127.0;
// A fit divides a voxel into this many parts along each axis, and uses one random point in each part.
constexpr unsigned kFitParts = 3;
// Surface points that determine which cubes to split: number per byte of the budget, and maximum.
constexpr double kSamplesPerByte = 0.5;
constexpr std::uint32_t kSamplesMax = 1'500'000;

/// Returns a corner of the unit cube, x fastest.
glm::uvec3 cornerOf(unsigned i) {
    return {i & 1U, i >> 1U & 1U, i >> 2U};
}

/// A cube in object space.
struct Box {
    glm::dvec3 low{0.0};
    double size = 0.0;

    [[nodiscard]] glm::dvec3 middle() const { return low + 0.5 * size; }
    [[nodiscard]] double halfDiagonal() const { return 0.5 * std::sqrt(3.0) * size; }
    [[nodiscard]] bool contains(const glm::dvec3& p) const {
        return glm::all(glm::greaterThanEqual(p, low)) && glm::all(glm::lessThanEqual(p, low + size));
    }
    [[nodiscard]] Box octant(unsigned i) const {
        return {low + 0.5 * size * glm::dvec3(cornerOf(i)), 0.5 * size};
    }
    /// Returns the octant of a point in the box.
    [[nodiscard]] unsigned octantOf(const glm::dvec3& p) const {
        const glm::bvec3 upper = glm::greaterThanEqual(p, middle());
        return (upper.x ? 1U : 0U) + (upper.y ? 2U : 0U) + (upper.z ? 4U : 0U);
    }
};

/// Whether a box contains surface. May also return true if surface is outside, within a fortieth of the box's side.
bool containsSurface(const MeshQuery& query, const Box& box, std::optional<std::uint32_t> hint = {},
                     unsigned halvings = 4) {
    const ClosestPoint closest = query.closest(glm::vec3(box.middle()), hint);
    if (closest.distance > 1.0001 * box.halfDiagonal()) {
        return false;
    }
    if (halvings == 0 || box.contains(closest.point)) {
        return true;
    }
    for (unsigned i = 0; i < 8; ++i) {
        if (containsSurface(query, box.octant(i), closest.triangle, halvings - 1)) {
            return true;
        }
    }
    return false;
}

/// Returns the trilinear weights of the eight corners of a voxel, x fastest.
std::array<double, 8> weightsAt(const glm::dvec3& t) {
    std::array<double, 8> weights;
    for (unsigned i = 0; i < 8; ++i) {
        weights[i] = ((i & 1U) != 0 ? t.x : 1.0 - t.x) * ((i >> 1U & 1U) != 0 ? t.y : 1.0 - t.y) *
                     ((i >> 2U) != 0 ? t.z : 1.0 - t.z);
    }
    return weights;
}

/// The nodes and voxels of a brick of `cells`³ voxels.
struct BrickGrid {
    unsigned cells;

    [[nodiscard]] unsigned side() const { return cells + 1; }
    [[nodiscard]] unsigned nodes() const { return side() * side() * side(); }
    [[nodiscard]] glm::uvec3 node(unsigned i) const {
        return {i % side(), i / side() % side(), i / side() / side()};
    }
    [[nodiscard]] unsigned corner(const glm::uvec3& voxel, unsigned i) const {
        return ((voxel.z + (i >> 2U)) * side() + voxel.y + (i >> 1U & 1U)) * side() + voxel.x + (i & 1U);
    }
    [[nodiscard]] glm::uvec3 voxelAt(const glm::dvec3& in_voxels) const {
        return glm::clamp(glm::floor(in_voxels), 0.0, cells - 1.0);
    }
    template <class Value>
    [[nodiscard]] double valueAt(const std::vector<Value>& values, const glm::dvec3& in_voxels) const {
        const glm::uvec3 voxel = voxelAt(in_voxels);
        const std::array<double, 8> weights = weightsAt(in_voxels - glm::dvec3(voxel));
        double value = 0.0;
        for (unsigned i = 0; i < 8; ++i) {
            value += weights[i] * static_cast<double>(values[corner(voxel, i)]);
        }
        return value;
    }
};

std::vector<double> exactNodes(const MeshQuery& query, const BrickGrid& grid, const Box& box) {
    std::vector<double> nodes(grid.nodes());
    DistanceWalk walk(query);
    const double voxel = box.size / grid.cells;
    for (unsigned i = 0; i < nodes.size(); ++i) {
        // Rows alternate in direction, so that consecutive nodes are neighbours.
        glm::uvec3 at = grid.node(i);
        at.y = at.z % 2 == 0 ? at.y : grid.cells - at.y;
        at.x = (at.z * grid.side() + at.y) % 2 == 0 ? at.x : grid.cells - at.x;
        nodes[(at.z * grid.side() + at.y) * grid.side() + at.x] = walk.at(box.low + voxel * glm::dvec3(at));
    }
    return nodes;
}

/// Fits nodes so that the trilinear value is closest to the distances at points of the voxels that the surface crosses.
void fitNodes(const MeshQuery& query, const BrickGrid& grid, const Box& box, std::vector<double>& nodes) {
    using Matrix = Eigen::MatrixXd;
    using Vector = Eigen::VectorXd;
    const double voxel = box.size / grid.cells;
    Matrix normal = Matrix::Zero(grid.nodes(), grid.nodes());
    Vector right = Vector::Zero(grid.nodes());
    DistanceWalk walk(query);
    const glm::dvec3 place = box.middle() / box.size;  // a seed that depends only on the position
    Mersenne64 random(splitMix64(static_cast<std::uint64_t>(std::llround(place.x * 64.0))) +
                      splitMix64(static_cast<std::uint64_t>(std::llround(place.y * 64.0)) + 1) +
                      splitMix64(static_cast<std::uint64_t>(std::llround(place.z * 64.0)) + 2));
    const auto unit = [&] { return static_cast<double>(random() >> 11U) * 0x1p-53; };
    for (unsigned i = 0; i < grid.cells * grid.cells * grid.cells; ++i) {
        const glm::uvec3 at(i % grid.cells, i / grid.cells % grid.cells, i / grid.cells / grid.cells);
        if (std::abs(walk.at(box.low + voxel * (glm::dvec3(at) + 0.5))) > 0.5 * std::sqrt(3.0) * voxel) {
            continue;
        }
        for (unsigned k = 0; k < kFitParts * kFitParts * kFitParts; ++k) {
            const glm::dvec3 part(k % kFitParts, k / kFitParts % kFitParts, k / kFitParts / kFitParts);
            const glm::dvec3 t = (part + glm::dvec3(unit(), unit(), unit())) / double{kFitParts};
            const double distance = walk.at(box.low + voxel * (glm::dvec3(at) + t)) / voxel;
            const double weight = 1.0 / (0.01 + distance * distance);
            const std::array<double, 8> weights = weightsAt(t);
            for (unsigned a = 0; a < 8; ++a) {
                const unsigned row = grid.corner(at, a);
                right(row) += weight * weights[a] * distance;
                for (unsigned b = 0; b < 8; ++b) {
                    normal(row, grid.corner(at, b)) += weight * weights[a] * weights[b];
                }
            }
        }
    }
    // Keep nodes near their previous values if few points constrain them.
    for (unsigned i = 0; i < grid.nodes(); ++i) {
        const double pull = 0.01 + 1e-3 * normal(i, i);
        normal(i, i) += pull;
        right(i) += pull * nodes[i] / voxel;
    }
    const Vector fitted = normal.ldlt().solve(right);
    for (unsigned i = 0; i < grid.nodes(); ++i) {
        nodes[i] = fitted(i) * voxel;
    }
}

}  // namespace

/// Fills a BrickVolume.
class BrickBuilder {
  public:
    BrickBuilder(const MeshQuery& query, const BrickLayout& layout, double root_size)
        : query_(query), grid_{layout.cells}, volume_(query, layout, root_size) {}

    [[nodiscard]] BrickVolume uniform() && {
        const std::vector<std::uint64_t> cells = cellsWithSurface();
        std::vector<std::vector<double>> nodes(cells.size());
        forEachIndex(0, cells.size(), 16, [&](std::size_t i) {
            const Box box = boxOf(cells[i]);
            nodes[i] = exactNodes(query_, grid_, box);
            if (volume_.layout_.fitted) {
                fitNodes(query_, grid_, box, nodes[i]);
            }
        });
        for (std::size_t i = 0; i < cells.size(); ++i) {
            volume_.roots_.push_back({cells[i], stored(nodes[i], volume_.root_size_)});
        }
        return std::move(volume_);
    }

    [[nodiscard]] std::uint64_t uniformBytes() {
        for (const std::uint64_t cell : cellsWithSurface()) {
            volume_.roots_.push_back({cell, {}});
        }
        return volume_.roots_.size() * grid_.nodes() + volume_.indexBytes(volume_.roots_.size());
    }

    [[nodiscard]] BrickVolume octree(std::uint64_t bytes) && {
        AccuracyOptions options;
        options.samples = static_cast<std::uint32_t>(
            std::clamp(kSamplesPerByte * static_cast<double>(bytes), 1e4, 1.0 * kSamplesMax));
        options.seed = 0x6f637472;
        samples_ = sampleSurface(query_, options);
        std::erase_if(samples_, [](const SurfacePoint& point) { return point.buried; });
        for (const std::uint64_t cell : cellsWithSurface()) {
            volume_.roots_.push_back({cell, {}});
        }
        leaves_.resize(volume_.roots_.size());
        std::vector<std::vector<std::uint32_t>> samples_by_root(leaves_.size());
        for (std::uint32_t i = 0; i < samples_.size(); ++i) {
            const std::uint64_t cell = volume_.cellAt(samples_[i].position);
            const auto at = std::ranges::lower_bound(volume_.roots_, cell, {}, &BrickVolume::Root::cell);
            if (at != volume_.roots_.end() && at->cell == cell) {
                samples_by_root[static_cast<std::size_t>(at - volume_.roots_.begin())].push_back(i);
            }
        }
        forEachIndex(0, leaves_.size(), 16, [&](std::size_t i) {
            leaves_[i] = makeLeaf(boxOf(volume_.roots_[i].cell), 0, std::move(samples_by_root[i]));
            leaves_[i].slot = static_cast<std::uint32_t>(i);
        });
        for (const Leaf& leaf : leaves_) {
            bricks_ += leaf.stored ? 1 : 0;
        }
        while (splitWorst(bytes)) {
        }
        store();
        return std::move(volume_);
    }

  private:
    struct Leaf {
        Box box;
        unsigned level = 0;
        std::uint32_t slot = 0;  // index into roots_ at level 0, else into cubes_
        bool surface = false;
        bool stored = false;
        bool split = false;
        double error = 0.0;  // total displacement of the surface at its sample points
        std::vector<double> nodes;
        std::vector<std::uint32_t> samples;
    };

    [[nodiscard]] Box boxOf(std::uint64_t cell) const {
        return {volume_.origin_ + volume_.root_size_ * glm::dvec3(volume_.rootOf(cell)), volume_.root_size_};
    }

    /// Returns the cells in ascending order.
    [[nodiscard]] std::vector<std::uint64_t> cellsWithSurface() const {
        const glm::uvec3 n = volume_.roots_count_;
        std::uint32_t span = 1;
        while (span < std::max({n.x, n.y, n.z})) {
            span *= 2;
        }
        // Descends a few levels on one core, and the rest on all cores.
        std::vector<glm::uvec3> blocks = {glm::uvec3(0)};
        for (int level = 0; level < 4 && span > 1; ++level) {
            span /= 2;
            std::vector<glm::uvec3> finer;
            for (const glm::uvec3& block : blocks) {
                for (unsigned i = 0; i < 8; ++i) {
                    const glm::uvec3 at = block + span * cornerOf(i);
                    if (glm::all(glm::lessThan(at, n)) && near(at, span)) {
                        finer.push_back(at);
                    }
                }
            }
            blocks = std::move(finer);
        }
        std::vector<std::vector<std::uint64_t>> found(blocks.size());
        forEachIndex(0, blocks.size(), 1, [&](std::size_t i) { descend(blocks[i], span, found[i]); });
        std::vector<std::uint64_t> cells;
        for (const std::vector<std::uint64_t>& of : found) {
            cells.insert(cells.end(), of.begin(), of.end());
        }
        std::ranges::sort(cells);
        return cells;
    }
    [[nodiscard]] bool near(const glm::uvec3& at, std::uint32_t span) const {
        const Box box{volume_.origin_ + volume_.root_size_ * glm::dvec3(at), volume_.root_size_ * span};
        return query_.closest(glm::vec3(box.middle())).distance <= 1.0001 * box.halfDiagonal();
    }
    void descend(const glm::uvec3& at, std::uint32_t span, std::vector<std::uint64_t>& found) const {
        const glm::uvec3 n = volume_.roots_count_;
        if (!glm::all(glm::lessThan(at, n))) {
            return;
        }
        if (span == 1) {
            const std::uint64_t cell = (std::uint64_t{at.z} * n.y + at.y) * n.x + at.x;
            if (containsSurface(query_, boxOf(cell))) {
                found.push_back(cell);
            }
            return;
        }
        if (near(at, span)) {
            for (unsigned i = 0; i < 8; ++i) {
                descend(at + span / 2 * cornerOf(i), span / 2, found);
            }
        }
    }

    /// Adds a brick, unless a sign is sufficient.
    [[nodiscard]] BrickVolume::Cube stored(const std::vector<double>& nodes, double size) {
        using Kind = BrickVolume::Kind;
        const double range = volume_.layout_.band * size / grid_.cells;
        std::vector<std::int8_t> codes(nodes.size());
        for (std::size_t i = 0; i < nodes.size(); ++i) {
            const double code = std::clamp(nodes[i] / range * kCodeMax, -kCodeMax, kCodeMax);
            codes[i] = static_cast<std::int8_t>(std::lround(code));
        }
        const auto outside = [](std::int8_t code) { return code >= 0; };
        if (std::ranges::all_of(codes, outside)) {
            return {Kind::kOutside, 0};
        }
        if (std::ranges::none_of(codes, [](std::int8_t code) { return code > 0; })) {
            return {Kind::kInside, 0};
        }
        const auto brick = static_cast<std::uint32_t>(volume_.bricks());
        volume_.codes_.insert(volume_.codes_.end(), codes.begin(), codes.end());
        return {Kind::kBrick, brick};
    }

    [[nodiscard]] Leaf makeLeaf(const Box& box, unsigned level, std::vector<std::uint32_t> samples) const {
        Leaf leaf;
        leaf.box = box;
        leaf.level = level;
        leaf.samples = std::move(samples);
        leaf.surface = containsSurface(query_, box);
        if (!leaf.surface) {
            return leaf;
        }
        leaf.nodes = exactNodes(query_, grid_, box);
        const auto outside = [](double distance) { return distance >= 0.0; };
        const auto inside = [](double distance) { return distance < 0.0; };
        leaf.stored = !std::ranges::all_of(leaf.nodes, outside) && !std::ranges::all_of(leaf.nodes, inside);
        for (const std::uint32_t sample : leaf.samples) {
            const glm::dvec3 in_voxels = (glm::dvec3(samples_[sample].position) - box.low) / box.size *
                                         static_cast<double>(grid_.cells);
            // A brick without a sign change displaces the surface to its boundary.
            leaf.error += leaf.stored ? std::abs(grid_.valueAt(leaf.nodes, in_voxels)) : 0.25 * box.size;
        }
        return leaf;
    }

    /// Splits the leaves with the largest errors. \return false if the bytes are used up.
    bool splitWorst(std::uint64_t bytes) {
        const std::uint64_t now = bricks_ * grid_.nodes() + volume_.indexBytes(bricks_);
        // At least four of eight cubes contain surface.
        const std::uint64_t cost = 3 * grid_.nodes() + 8 * 4;
        if (now + 2 * cost > bytes) {
            return false;
        }
        std::vector<std::uint32_t> worst;
        for (std::uint32_t i = 0; i < leaves_.size(); ++i) {
            if (leaves_[i].surface && !leaves_[i].split && leaves_[i].error > 0.0) {
                worst.push_back(i);
            }
        }
        const std::size_t count =
            std::min<std::size_t>({worst.size(), (bytes - now) / (2 * cost), 16 + worst.size() / 8});
        const auto larger = [&](std::uint32_t a, std::uint32_t b) {
            return leaves_[a].error != leaves_[b].error ? leaves_[a].error > leaves_[b].error : a < b;
        };
        std::ranges::partial_sort(worst, worst.begin() + static_cast<std::ptrdiff_t>(count), larger);
        worst.resize(count);
        std::vector<std::array<Leaf, 8>> made(count);
        forEachIndex(0, count, 4, [&](std::size_t i) {
            const Leaf& leaf = leaves_[worst[i]];
            std::array<std::vector<std::uint32_t>, 8> samples;
            for (const std::uint32_t sample : leaf.samples) {
                samples[leaf.box.octantOf(samples_[sample].position)].push_back(sample);
            }
            for (unsigned k = 0; k < 8; ++k) {
                made[i][k] = makeLeaf(leaf.box.octant(k), leaf.level + 1, std::move(samples[k]));
            }
        });
        for (std::size_t i = 0; i < count; ++i) {
            Leaf& parent = leaves_[worst[i]];
            parent.split = true;
            bricks_ -= parent.stored ? 1 : 0;
            cubeOf(parent) = {BrickVolume::Kind::kSplit, static_cast<std::uint32_t>(volume_.cubes_.size())};
            parent.samples = {};
            parent.nodes = {};
            volume_.levels_ = std::max(volume_.levels_, parent.level + 1);
            for (Leaf& leaf : made[i]) {
                leaf.slot = static_cast<std::uint32_t>(volume_.cubes_.size());
                bricks_ += leaf.stored ? 1 : 0;
                volume_.cubes_.push_back({});
                leaves_.push_back(std::move(leaf));
            }
        }
        return count > 0;
    }

    BrickVolume::Cube& cubeOf(const Leaf& leaf) {
        return leaf.level == 0 ? volume_.roots_[leaf.slot].cube : volume_.cubes_[leaf.slot];
    }

    void store() {
        std::erase_if(leaves_, [](const Leaf& leaf) { return leaf.split || !leaf.surface; });
        if (volume_.layout_.fitted) {
            forEachIndex(0, leaves_.size(), 16, [&](std::size_t i) {
                if (leaves_[i].stored) {
                    fitNodes(query_, grid_, leaves_[i].box, leaves_[i].nodes);
                }
            });
        }
        for (const Leaf& leaf : leaves_) {
            cubeOf(leaf) = stored(leaf.nodes, leaf.box.size);
        }
    }

    const MeshQuery& query_;
    BrickGrid grid_;
    BrickVolume volume_;
    std::vector<SurfacePoint> samples_;
    std::vector<Leaf> leaves_;
    std::uint64_t bricks_ = 0;
};

BrickVolume::BrickVolume(const MeshQuery& query, const BrickLayout& layout, double root_size)
    : query_(&query), layout_(layout), root_size_(root_size) {
    const glm::dvec3 low = query.mesh().bounds.min;
    const glm::dvec3 size = glm::dvec3(query.mesh().bounds.max) - low;
    roots_count_ = glm::max(glm::ceil(size / root_size * (1.0 - 1e-12)), 1.0);
    origin_ = low + 0.5 * (size - root_size * glm::dvec3(roots_count_));
}

BrickVolume BrickVolume::withVoxels(const MeshQuery& query, const BrickLayout& layout, double voxel) {
    return BrickBuilder(query, layout, voxel * layout.cells).uniform();
}

BrickVolume BrickVolume::build(const MeshQuery& query, const BrickLayout& layout, std::uint64_t bytes) {
    const auto longest = static_cast<double>(query.mesh().bounds.longestSide());
    if (layout.octree) {
        // One root per 80 bytes, so that the index takes a twentieth of the bytes.
        const glm::dvec3 size = query.mesh().bounds.size();
        const auto roots = [&](double root) {
            const glm::dvec3 n = glm::ceil(size / root);
            return std::max(n.x, 1.0) * std::max(n.y, 1.0) * std::max(n.z, 1.0);
        };
        double root = longest;
        while (roots(root * 0.9) * 80.0 <= static_cast<double>(bytes)) {
            root *= 0.9;
        }
        return BrickBuilder(query, layout, root).octree(bytes);
    }
    // The number of bytes is inversely proportional to the square of the voxel size.
    double large = longest / layout.cells;
    double small = large;
    while (BrickBuilder(query, layout, small * layout.cells).uniformBytes() <= bytes &&
           small > 1e-6 * longest) {
        large = small;
        small *= 0.5;
    }
    for (int i = 0; i < 6; ++i) {
        const double middle = std::sqrt(small * large);
        (BrickBuilder(query, layout, middle * layout.cells).uniformBytes() <= bytes ? large : small) = middle;
    }
    BrickVolume best = withVoxels(query, layout, large);
    // Bricks with a single sign are not stored, which frees bytes for smaller voxels.
    for (int i = 0; i < 3 && best.bytes() < bytes - bytes / 64; ++i) {
        const double finer = best.voxel() * std::sqrt(static_cast<double>(best.bytes()) /
                                                      (static_cast<double>(bytes) * 0.997));
        BrickVolume next = withVoxels(query, layout, finer);
        if (next.bytes() > bytes) {
            break;
        }
        best = std::move(next);
    }
    return best;
}

std::size_t BrickVolume::nodesOfBrick() const {
    return BrickGrid{layout_.cells}.nodes();
}

double BrickVolume::voxel() const {
    return std::ldexp(root_size_ / layout_.cells, -static_cast<int>(levels_));
}

std::uint64_t BrickVolume::indexBytes(std::uint64_t bricks) const {
    const std::uint64_t roots = std::uint64_t{roots_count_.x} * roots_count_.y * roots_count_.z;
    // Two values are reserved for the signs.
    const auto width = [](std::uint64_t values) { return values + 2 <= 65536 ? 2U : 4U; };
    if (layout_.octree) {
        return (roots + cubes_.size()) * width(bricks + cubes_.size() / 8);
    }
    std::uint64_t least = roots * width(roots_.size());
    if (layout_.flat_index) {
        return least;
    }
    // Blocks of k³ cubes: the upper level stores the first brick of each, and the lower level stores offsets from it.
    for (std::uint64_t k = 2; k <= 8; ++k) {
        const glm::uvec3 upper = (roots_count_ + std::uint32_t(k - 1)) / std::uint32_t(k);
        std::vector<std::uint64_t> blocks;
        for (const Root& root : roots_) {
            const glm::uvec3 block = rootOf(root.cell) / std::uint32_t(k);
            blocks.push_back((std::uint64_t{block.z} * upper.y + block.y) * upper.x + block.x);
        }
        std::ranges::sort(blocks);
        blocks.erase(std::unique(blocks.begin(), blocks.end()), blocks.end());
        const std::uint64_t lower = k * k * k + 2 <= 256 ? 1 : 2;
        least = std::min(least,
                         std::uint64_t{upper.x} * upper.y * upper.z * 4 + blocks.size() * k * k * k * lower);
    }
    return least;
}

std::uint64_t BrickVolume::cellAt(const glm::dvec3& p) const {
    const glm::uvec3 at =
        glm::clamp(glm::floor((p - origin_) / root_size_), glm::dvec3(0.0), glm::dvec3(roots_count_) - 1.0);
    return (std::uint64_t{at.z} * roots_count_.y + at.y) * roots_count_.x + at.x;
}

glm::uvec3 BrickVolume::rootOf(std::uint64_t cell) const {
    const glm::uvec3& n = roots_count_;
    return {cell % n.x, cell / n.x % n.y, cell / n.x / n.y};
}

BrickVolume::Cube BrickVolume::cubeOf(std::uint64_t cell) const {
    const auto found = std::ranges::lower_bound(roots_, cell, {}, &Root::cell);
    return found != roots_.end() && found->cell == cell ? found->cube : Cube{};
}

FieldValue BrickVolume::clamped(bool inside, double cube_size) const {
    const double range = layout_.band * cube_size / layout_.cells;
    return {.distance = static_cast<float>(inside ? -range : range)};
}

FieldValue BrickVolume::inBrick(std::uint32_t brick, const glm::dvec3& in_voxels, double voxel) const {
    const BrickGrid grid{layout_.cells};
    const glm::uvec3 at = grid.voxelAt(in_voxels);
    const glm::dvec3 t = in_voxels - glm::dvec3(at);
    const std::array<double, 8> weights = weightsAt(t);
    double value = 0.0;
    glm::dvec3 gradient(0.0);
    for (unsigned i = 0; i < 8; ++i) {
        const double code = codes_[std::size_t{brick} * grid.nodes() + grid.corner(at, i)];
        value += weights[i] * code;
        for (int axis = 0; axis < 3; ++axis) {
            glm::dvec3 without = t;
            without[axis] = (i >> unsigned(axis) & 1U) != 0 ? 1.0 : 0.0;
            gradient[axis] += ((i >> unsigned(axis) & 1U) != 0 ? 1.0 : -1.0) * weightsAt(without)[i] * code;
        }
    }
    FieldValue result{.distance = static_cast<float>(value / kCodeMax * layout_.band * voxel)};
    const double length = glm::length(gradient);
    if (length > 0.0) {
        result.normal = gradient / length;
    }
    return result;
}

FieldValue BrickVolume::at(const glm::vec3& p) const {
    const Bounds& bounds = query_->mesh().bounds;
    const glm::dvec3 exact = p;
    const glm::dvec3 in_bounds = glm::clamp(exact, glm::dvec3(bounds.min), glm::dvec3(bounds.max));
    const std::uint64_t cell = cellAt(in_bounds);
    Box box{origin_ + root_size_ * glm::dvec3(rootOf(cell)), root_size_};
    Cube cube = cubeOf(cell);
    while (cube.kind == Kind::kSplit) {
        const unsigned octant = box.octantOf(in_bounds);
        cube = cubes_[cube.first + octant];
        box = box.octant(octant);
    }
    FieldValue value;
    if (cube.kind == Kind::kBrick) {
        const double voxel = box.size / layout_.cells;
        value = inBrick(cube.first, (in_bounds - box.low) / voxel, voxel);
    } else {
        value = clamped(cube.kind == Kind::kInside ||
                            (cube.kind == Kind::kTruth && query_->inside(glm::vec3(box.middle()))),
                        box.size);
    }
    const double beyond = glm::distance(exact, in_bounds);
    if (beyond > 0.0) {
        value.distance = std::max(value.distance, 0.0F) + static_cast<float>(beyond);
    }
    return value;
}

BrickAtlas BrickVolume::atlas() const {
    BrickAtlas atlas;
    atlas.box = query_->mesh().bounds;
    atlas.origin = origin_;
    atlas.cube_size = glm::vec3(static_cast<float>(root_size_));
    atlas.cubes = roots_count_;
    atlas.cells = glm::uvec3(layout_.cells);
    atlas.range = static_cast<float>(layout_.band * root_size_ / layout_.cells);
    atlas.bytes = bytes();
    atlas.codes.assign(codes_.begin(), codes_.end());
    atlas.index.resize(std::size_t{roots_count_.x} * roots_count_.y * roots_count_.z);
    forEachIndex(0, atlas.index.size(), 256, [&](std::size_t cell) {
        const Cube cube = cubeOf(cell);
        const bool inside =
            cube.kind == Kind::kTruth
                ? query_->inside(glm::vec3(origin_ + root_size_ * (glm::dvec3(rootOf(cell)) + 0.5)))
                : cube.kind == Kind::kInside;
        atlas.index[cell] = cube.kind == Kind::kBrick ? BrickAtlas::kFirstBrick + cube.first
                            : inside                  ? BrickAtlas::kInside
                                                      : BrickAtlas::kOutside;
    });
    return atlas;
}

std::string BrickVolume::text() const {
    const std::string n = std::to_string(layout_.cells);
    return std::to_string(bricks()) + " bricks of " + n + "x" + n + "x" + n +
           (layout_.octree ? " in an octree" : "") + (layout_.fitted ? ", fitted" : "");
}

Field fieldOf(const BrickVolume& volume) {
    return [&volume](const glm::vec3& p) -> std::optional<FieldValue> { return volume.at(p); };
}

}  // namespace relief

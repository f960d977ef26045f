// SPDX-License-Identifier: Apache-2.0
#include "runtime/births/collider_surface.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <glm/glm.hpp>
#include <iterator>
#include <limits>
#include <string>
#include <utility>

#include "formats/animation/mesh_parts.h"
#include "formats/base/finite.h"

namespace relief {
namespace {

/// Bisections of an edge, to 1/65536 of its length: finer than the maps.
constexpr int kHalvings = 16;
/// Weight of the mean crossing relative to the planes: large enough that nearly parallel planes do not move the vertex
/// far away.
constexpr double kMeanWeight = 0.01;
constexpr std::uint32_t kNone = std::numeric_limits<std::uint32_t>::max();

/// Sums over the planes at the crossings of a cell.
struct Planes {
    glm::dmat3 squares{0.0};  // Σ n nᵀ
    glm::dvec3 right{0.0};    // Σ n (n · p)
    glm::dvec3 sum{0.0};      // Σ p
    double count = 0.0;

    void add(const glm::dvec3& p, const glm::dvec3& n) {
        squares += glm::outerProduct(n, n);
        right += n * glm::dot(n, p);
        sum += p;
        count += 1.0;
    }
    /// Returns the point that fits all planes best and, within the remaining freedom, is nearest to the mean.
    [[nodiscard]] glm::dvec3 meeting() const {
        const glm::dvec3 mean = sum / count;
        const glm::dmat3 system = squares + kMeanWeight * glm::dmat3(1.0);
        return mean + glm::inverse(system) * (right - squares * mean);
    }
};

class Contour {
  public:
    Contour(const Collider& collider, std::uint32_t cells) : collider_(collider) {
        const glm::dvec3 size(collider.bounds.size());
        cell_ = std::max({size.x, size.y, size.z}) / cells;
        // One extra cell beyond the bounds on each side, so that the surface closes around parts that reach the bounds.
        for (int k = 0; k < 3; ++k) {
            count_[k] = std::max(1, static_cast<int>(std::ceil(size[k] / cell_ - 1e-6))) + 2;
        }
        low_ = glm::dvec3(collider.bounds.min) + 0.5 * size - 0.5 * cell_ * glm::dvec3(count_);
    }

    ColliderSurface run() {
        inside_.resize(corners());
        for (int z = 0; z <= count_.z; ++z) {
            for (int y = 0; y <= count_.y; ++y) {
                for (int x = 0; x <= count_.x; ++x) {
                    inside_[corner({x, y, z})] = isInside(cornerAt({x, y, z})) ? 1 : 0;
                }
            }
        }
        planes_.assign(corners(), kNone);
        eachCrossing([this](const glm::ivec3& at, int axis) { cross(at, axis); });
        place();
        eachCrossing([this](const glm::ivec3& at, int axis) { face(at, axis); });
        return std::move(out_);
    }

  private:
    [[nodiscard]] std::size_t corners() const { return corner(count_) + 1; }
    /// Returns the index of a corner; a cell has the index of its lowest corner.
    [[nodiscard]] std::size_t corner(const glm::ivec3& at) const {
        const auto wide = static_cast<std::size_t>(count_.x) + 1;
        const auto high = static_cast<std::size_t>(count_.y) + 1;
        return (static_cast<std::size_t>(at.z) * high + static_cast<std::size_t>(at.y)) * wide +
               static_cast<std::size_t>(at.x);
    }
    [[nodiscard]] glm::dvec3 cornerAt(const glm::ivec3& at) const { return low_ + cell_ * glm::dvec3(at); }
    [[nodiscard]] bool isInside(const glm::dvec3& p) const {
        return evaluateInside(collider_, glm::vec3(p)).inside;
    }

    /// Calls f(corner, axis) for each grid edge whose ends are on different sides, in the order of the corners.
    template <class F>
    void eachCrossing(const F& f) const {
        for (int z = 0; z <= count_.z; ++z) {
            for (int y = 0; y <= count_.y; ++y) {
                for (int x = 0; x <= count_.x; ++x) {
                    for (int axis = 0; axis < 3; ++axis) {
                        const glm::ivec3 at(x, y, z);
                        glm::ivec3 end = at;
                        ++end[axis];
                        if (end[axis] <= count_[axis] && inside_[corner(at)] != inside_[corner(end)]) {
                            f(at, axis);
                        }
                    }
                }
            }
        }
    }

    /// Returns the four cells around an edge, counter-clockwise seen along its axis; false at the boundary of the grid.
    [[nodiscard]] bool cellsAround(const glm::ivec3& at, int axis, std::array<glm::ivec3, 4>& cells) const {
        const int u = (axis + 1) % 3;
        const int v = (axis + 2) % 3;
        constexpr std::array<std::array<int, 2>, 4> kAround{{{-1, -1}, {0, -1}, {0, 0}, {-1, 0}}};
        for (std::size_t i = 0; i < 4; ++i) {
            cells.at(i) = at;
            cells.at(i)[u] += kAround.at(i)[0];
            cells.at(i)[v] += kAround.at(i)[1];
            if (std::min(cells.at(i)[u], cells.at(i)[v]) < 0 || cells.at(i)[u] >= count_[u] ||
                cells.at(i)[v] >= count_[v]) {
                return false;
            }
        }
        return true;
    }

    void cross(const glm::ivec3& at, int axis) {
        std::array<glm::ivec3, 4> cells;
        if (!cellsAround(at, axis, cells)) {
            return;
        }
        glm::dvec3 in = cornerAt(at);
        glm::dvec3 out = in;
        out[axis] += cell_;
        if (inside_[corner(at)] == 0) {
            std::swap(in, out);
        }
        for (int i = 0; i < kHalvings; ++i) {
            const glm::dvec3 middle = 0.5 * (in + out);
            (isInside(middle) ? in : out) = middle;
        }
        const glm::vec3 normal = evaluateInside(collider_, glm::vec3(in)).normal;
        for (const glm::ivec3& cell : cells) {
            std::uint32_t& own = planes_[corner(cell)];
            if (own == kNone) {
                own = static_cast<std::uint32_t>(list_.size());
                list_.emplace_back();
                cells_.push_back(cell);
            }
            list_[own].add(0.5 * (in + out), glm::dvec3(normal));
        }
    }

    void place() {
        for (std::size_t i = 0; i < list_.size(); ++i) {
            // Planes of different parts may intersect outside the cell, where it has no surface.
            const glm::dvec3 low = cornerAt(cells_[i]);
            out_.positions.emplace_back(glm::clamp(list_[i].meeting(), low, low + cell_));
        }
    }

    void face(const glm::ivec3& at, int axis) {
        std::array<glm::ivec3, 4> cells;
        if (!cellsAround(at, axis, cells)) {
            return;
        }
        std::array<std::uint32_t, 4> v{};
        for (std::size_t i = 0; i < 4; ++i) {
            v.at(i) = planes_[corner(cells.at(i))];
        }
        if (inside_[corner(at)] == 0) {
            std::swap(v[1], v[3]);  // the outside lies in the negative direction of the axis
        }
        // Split along the shorter diagonal, so that edges of the surface are not bridged.
        const auto& p = out_.positions;
        const auto squaredLength = [&](std::uint32_t a, std::uint32_t b) {
            return glm::dot(p[a] - p[b], p[a] - p[b]);
        };
        if (squaredLength(v[0], v[2]) <= squaredLength(v[1], v[3])) {
            out_.triangles.emplace_back(v[0], v[1], v[2]);
            out_.triangles.emplace_back(v[0], v[2], v[3]);
        } else {
            out_.triangles.emplace_back(v[1], v[2], v[3]);
            out_.triangles.emplace_back(v[1], v[3], v[0]);
        }
    }

    const Collider& collider_;
    double cell_ = 0.0;
    glm::ivec3 count_{0};  // cells
    glm::dvec3 low_{0.0};
    std::vector<char> inside_;           // for each corner
    std::vector<std::uint32_t> planes_;  // for each cell, by its lowest corner: index into list_ and cells_
    std::vector<Planes> list_;
    std::vector<glm::ivec3> cells_;
    ColliderSurface out_;
};

}  // namespace

Result<ColliderSurface> colliderSurface(const Collider& collider, std::uint32_t cells) {
    if (cells < 2 || cells > kSurfaceCellsMax) {
        return fail(ErrorCode::kUsage, "a surface needs 2 to " + std::to_string(kSurfaceCellsMax) +
                                           " cells along the longest side, not " + std::to_string(cells));
    }
    const float longest = collider.bounds.longestSide();
    if (!isFinite(collider.bounds.min) || !isFinite(collider.bounds.max) || !(longest > 0.0F) ||
        !std::isfinite(longest)) {
        return invalidInput("its bounds have no extent; bake the mesh again");
    }
    ColliderSurface made = Contour(collider, cells).run();
    if (made.triangles.empty()) {
        return invalidInput("no surface found: every part is thinner than 1/" + std::to_string(cells) +
                            " of the collider's longest side; set emitter.mesh to its source mesh");
    }
    return made;
}

Result<std::vector<glm::uvec3>> materialTriangles(const ColliderSurface& surface, const Materials& materials,
                                                  std::string_view name) {
    std::vector<std::string> names;
    std::transform(materials.list.begin(), materials.list.end(), std::back_inserter(names),
                   [](const Material& one) { return one.name; });
    const auto found = std::find(names.begin(), names.end(), name);
    if (name.empty() || found == names.end()) {
        return invalidInput(partNotFound("material", name, names));
    }
    const auto material = static_cast<std::size_t>(found - names.begin());
    std::vector<glm::uvec3> kept;
    for (const glm::uvec3& t : surface.triangles) {
        const glm::vec3& a = surface.positions[t.x];
        const glm::vec3& b = surface.positions[t.y];
        const glm::vec3& c = surface.positions[t.z];
        if (materialAt(materials, (a + b + c) / 3.0F, glm::cross(b - a, c - a)) == material) {
            kept.push_back(t);
        }
    }
    return kept;
}

}  // namespace relief

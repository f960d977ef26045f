// SPDX-License-Identifier: Apache-2.0
#include "bake/images/view_image.h"

#include <tbb/parallel_for.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <new>
#include <optional>

#include "bake/images/axis_grid.h"
#include "formats/patch_tree.h"

namespace relief {
namespace {

constexpr float kInfinity = std::numeric_limits<float>::infinity();
constexpr int kHalvings = 10;
constexpr double kStepsPerCell = 64.0;
constexpr double kStepsPerPair = 4.0;
constexpr double kStepsPerTexel = 8.0;
constexpr double kTexelsMin = 64.0;  // minimum number of texels per ray, for coarse maps
constexpr double kStepsMax = 16384.0;

struct Hit {
    float at = kInfinity;  ///< coordinate along the axis
    glm::vec3 normal{0.0F};
};

class Rays {
  public:
    Rays(const Collider& collider, const Bounds& box, int axis, double sign)
        : collider_(collider),
          axis_(axis),
          sign_(sign),
          from_(sign > 0.0 ? box.min[axis] : box.max[axis]),
          length_(double{box.max[axis]} - double{box.min[axis]}),
          texel_(std::min(double{finestTexel(collider)}, length_ / kTexelsMin)),
          least_(std::max(texel_ / kStepsPerTexel, length_ / kStepsMax)) {}

    /// \param p  its coordinate along the axis is ignored.
    [[nodiscard]] std::optional<Hit> first(const glm::vec3& p) const {
        double outer = 0.0;
        for (double t = 0.0;;) {
            const Reach reach = reachAt(place(p, t));
            double step = reach.end;
            if (!reach.outside) {
                const FieldSample sample = evaluate(collider_, place(p, t));
                if (sample.inside()) {
                    return between(p, outer, t);
                }
                if (sample.map >= 0) {
                    step = std::min(step, std::max(double{sample.distance}, reach.least));
                }
            }
            if (t >= length_) {
                return std::nullopt;
            }
            outer = std::min(reach.outside ? t + reach.end : t, length_);
            t = std::min(t + step + least_, length_);
        }
    }

  private:
    /// The length that a ray may advance from a point, object units.
    struct Reach {
        double end = std::numeric_limits<double>::max();  ///< to the end of the point's cells and squares
        double least = 0.0;                               ///< minimum step
        bool outside = false;                             ///< no point before `end` is inside
        bool in_tree = false;
    };

    [[nodiscard]] glm::vec3 place(glm::vec3 p, double t) const {
        p[axis_] = static_cast<float>(from_ + sign_ * t);
        return p;
    }

    /// A cell without a patch is entirely on one side. One map that classifies a point as outside decides the vote.
    [[nodiscard]] Reach reachAt(const glm::vec3& p) const {
        Reach reach;
        if (collider_.maps.size() > 1) {
            reach.end = texel_;  // the combined vote of several maps may change sign anywhere
        }
        for (const DepthMap& map : collider_.maps) {
            const std::optional<PatchLeaf> leaf = leafAt(map, p);
            if (!leaf) {
                reach.end = std::min(reach.end, texel_);
                continue;
            }
            const double length = double{leaf->cell} * double{map.object_per_map.x};
            glm::dvec3 way(0.0);  // one cell length along the ray, in cells
            for (int i = 0; i < 3; ++i) {
                way[i] = sign_ * double{map.object_to_map.row[i][axis_]} * double{map.object_per_map.x};
            }
            const glm::dvec3 at = leaf->in_cell;
            if (leaf->record.kind() == PatchRecord::Kind::kPatch) {
                const bool pair = leaf->record.isPair();
                for (std::uint32_t k = 0; k < (pair ? 2U : 1U); ++k) {
                    const PatchRecord patch =
                        pair ? patchTexel(map.texels, leaf->record.first() + k) : leaf->record;
                    if (patch.side() > 2) {
                        const PatchFrame frame = patch.frame();
                        const double squares = patch.side() - 1.0;
                        const glm::dvec3 from = frame.across(at);
                        reach.end = std::min(
                            reach.end,
                            length * toBorder(squares * from, squares * (frame.across(at + way) - from), 2));
                    }
                }
                // Within a square, no surface on the ray is closer than the field's distance.
                reach.end = pair ? std::min(reach.end, length / kStepsPerPair) : reach.end;
                reach.least = length / kStepsPerCell;
            }
            // The cell of a child without a record is an octant of the record's cell.
            const double parts = leaf->beside ? 2.0 : 1.0;
            const double end = length * toBorder(parts * at, parts * way, 3);
            if (!leaf->inside && leaf->record.kind() != PatchRecord::Kind::kPatch) {
                return {end, 0.0, true, true};
            }
            reach.end = std::min(reach.end, end);
            reach.in_tree = true;
        }
        return reach;
    }

    /// Returns the parameter at which the first of several coordinates reaches the next integer.
    [[nodiscard]] static double toBorder(const glm::dvec3& at, const glm::dvec3& speed, int coordinates) {
        double time = std::numeric_limits<double>::max();
        for (int i = 0; i < coordinates; ++i) {
            if (speed[i] != 0.0) {
                const double border = std::floor(at[i]) + (speed[i] > 0.0 ? 1.0 : 0.0);
                time = std::min(time, (border - at[i]) / speed[i]);
            }
        }
        return time;
    }

    [[nodiscard]] static std::optional<PatchLeaf> leafAt(const DepthMap& map, const glm::vec3& p) {
        if (map.projection() != Projection::kLocal) {
            return std::nullopt;
        }
        const glm::vec3 in_map = map.object_to_map.apply(p);
        const glm::vec3 roots(patchTreeSize(map.texels).roots);
        for (int i = 0; i < 3; ++i) {
            if (!(in_map[i] >= 0.0F && in_map[i] < roots[i])) {
                return std::nullopt;
            }
        }
        return patchLeafAt(map.texels, in_map);
    }

    /// Bisects for the surface. \param outer  no point before it is inside. \param inner  its point is inside.
    [[nodiscard]] Hit between(const glm::vec3& p, double outer, double inner) const {
        for (int i = 0; i < kHalvings && outer < inner; ++i) {
            const double middle = 0.5 * (outer + inner);
            (evaluate(collider_, place(p, middle)).inside() ? inner : outer) = middle;
        }
        const glm::vec3 at = place(p, inner);
        Hit hit{at[axis_], evaluate(collider_, at).normal};
        if (inner == 0.0 || !reachAt(place(p, outer)).in_tree) {
            hit.normal = glm::vec3(0.0F);
            hit.normal[axis_] = static_cast<float>(-sign_);
        }
        return hit;
    }

    const Collider& collider_;
    int axis_;
    double sign_;
    double from_;
    double length_;
    double texel_;
    double least_;  ///< minimum step
};

Result<ExrImage> drawView(const Collider& collider, int view, std::uint32_t size) {
    const AxisGrid grid = RELIEF_TRY(gridAcross(collider.bounds, view, size, 0.0));
    const Bounds box = solidBox(collider);
    const int axis = grid.axis();
    if (!std::isfinite(box.min[axis]) || !std::isfinite(box.max[axis])) {
        return invalidInput("the collider's maps are too large for floats; bake it again");
    }
    const double near = grid.sign() > 0.0 ? collider.bounds.min[axis] : collider.bounds.max[axis];
    ExrImage image =
        grid.image(near, collider, {"depth.front", "depth.back", "normal.X", "normal.Y", "normal.Z"});
    image.attributes.emplace_back(
        "relief.depth", "object units along the view from the near face of the bounds; +inf: no surface");
    image.attributes.emplace_back("relief.normal",
                                  "unit normal in object space, outwards, at depth.front; zero: no surface");
    const Rays forwards(collider, box, axis, grid.sign());
    const Rays backwards(collider, box, axis, -grid.sign());
    tbb::parallel_for(std::uint32_t{0}, grid.height, [&](std::uint32_t y) {
        for (std::uint32_t x = 0; x < grid.width; ++x) {
            const glm::vec3 p = grid.point(x, y, 0.0F);
            const Hit none;
            const std::optional<Hit> front = forwards.first(p);
            const Hit last = front ? backwards.first(p).value_or(*front) : none;
            const auto depth = [&](const Hit& hit) {
                return static_cast<float>(grid.sign() * (double{hit.at} - near));
            };
            const glm::vec3 normal = front ? front->normal : glm::vec3(0.0F);
            const float values[] = {front ? depth(*front) : kInfinity, front ? depth(last) : kInfinity,
                                    normal.x, normal.y, normal.z};
            for (std::size_t i = 0; i < image.channels.size(); ++i) {
                image.channels[i].values[grid.pixel(x, y)] = values[i];
            }
        }
    });
    return image;
}

}  // namespace

std::string viewImageName(int view) {
    return std::string("view_") + kDirectionNames[static_cast<std::size_t>(view)] + ".exr";
}

Result<ExrImage> viewImage(const Collider& collider, int view, std::uint32_t size) {
    try {
        return drawView(collider, view, size);
    } catch (const std::bad_alloc&) {
        return fail(ErrorCode::kLimit, "out of memory while drawing a view; lower --resolution");
    }
}

}  // namespace relief

// SPDX-License-Identifier: Apache-2.0
#include "bake/views/view.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

#include "bake/mesh/mesh_query.h"
#include "formats/base/finite.h"
#include "formats/patch_tree.h"

namespace relief {
namespace {

/// Free space on each side of a tight box, in units of the mesh's longest side. It exceeds 6.1e-5, the smallest normal
/// half float, so that all formats can store the depths of the surface.
constexpr double kPadding = 1e-4;
/// Minimum extent of a tight box, in the same units, for flat meshes.
constexpr double kExtentMin = 1e-2;

glm::dvec3 normalized(const glm::dvec3& v) {
    // Divide by the largest component first: squares of small floats would vanish.
    const double largest = std::max({std::abs(v.x), std::abs(v.y), std::abs(v.z)});
    return unit(v / largest);
}

/// Right, up and view direction.
std::array<glm::dvec3, 3> orthographicFrame(const glm::vec3& direction, const std::optional<glm::vec3>& up) {
    const glm::dvec3 d = normalized(direction);
    const glm::dvec3 right = normalized(cross(d, up ? normalized(*up) : defaultUp(d)));
    return {right, cross(right, d), d};
}

std::array<Range, 3> projectedRanges(const Bounds& box, const std::array<glm::dvec3, 3>& frame) {
    std::array<Range, 3> ranges;
    for (unsigned corner = 0; corner < 8; ++corner) {
        const glm::dvec3 p = box.corner(corner);
        for (std::size_t i = 0; i < 3; ++i) {
            ranges[i].add(dot(frame[i], p));
        }
    }
    return ranges;
}

std::array<Range, 3> projectedRanges(const TriangleMesh& mesh, const std::array<glm::dvec3, 3>& frame) {
    // If the axes are parallel to those of object space, the bounds are exact.
    if (frame[0].x * frame[0].y == 0.0 && frame[0].y * frame[0].z == 0.0 && frame[0].z * frame[0].x == 0.0 &&
        std::abs(frame[2].x) + std::abs(frame[2].y) + std::abs(frame[2].z) == 1.0) {
        return projectedRanges(mesh.bounds, frame);
    }
    std::array<Range, 3> ranges;
    for (const glm::vec3& p : mesh.positions) {
        for (std::size_t i = 0; i < 3; ++i) {
            ranges[i].add(dot(frame[i], p));
        }
    }
    return ranges;
}

/// Returns the free space on each side of a tight volume along an axis. \param extent  of the mesh along it.
double padding(const Bounds& bounds, double extent) {
    const auto longest = static_cast<double>(bounds.longestSide());
    // More free space far from the origin, where floats are coarse.
    const double rounding = 8.0 * double{std::numeric_limits<float>::epsilon()} * double{bounds.farthest()};
    return std::max(kPadding * longest + rounding, 0.5 * (kExtentMin * longest - extent));
}

/// A row of an affine transform: (dot(p, direction) − offset) · scale. −0 becomes 0.
glm::vec4 affineRow(const glm::dvec3& direction, double offset, double scale) {
    return {static_cast<float>(direction.x * scale + 0.0), static_cast<float>(direction.y * scale + 0.0),
            static_cast<float>(direction.z * scale + 0.0), static_cast<float>(-offset * scale + 0.0)};
}

void placeOrthographic(View& view, const MapSpec& spec, const TriangleMesh& mesh) {
    const std::array<glm::dvec3, 3> frame = orthographicFrame(spec.direction, spec.up);
    const std::array<Range, 3> of_mesh = projectedRanges(mesh, frame);
    std::array<Range, 3> volume;
    if (spec.box) {
        volume = projectedRanges(*spec.box, frame);
    } else {
        for (std::size_t i = 0; i < 3; ++i) {
            volume[i] = of_mesh[i].padded(padding(mesh.bounds, of_mesh[i].size()));
        }
    }
    view.encloses = true;
    for (std::size_t i = 0; i < 3; ++i) {
        view.encloses = view.encloses && volume[i].holds(of_mesh[i], kDepthSlack * volume[i].size());
    }
    const double slack = kDepthSlack * volume[2].size();
    view.starts_free[0] = volume[2].min - slack <= of_mesh[2].min;
    view.starts_free[1] = of_mesh[2].max <= volume[2].max + slack;

    // The range of the texture: the volume plus a texel on each side.
    const double inner[2] = {static_cast<double>(view.width - 2), static_cast<double>(view.height - 2)};
    volume[0] = volume[0].padded(volume[0].size() / inner[0]);
    volume[1] = volume[1].padded(volume[1].size() / inner[1]);
    view.origin = glm::dvec3(0.0);
    for (int i = 0; i < 3; ++i) {
        const Range& range = volume[static_cast<std::size_t>(i)];
        const glm::dvec3& along = frame[static_cast<std::size_t>(i)];
        view.origin += range.min * along;
        view.axis[i] = range.size() * along;
        view.object_to_map.row[i] = affineRow(along, range.min, 1.0 / range.size());
        view.object_per_map[i] = static_cast<float>(range.size());
    }
}

void placeCube(View& view, const MapSpec& spec, const TriangleMesh& mesh) {
    const glm::dvec3 center = spec.box ? 0.5 * glm::dvec3(spec.box->min) + 0.5 * glm::dvec3(spec.box->max)
                                       : glm::dvec3(*spec.center);
    view.origin = center;
    view.encloses = true;
    for (int i = 0; i < 3; ++i) {
        const double reach =
            std::max(std::abs(mesh.bounds.max[i] - center[i]), std::abs(mesh.bounds.min[i] - center[i]));
        const double half = spec.box ? 0.5 * (double{spec.box->max[i]} - spec.box->min[i])
                                     : reach + padding(mesh.bounds, 2.0 * reach);
        view.encloses = view.encloses && reach <= half * (1.0 + kDepthSlack);
        glm::dvec3 along(0.0);
        along[i] = 1.0;
        view.axis[i] = half * along;
        view.object_to_map.row[i] = affineRow(along, center[i], 1.0 / half);
        view.object_per_map[i] = static_cast<float>(half);
    }
    // kLess is for a centre in free space; kGreater looks inwards from the surface of the volume.
    view.starts_free[0] = true;
    view.starts_free[1] = view.encloses;
}

}  // namespace

bool View::emptyIsOutside() const {
    return (keeps(RayEnd::kNear) && starts_free[0]) || (keeps(RayEnd::kFar) && starts_free[1]);
}

namespace {

/// Position of a texel's centre, as a fraction of `count` texels.
double centreOf(std::uint32_t texel, std::uint32_t count) {
    return (static_cast<double>(texel) + 0.5) / static_cast<double>(count);
}

}  // namespace

glm::dvec3 View::columnOffset(std::uint32_t x) const {
    return centreOf(x, width) * axis[0];
}

glm::dvec3 View::rowOffset(std::uint32_t y) const {
    return centreOf(y, height) * axis[1];
}

TexelRay View::ray(std::uint32_t face, std::uint32_t x, std::uint32_t y) const {
    if (projection() == Projection::kOrthographic) {
        return {origin + (columnOffset(x) + rowOffset(y)), axis[2]};
    }
    const double s = centreOf(x, width);
    const double t = centreOf(y, height);
    // cubeDirection() of depth_map.h in double precision.
    const double sc = 2.0 * s - 1.0;
    const double tc = 2.0 * t - 1.0;
    const glm::dvec3 toward = std::array<glm::dvec3, 6>{{{1.0, -tc, -sc},
                                                         {-1.0, -tc, sc},
                                                         {sc, 1.0, tc},
                                                         {sc, -1.0, -tc},
                                                         {sc, -tc, 1.0},
                                                         {-sc, -tc, -1.0}}}[face];
    const glm::dvec3 d = unit(toward);
    return {origin, {d.x * axis[0].x, d.y * axis[1].y, d.z * axis[2].z}};
}

double View::depthMax(const TexelRay& ray) const {
    if (projection() == Projection::kOrthographic) {
        return 1.0;
    }
    if (compare == Compare::kLess) {
        return double{kCubeDepthMax};
    }
    const glm::dvec3& d = ray.direction;
    return 1.0 / std::max({std::abs(d.x) / axis[0].x, std::abs(d.y) / axis[1].y, std::abs(d.z) / axis[2].z});
}

DepthMap View::emptyMap() const {
    DepthMap map;
    map.format = format;
    map.compare = compare;
    map.width = width;
    map.height = height;
    map.object_to_map = object_to_map;
    map.object_per_map = object_per_map;
    map.encloses = encloses;
    map.empty_is_outside = emptyIsOutside();
    map.texels.resize(map.texelBytes());
    return map;
}

glm::dvec3 defaultUp(const glm::dvec3& direction) {
    const bool steep = std::abs(direction.y) > 0.999;
    return steep ? glm::dvec3(0.0, 0.0, direction.y > 0.0 ? 1.0 : -1.0) : glm::dvec3(0.0, 1.0, 0.0);
}

Result<MapSpec> completeSpec(MapSpec spec, const PreparedMesh& mesh, std::uint32_t resolution) {
    if (spec.format == MapFormat::kPatches) {
        spec.bytes = spec.bytes > 0 || spec.texel > 0.0F ? spec.bytes : kPatchBytesDefault;
        return spec;
    }
    const bool cube = spec.format == MapFormat::kCube8;
    // −0 becomes 0, so that equal settings have equal texts.
    spec.direction += 0.0F;
    if (spec.up) {
        *spec.up += 0.0F;
    }
    if (spec.center) {
        *spec.center += 0.0F;
    }
    if (spec.box) {
        spec.box->min += 0.0F;
        spec.box->max += 0.0F;
    }
    if (spec.width == 0) {
        spec.width = resolution;
    }
    if (spec.height == 0) {
        spec.height = cube ? spec.width : resolution;
    }
    for (const std::uint32_t side : {spec.width, spec.height}) {
        static_cast<void>(RELIEF_TRY(checkMapSize(side, spec.format, "size of a map")));
    }
    if (cube && !spec.center && !spec.box) {
        spec.center = mesh->bounds.center();
    }
    if (!isFrontBack(spec.format) && !spec.compare) {
        spec.compare = Compare::kLess;
        if (cube) {
            const MeshQuery query = RELIEF_TRY(MeshQuery::build(mesh));
            const bool outwards = query.inside(spec.center ? *spec.center : spec.box->center());
            spec.compare = outwards ? Compare::kGreater : Compare::kLess;
        }
    }
    return spec;
}

Result<View> makeView(const MapSpec& spec, const TriangleMesh& mesh) {
    RELIEF_TRY(withPrefix("--map '" + toString(spec) + "'", checkUp(spec)));
    View view;
    view.format = spec.format;
    if (spec.format == MapFormat::kPatches) {
        // An upper bound if `texel` is set.
        view.width = static_cast<std::uint32_t>((spec.bytes > 0 ? spec.bytes : kPatchBytesMax) /
                                                texelSize(spec.format));
        view.height = 1;
        return view;
    }
    view.compare = spec.compare.value_or(Compare::kBoth);
    view.width = spec.width;
    view.height = spec.height;
    if (view.projection() == Projection::kCube) {
        placeCube(view, spec, mesh);
    } else {
        placeOrthographic(view, spec, mesh);
    }
    const glm::vec3& units = view.object_per_map;
    if (!view.object_to_map.isFinite() || !isFinite(units) ||
        !(std::min({units.x, units.y, units.z}) > 0.0F)) {
        return fail(ErrorCode::kUsage,
                    "--map '" + toString(spec) +
                        "': the volume is too small or too large for floats; change box or center");
    }
    return view;
}

}  // namespace relief

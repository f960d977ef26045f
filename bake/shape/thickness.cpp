// SPDX-License-Identifier: Apache-2.0
#include "bake/shape/thickness.h"

#include <algorithm>
#include <cmath>

#include "formats/base/text.h"

namespace relief {
namespace {

constexpr double kShellLeast = 0.004;
constexpr double kShellMost = 0.25;
constexpr double kShellRight = 0.1;
constexpr double kThicknessMin = 1e-4;
/// Resolution of floats at the far end of a mesh's box, in units of its longest side.
constexpr double kThicknessFloat = 4e-6;

}  // namespace

double defaultThickness(const Bounds& bounds, std::uint64_t budget_bytes) {
    const glm::dvec3 size = bounds.size();
    // Front-back maps along the axes at eight bytes per texel, plus half as many other maps.
    const double area = 12.0 * (size.x * size.y + size.y * size.z + size.z * size.x);
    const double texel = std::sqrt(area / static_cast<double>(std::max<std::uint64_t>(budget_bytes, 1)));
    return thicknessOfTexel(bounds, texel);
}

double thicknessOfTexel(const Bounds& bounds, double texel) {
    // Rounded to a float, which containers store exactly.
    return double{static_cast<float>(std::min(1.5 * texel, 0.04 * double{bounds.longestSide()}))};
}

double partThickness(double default_thickness, double part_size, bool by_texel) {
    return std::clamp(default_thickness, (by_texel ? kThicknessMin : kShellLeast) * part_size,
                      kShellMost * part_size);
}

double rightThickness(double thickness, double part_size) {
    return std::min(thickness, kShellRight * part_size);
}

Result<void> checkShellThickness(double thickness, double smallest_sheet, const TriangleMesh& mesh) {
    const double least =
        std::max(kThicknessMin * smallest_sheet, kThicknessFloat * double{mesh.bounds.longestSide()});
    if (thickness >= least) {
        return {};
    }
    return fail(ErrorCode::kUsage, "--thickness is " + shortest(static_cast<float>(thickness)) +
                                       " but a shell of " + mesh.name + " must be at least " +
                                       shortest(static_cast<float>(least)) +
                                       " thick; increase it, or bake the small parts separately");
}

}  // namespace relief

// SPDX-License-Identifier: Apache-2.0
#include "runtime/births/emitter_surface.h"

#include <algorithm>
#include <cmath>
#include <glm/geometric.hpp>
#include <string>
#include <utility>

#include "formats/base/finite.h"

namespace relief {
namespace {

/// Returns twice the area, along the normal. Uses doubles to avoid overflow and underflow of squares.
glm::dvec3 crossOf(const glm::vec3& a, const glm::vec3& b, const glm::vec3& c) {
    const glm::dvec3 p(a);
    return glm::cross(glm::dvec3(b) - p, glm::dvec3(c) - p);
}

/// Returns a uniform number in [0, 1): a multiple of 2^-53.
double fineUniform(Pcg32& random) {
    const std::uint64_t high = random.next() >> 5;
    const std::uint64_t low = random.next() >> 6;
    return static_cast<double>(high << 26 | low) * 0x1p-53;
}

}  // namespace

Result<EmitterSurface> EmitterSurface::create(std::span<const glm::uvec3> triangles,
                                              std::vector<float> weights, std::vector<glm::vec3> positions) {
    if (!weights.empty() && weights.size() != positions.size()) {
        return fail(ErrorCode::kUsage, "a surface needs one weight per position, or none");
    }
    if (!std::all_of(weights.begin(), weights.end(),
                     [](float weight) { return weight >= 0.0F && std::isfinite(weight); })) {
        return fail(ErrorCode::kUsage, "the weights of a surface must be finite and at least 0");
    }
    EmitterSurface made;
    for (const glm::uvec3& t : triangles) {
        if (std::max({t.x, t.y, t.z}) >= positions.size()) {
            return fail(ErrorCode::kUsage, "a triangle of a surface uses a vertex that does not exist");
        }
        if (weights.empty() || weights[t.x] + weights[t.y] + weights[t.z] > 0.0F) {
            made.triangles_.push_back(t);
        }
    }
    if (made.triangles_.size() > kTrianglesMax) {
        return fail(ErrorCode::kLimit, "it has more than " + std::to_string(kTrianglesMax) +
                                           " emitting triangles; simplify the mesh");
    }
    made.weights_ = std::move(weights);
    made.end_ = std::move(positions);
    made.weigh();
    if (!(made.area() > 0.0)) {
        return invalidInput("its surface has no area; choose another one");
    }
    return made;
}

void EmitterSurface::move(std::span<const glm::vec3> before, std::span<const glm::vec3> now, double seconds) {
    seconds_ = seconds;
    begin_.clear();
    if (seconds > 0.0) {
        begin_.assign(before.begin(), before.end());
    }
    end_.assign(now.begin(), now.end());
    weigh();
}

void EmitterSurface::weigh() {
    upto_.resize(triangles_.size());
    double sum = 0.0;
    for (std::size_t i = 0; i < triangles_.size(); ++i) {
        const glm::uvec3& t = triangles_[i];
        const glm::dvec3 across = crossOf(end_[t.x], end_[t.y], end_[t.z]);
        double area = 0.5 * std::sqrt(glm::dot(across, across));
        if (!weights_.empty()) {
            area *= (double{weights_[t.x]} + double{weights_[t.y]} + double{weights_[t.z]}) / 3.0;
        }
        sum += std::isfinite(area) ? area : 0.0;
        upto_[i] = sum;
    }
}

Bounds EmitterSurface::bounds() const {
    Bounds box;
    for (const glm::vec3& p : end_) {
        box.add(p);
    }
    return box;
}

/// Samples barycentric coordinates. Spacings of sorted uniform numbers are uniform on a simplex. A linear density on a
/// triangle is a mixture of three densities, each proportional to the coordinate of one corner. The function therefore
/// draws a corner first; the coordinate of this corner is the sum of two spacings of three numbers.
glm::vec3 EmitterSurface::sampleBarycentric(Pcg32& random, const glm::uvec3& triangle) const {
    float cuts[3]{};
    if (weights_.empty()) {
        cuts[0] = random.uniform();
        cuts[1] = random.uniform();
        std::sort(cuts, cuts + 2);
        return {cuts[0], cuts[1] - cuts[0], 1.0F - cuts[1]};
    }
    const double a{weights_[triangle.x]};
    const double b{weights_[triangle.y]};
    const double c{weights_[triangle.z]};
    const double at = double{random.uniform()} * (a + b + c);
    for (float& cut : cuts) {
        cut = random.uniform();
    }
    std::sort(cuts, cuts + 3);
    const float most = cuts[1];  // coordinate of the corner drawn
    const float second = cuts[2] - cuts[1];
    const float third = 1.0F - cuts[2];
    return at < a       ? glm::vec3(most, second, third)
           : at < a + b ? glm::vec3(second, most, third)
                        : glm::vec3(second, third, most);
}

EmitterSurface::Place EmitterSurface::draw(Pcg32& random, float age) const {
    // The first sum above `at` never belongs to a triangle without area.
    const double at = fineUniform(random) * area();
    const auto found = std::upper_bound(upto_.begin(), upto_.end(), at);
    const std::size_t i = std::min(static_cast<std::size_t>(found - upto_.begin()), triangles_.size() - 1);
    const glm::uvec3& t = triangles_[i];
    const glm::vec3 share = sampleBarycentric(random, t);
    const auto placeIn = [&](const std::vector<glm::vec3>& in) {
        return share.x * in[t.x] + share.y * in[t.y] + share.z * in[t.z];
    };
    Place place;
    place.position = placeIn(end_);
    glm::vec3 corners[3]{end_[t.x], end_[t.y], end_[t.z]};
    if (!begin_.empty()) {
        const glm::vec3 before = placeIn(begin_);
        const auto seconds = static_cast<float>(seconds_);
        const glm::vec3 velocity = (place.position - before) / seconds;
        if (isFinite(velocity)) {
            const float back = std::min(age / seconds, 1.0F);
            place.velocity = velocity;
            place.position += back * (before - place.position);
            corners[0] += back * (begin_[t.x] - corners[0]);
            corners[1] += back * (begin_[t.y] - corners[1]);
            corners[2] += back * (begin_[t.z] - corners[2]);
        }
    }
    glm::dvec3 across = crossOf(corners[0], corners[1], corners[2]);
    if (!(glm::dot(across, across) > 0.0)) {  // degenerate during its motion, or not finite
        across = crossOf(end_[t.x], end_[t.y], end_[t.z]);
    }
    place.normal = glm::vec3(across / std::sqrt(glm::dot(across, across)));
    return place;
}

}  // namespace relief

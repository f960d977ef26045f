// SPDX-License-Identifier: Apache-2.0
#include "bake/import/import_scene.h"

#include <algorithm>
#include <cmath>
#include <glm/geometric.hpp>
#include <glm/matrix.hpp>
#include <utility>

#include "formats/base/text.h"

namespace relief {
namespace {

/// Determinant, relative to the product of the column lengths, below which a transform has no volume.
constexpr double kFlat = 1e-9;
/// Relative deviation from uniform scale and right angles that counts as rounding: 0.1 mm per metre.
constexpr double kRigid = 1e-4;

}  // namespace

bool Transform::mirrors() const {
    return glm::determinant(linear) < 0.0;
}

bool Transform::flattens() const {
    const double lengths = glm::length(linear[0]) * glm::length(linear[1]) * glm::length(linear[2]);
    return std::abs(glm::determinant(linear)) <= kFlat * lengths;
}

std::optional<RigidPose> rigidPose(const glm::dmat3& m) {
    const double scale = std::sqrt(glm::dot(m[0], m[0]));
    const double tolerance = kRigid * scale * scale;
    for (int i = 0; i < 3; ++i) {
        if (!(std::abs(glm::dot(m[i], m[i]) - scale * scale) <= tolerance &&
              std::abs(glm::dot(m[i], m[(i + 1) % 3])) <= tolerance)) {
            return std::nullopt;
        }
    }
    if (!(scale > 0.0) || glm::determinant(m) < 0.0) {
        return std::nullopt;
    }
    // Starts from the largest of the four components, to keep precision: Shepperd (1978).
    const glm::dmat3 r = m / scale;
    const std::array<double, 4> squares = {1 + r[0][0] - r[1][1] - r[2][2], 1 - r[0][0] + r[1][1] - r[2][2],
                                           1 - r[0][0] - r[1][1] + r[2][2], 1 + r[0][0] + r[1][1] + r[2][2]};
    const std::array<std::array<double, 4>, 4> rows = {{
        {squares[0], r[0][1] + r[1][0], r[2][0] + r[0][2], r[1][2] - r[2][1]},
        {r[0][1] + r[1][0], squares[1], r[1][2] + r[2][1], r[2][0] - r[0][2]},
        {r[2][0] + r[0][2], r[1][2] + r[2][1], squares[2], r[0][1] - r[1][0]},
        {r[1][2] - r[2][1], r[2][0] - r[0][2], r[0][1] - r[1][0], squares[3]},
    }};
    // In a tie, w wins.
    std::size_t largest = 3;
    for (std::size_t i = 0; i < 3; ++i) {
        largest = squares[i] > squares[largest] ? i : largest;
    }
    RigidPose pose{rows[largest], scale};
    double square = 0.0;
    for (const double part : pose.rotation) {
        square += part * part;
    }
    const double length = pose.rotation[3] < 0.0 ? -std::sqrt(square) : std::sqrt(square);
    for (double& part : pose.rotation) {
        part = part / length + 0.0;  // removes negative zeros
    }
    return pose;
}

Transform operator*(const Transform& outer, const Transform& inner) {
    return {outer.linear * inner.linear, outer.apply(inner.offset)};
}

std::vector<std::uint32_t> compact(const std::vector<glm::vec3>& positions, ScenePart& part) {
    std::uint32_t low = 0xFFFFFFFF;
    std::uint32_t high = 0;
    for (const glm::uvec3& t : part.triangles) {
        low = std::min({low, t.x, t.y, t.z});
        high = std::max({high, t.x, t.y, t.z});
    }
    std::vector<std::uint32_t> used;
    std::vector<std::uint32_t> place(low <= high ? high - low + std::size_t{1} : 0);
    for (const glm::uvec3& t : part.triangles) {
        place[t.x - low] = place[t.y - low] = place[t.z - low] = 1;
    }
    for (std::size_t i = 0; i < place.size(); ++i) {
        if (std::exchange(place[i], static_cast<std::uint32_t>(used.size())) != 0) {
            used.push_back(low + static_cast<std::uint32_t>(i));
            part.positions.push_back(positions[used.back()]);
        }
    }
    for (glm::uvec3& t : part.triangles) {
        t = {place[t.x - low], place[t.y - low], place[t.z - low]};
    }
    return used;
}

void warnOnce(std::vector<std::string>& warnings, const std::string& warning) {
    if (std::ranges::find(warnings, warning) == warnings.end()) {
        warnings.push_back(warning);
    }
}

std::string firstName(const std::string& name, std::uint64_t count) {
    return name.empty() ? std::string()
                        : std::string(count == 1 ? " ('" : " (first '") +
                              cleanUtf8(name, kSelectedNameBytesMax) + "')";
}

bool SkippedObjects::leaveOut(Shown shown, const std::string& name, HiddenMode hidden) {
    if (shown == Shown::kYes || hidden == HiddenMode::kKeep) {
        return false;
    }
    const std::size_t kind = shown == Shown::kHidden ? 0 : 1;
    ++counts_.at(kind);
    if (first_names_.at(kind).empty()) {
        first_names_.at(kind) = name;
    }
    return true;
}

void SkippedObjects::warn(std::vector<std::string>& warnings) const {
    constexpr std::array<std::array<const char*, 2>, 2> kWords = {
        {{"hidden object", "hidden objects"}, {"lower level of detail", "lower levels of detail"}}};
    for (std::size_t kind = 0; kind < 2; ++kind) {
        if (const std::uint64_t count = counts_.at(kind); count > 0) {
            warnings.push_back("left out " + std::to_string(count) + " " +
                               kWords.at(kind).at(count == 1 ? 0 : 1) +
                               firstName(first_names_.at(kind), count) + "; --hidden keep bakes all");
        }
    }
}

tl::unexpected<Error> noTriangles(bool left_out) {
    return invalidInput(left_out
                            ? "all of its objects are hidden; show the objects to bake, or use --hidden keep"
                            : "no triangles; export the surface as polygons, not as points or lines");
}

tl::unexpected<Error> tooManyTriangles(const ImportJob& job) {
    return fail(ErrorCode::kLimit,
                "it has more than " + std::to_string(job.triangle_max) +
                    " triangles, or three times as many vertices, counting each instance; simplify the mesh" +
                    (job.triangle_max < kTriangleMax ? ", or raise --max-triangles" : ""));
}

}  // namespace relief

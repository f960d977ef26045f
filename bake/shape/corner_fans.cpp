// SPDX-License-Identifier: Apache-2.0
#include "bake/shape/corner_fans.h"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <glm/matrix.hpp>
#include <utility>

namespace relief {
namespace {

/// Longest mitre, in units of half the thickness: that of kFoldCosine.
constexpr double kMitreMax = 2.0;
/// Smallest offset of a side by its mitre, in units of half the thickness.
constexpr double kMitreMin = 0.7;
/// Damping, in units of the number of normals; keeps the mitre defined if all normals are equal.
constexpr double kMitreDamping = 1e-4;

double angleAt(const std::vector<glm::vec3>& positions, const glm::uvec3& t, int corner) {
    const glm::dvec3 at = positions[t[corner]];
    const glm::dvec3 a = glm::dvec3(positions[t[(corner + 1) % 3]]) - at;
    const glm::dvec3 b = glm::dvec3(positions[t[(corner + 2) % 3]]) - at;
    const double size = std::sqrt(dot(a, a) * dot(b, b));
    // Any weight that grows with the angle suffices; no arc cosine is needed.
    return size > 0.0 ? 1.0 - std::clamp(dot(a, b) / size, -1.0, 1.0) + 1e-3 : 1e-3;
}

/// Corner k of triangle i has the index 3·i + k. Returns, per corner, the corner at the same vertex across the side
/// that begins there, or kNoTriangle.
std::vector<std::uint32_t> nextCorners(const Sheet& sheet) {
    std::vector<std::uint32_t> next(3 * sheet.triangles.size(), Sheet::kNoTriangle);
    for (std::uint32_t i = 0; i < next.size(); ++i) {
        const int side = static_cast<int>(i % 3);
        const std::uint32_t other = sheet.neighbours[i / 3][side];
        for (std::uint32_t k = 0; k < 3 && other != Sheet::kNoTriangle; ++k) {
            if (sheet.triangles[other][static_cast<int>(k)] == sheet.triangles[i / 3][side]) {
                next[i] = 3 * other + k;
            }
        }
    }
    return next;
}

}  // namespace

/// The least-squares mitre m of a corner: n·m = 1 for each of its normals n.
struct CornerFans::Mitre {
    glm::dmat3 squares{0.0};  // sum of n·nᵀ
    glm::dvec3 sum{0.0};
    double weight = 0.0;

    void add(const glm::dvec3& normal, double by) {
        for (int column = 0; column < 3; ++column) {
            squares[column] += by * normal[column] * normal;
        }
        sum += by * normal;
        weight += by;
    }

    [[nodiscard]] glm::dvec3 solve() const {
        const double damping = kMitreDamping * weight;
        const glm::dmat3 damped = squares + damping * glm::dmat3(1.0);
        const glm::dvec3 mitre = (1.0 + kMitreDamping) * (glm::inverse(damped) * sum);
        return length(mitre) > kMitreMax ? mitre * (kMitreMax / length(mitre)) : mitre;
    }
};

CornerFans::CornerFans(Sheet& sheet) : sheet_(sheet), roots_(3 * sheet.triangles.size(), Sheet::kNoTriangle) {
    for (const glm::uvec3& t : sheet.triangles) {
        normals_.push_back(unitNormal(sheet.positions, t));
    }
    mitres_.resize(roots_.size());
    fan_of_.resize(roots_.size());
    const std::vector<std::uint32_t> next = nextCorners(sheet);
    std::vector<bool> has_previous(next.size(), false);
    for (const std::uint32_t corner : next) {
        if (corner != Sheet::kNoTriangle) {
            has_previous[corner] = true;
        }
    }
    std::vector<std::uint32_t> fan;
    for (const bool closed : {false, true}) {
        for (std::uint32_t first = 0; first < next.size(); ++first) {
            if (roots_[first] != Sheet::kNoTriangle || (!closed && has_previous[first])) {
                continue;
            }
            fan.assign(1, first);
            for (std::uint32_t i = next[first]; i != Sheet::kNoTriangle && i != first; i = next[i]) {
                fan.push_back(i);
            }
            for (const std::uint32_t corner : fan) {
                fan_of_[corner] = first;
            }
            addFan(fan, closed);
        }
    }
}

void CornerFans::addTo(Mitre& mitre, std::uint32_t corner) const {
    mitre.add(normalOf(corner),
              angleAt(sheet_.positions, sheet_.triangles[corner / 3], static_cast<int>(corner % 3)));
}

void CornerFans::addFan(std::vector<std::uint32_t>& fan, bool closed) {
    Mitre whole;
    for (const std::uint32_t corner : fan) {
        addTo(whole, corner);
    }
    const glm::dvec3 all = whole.solve();
    if (std::ranges::all_of(fan, [&](std::uint32_t k) { return dot(normalOf(k), all) >= kMitreMin; })) {
        setMitre(fan, all);
        return;
    }
    if (closed) {  // starts after the sharpest edge
        std::size_t sharpest = 0;
        double least = 1.0;
        for (std::size_t k = 0; k < fan.size(); ++k) {
            const double cosine = dot(normalOf(fan[k]), normalOf(fan[(k + 1) % fan.size()]));
            if (cosine < least) {
                least = cosine;
                sharpest = k;
            }
        }
        std::rotate(fan.begin(), fan.begin() + static_cast<std::ptrdiff_t>((sharpest + 1) % fan.size()),
                    fan.end());
        cut(fan.back(), fan.front());
    }
    std::vector<std::uint32_t> roots;
    for (std::size_t first = 0, end = 0; first < fan.size(); first = end) {
        Mitre mitre;
        glm::dvec3 common(0.0);
        for (end = first; end < fan.size(); ++end) {
            addTo(mitre, fan[end]);
            const glm::dvec3 with = mitre.solve();
            if (end > first &&
                std::min(dot(normalOf(fan[first]), with), dot(normalOf(fan[end]), with)) < kMitreMin) {
                cut(fan[end - 1], fan[end]);
                break;
            }
            common = with;
        }
        setMitre(std::span(fan).subspan(first, end - first), common);
        roots.push_back(roots_[fan[first]]);
    }
    if (closed) {
        lids_.push_back(std::move(roots));
    }
}

void CornerFans::setMitre(std::span<const std::uint32_t> corners, const glm::dvec3& mitre) {
    const std::uint32_t root = std::ranges::min(corners);
    mitres_[root] = mitre;
    for (const std::uint32_t corner : corners) {
        roots_[corner] = root;
    }
}

void CornerFans::cut(std::uint32_t corner, std::uint32_t next) {
    sheet_.neighbours[corner / 3][static_cast<int>(corner % 3)] = Sheet::kNoTriangle;
    sheet_.neighbours[next / 3][static_cast<int>((next + 2) % 3)] = Sheet::kNoTriangle;
    cuts_.push_back({corner, next});
}

}  // namespace relief

// SPDX-License-Identifier: Apache-2.0
#include "bake/plan/silhouette.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <glm/vec2.hpp>

#include "formats/row_spans.h"
#include "formats/texel.h"

namespace relief {
namespace {

constexpr std::size_t kStrips = 1024;
/// Rays and triangles meet in spite of rounding; of the rectangle's sides.
constexpr double kSlack = 1e-6;

}  // namespace

Silhouette::Silhouette(const TriangleMesh& mesh, const View& view) : strips_(kStrips) {
    const std::array<double, 2> inner = {static_cast<double>(view.width) - 2.0,
                                         static_cast<double>(view.height) - 2.0};
    std::vector<glm::dvec2> places;
    places.reserve(mesh.positions.size());
    for (const glm::vec3& position : mesh.positions) {
        const glm::dvec3 from = glm::dvec3(position) - view.origin;
        glm::dvec2 at;
        for (int i = 0; i < 2; ++i) {
            const double share = dot(from, view.axis[i]) / dot(view.axis[i], view.axis[i]);
            const double side = inner[static_cast<std::size_t>(i)];
            at[i] = (share * (side + 2.0) - 1.0) / side;
        }
        places.push_back(at);
    }
    const auto stripAt = [](double y) {
        return static_cast<std::size_t>(
            std::clamp(std::floor(y * static_cast<double>(kStrips)), 0.0, static_cast<double>(kStrips - 1)));
    };
    // The extent of a triangle in a strip ends at its edges.
    const auto addEdge = [&](glm::dvec2 a, glm::dvec2 b) {
        if (a.y > b.y) {
            std::swap(a, b);
        }
        const std::size_t first = stripAt(a.y - kSlack);
        const std::size_t last = stripAt(b.y + kSlack);
        // Most edges lie well within the extents so far.
        const auto low_end = static_cast<float>(std::min(a.x, b.x) - 2.0 * kSlack);
        const auto high_end = static_cast<float>(std::max(a.x, b.x) + 2.0 * kSlack);
        std::size_t k = first;
        while (k <= last && strips_[k].low <= low_end && strips_[k].high >= high_end) {
            ++k;
        }
        if (k > last) {
            return;
        }
        const double slope = b.y > a.y ? (b.x - a.x) / (b.y - a.y) : 0.0;
        for (; k <= last; ++k) {
            const double from = std::clamp(static_cast<double>(k) / kStrips - kSlack, a.y, b.y);
            const double to = std::clamp(static_cast<double>(k + 1) / kStrips + kSlack, a.y, b.y);
            double low = a.x + (from - a.y) * slope;
            double high = a.x + (to - a.y) * slope;
            if (!(b.y > a.y)) {
                high = b.x;
            }
            if (low > high) {
                std::swap(low, high);
            }
            strips_[k].add({static_cast<float>(low - kSlack), static_cast<float>(high + kSlack)});
        }
    };
    for (const glm::uvec3& t : mesh.triangles) {
        addEdge(places[t.x], places[t.y]);
        addEdge(places[t.y], places[t.z]);
        addEdge(places[t.z], places[t.x]);
    }
}

Silhouette::Silhouette(const std::vector<RowExtent>& rows) : strips_(kStrips) {
    for (std::size_t k = 0; k < kStrips && !rows.empty(); ++k) {
        strips_[k] = rows[k * rows.size() / kStrips];
    }
}

std::uint64_t Silhouette::texels(std::uint32_t width, std::uint32_t height) const {
    const std::uint32_t rows = height - 2;
    const std::uint32_t columns = width - 2;
    std::uint64_t texels = 0;
    for (std::uint32_t row = 0; row < rows; ++row) {
        RowExtent span;
        const std::size_t first = std::size_t{row} * kStrips / rows;
        const std::size_t end = ((std::size_t{row} + 1) * kStrips + rows - 1) / rows;
        for (std::size_t k = first; k < std::min(end, kStrips); ++k) {
            span.add(strips_[k]);
        }
        if (span.low <= span.high) {
            const auto columnAt = [&](float x) {
                return std::clamp(std::floor(double{x} * columns), 0.0, static_cast<double>(columns - 1));
            };
            texels += static_cast<std::uint64_t>(columnAt(span.high) - columnAt(span.low)) + 1;
        }
    }
    return texels;
}

std::uint64_t Silhouette::gpuBytes(std::uint32_t width, std::uint32_t height) const {
    return (height + texels(width, height)) * texelSize(MapFormat::kFrontBackFixed);
}

}  // namespace relief

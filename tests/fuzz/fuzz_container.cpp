// SPDX-License-Identifier: Apache-2.0
// Containers: any input gives a collider that can be written again, or an error.
#include <cmath>
#include <span>
#include <string>
#include <vector>

#include "formats/collider.h"
#include "formats/container.h"
#include "formats/nearest_surface.h"
#include "tests/fuzz/target.h"

namespace {

/// Limit of texels per input, for speed. The reader's own limits are higher.
constexpr relief::ContainerLimits kLimits{16, std::uint64_t{1} << 22};

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
    const auto given = std::as_bytes(std::span(data, size));
    const std::vector<std::byte> bytes(given.begin(), given.end());
    const auto info = relief::readContainerInfo(bytes, kLimits);
    const auto collider = relief::readContainer(bytes, kLimits);
    if (!collider) {
        mustBeLine(collider.error().message);
        return 0;
    }
    mustHold(info.has_value(), "a readable container has a header and metadata");
    mustHold(info->payloads.size() == collider->maps.size(), "one payload per map");

    const auto written = relief::writeContainer(*collider);
    mustHold(written.has_value(), "a collider can be written");
    const auto again = relief::readContainer(*written, kLimits);
    mustHold(again.has_value(), "a written container can be read");
    const auto written_again = relief::writeContainer(*again);
    mustHold(written_again.has_value() && *written_again == *written,
             "the same collider gives the same bytes");

    // Votes and nearest surfaces near, in and far outside the box, and at the limits of floats.
    const auto ask = [&](const glm::vec3& p) {
        const relief::FieldSample vote = relief::evaluate(*collider, p);
        const relief::SurfaceSample nearest = relief::nearestSurface(*collider, p);
        mustHold(std::isfinite(nearest.distance) && std::isfinite(nearest.point.x + nearest.normal.x),
                 "the nearest surface is finite");
        mustHold(nearest.inside() == vote.inside(), "the nearest surface has the vote's side");
    };
    const glm::vec3 center = collider->bounds.center();
    const glm::vec3 sides = collider->bounds.size();
    for (int i = 0; i < 64; ++i) {
        const glm::vec3 at(static_cast<float>(i % 4), static_cast<float>(i / 4 % 4),
                           static_cast<float>(i / 16));
        const glm::vec3 p = center + sides * (at * 0.5F - 0.75F);
        if (std::isfinite(p.x) && std::isfinite(p.y) && std::isfinite(p.z)) {
            ask(p);
        }
    }
    for (const float far : {1e30F, -3e38F, 0.0F}) {
        ask(glm::vec3(far, 1.0F, -far));
    }
    return 0;
}

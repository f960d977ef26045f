#include "formats/collider.h"

#include <algorithm>

#include "formats/row_spans.h"

namespace relief {

void Bounds::add(const glm::vec3& p) {
    min = {std::min(min.x, p.x), std::min(min.y, p.y), std::min(min.z, p.z)};
    max = {std::max(max.x, p.x), std::max(max.y, p.y), std::max(max.z, p.z)};
}

float Bounds::longestSide() const {
    const glm::vec3 s = size();
    return std::max({s.x, s.y, s.z});
}

std::uint64_t Collider::texelBytes() const {
    std::uint64_t bytes = 0;
    for (const DepthMap& map : maps) {
        bytes += map.texelBytes();
    }
    return bytes;
}

std::uint64_t Collider::gpuBytes() const {
    std::uint64_t bytes = 0;
    for (const DepthMap& map : maps) {
        bytes += relief::gpuBytes(map);
    }
    return bytes;
}

FieldSample evaluate(const Collider& collider, const glm::vec3& p) {
    FieldSample best;
    best.distance = Vote{}.distance;
    for (std::size_t i = 0; i < collider.maps.size(); ++i) {
        if (const std::optional<Vote> v = vote(collider.maps[i], p);
            v && replaces(v->distance, best.distance)) {
            best = {v->distance, v->normal, static_cast<int>(i)};
        }
    }
    return best;
}

InsideSample evaluateInside(const Collider& collider, const glm::vec3& p) {
    Vote best;
    InsideSample sample;
    for (std::size_t i = 0; i < collider.maps.size() && best.distance < 0.0F; ++i) {
        if (const std::optional<Vote> v = vote(collider.maps[i], p);
            v && replaces(v->distance, best.distance)) {
            best = *v;
            sample.map = static_cast<int>(i);
        }
    }
    sample.inside = sample.map >= 0 && best.distance < 0.0F;
    if (sample.inside) {
        sample.normal = best.normal;
    }
    return sample;
}

}  // namespace relief

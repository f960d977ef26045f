// SPDX-License-Identifier: Apache-2.0
#include "tests/formats/analytic_shapes.h"

#include <algorithm>
#include <cmath>
#include <glm/geometric.hpp>
#include <glm/trigonometric.hpp>
#include <limits>
#include <stdexcept>

#include "formats/normal_index.h"

namespace relief::test {
namespace {

class Sphere : public Shape {
  public:
    Sphere(const glm::dvec3& center, double radius) : center_(center), radius_(radius) {}

    std::vector<Hit> hits(const glm::dvec3& origin, const glm::dvec3& direction) const override {
        const glm::dvec3 to_center = center_ - origin;
        const double middle = glm::dot(to_center, direction);
        const double squared = radius_ * radius_ - (glm::dot(to_center, to_center) - middle * middle);
        std::vector<Hit> hits;
        if (squared > 0.0) {
            for (const double t : {middle - std::sqrt(squared), middle + std::sqrt(squared)}) {
                if (t > 0.0) {
                    hits.push_back({t, (origin + t * direction - center_) / radius_});
                }
            }
        }
        return hits;
    }
    bool inside(const glm::dvec3& p) const override { return glm::length(p - center_) < radius_; }

  private:
    glm::dvec3 center_;
    double radius_;
};

class Box : public Shape {
  public:
    Box(const glm::dvec3& center, const glm::dvec3& half) : center_(center), half_(half) {}

    std::vector<Hit> hits(const glm::dvec3& origin, const glm::dvec3& direction) const override {
        Hit enter{-std::numeric_limits<double>::infinity(), {}};
        Hit leave{std::numeric_limits<double>::infinity(), {}};
        for (int i = 0; i < 3; ++i) {
            const double from = origin[i] - center_[i];
            if (direction[i] == 0.0) {
                if (std::abs(from) >= half_[i]) {
                    return {};
                }
                continue;
            }
            const double sign = direction[i] > 0.0 ? 1.0 : -1.0;
            glm::dvec3 normal(0.0);
            normal[i] = sign;
            const double near = (-sign * half_[i] - from) / direction[i];
            const double far = (sign * half_[i] - from) / direction[i];
            if (near > enter.t) {
                enter = {near, -normal};
            }
            if (far < leave.t) {
                leave = {far, normal};
            }
        }
        std::vector<Hit> hits;
        if (enter.t < leave.t) {
            for (const Hit& hit : {enter, leave}) {
                if (hit.t > 0.0) {
                    hits.push_back(hit);
                }
            }
        }
        return hits;
    }
    bool inside(const glm::dvec3& p) const override {
        const glm::dvec3 d = glm::abs(p - center_);
        return d.x < half_.x && d.y < half_.y && d.z < half_.z;
    }

  private:
    glm::dvec3 center_;
    glm::dvec3 half_;
};

class Torus : public Shape {
  public:
    Torus(double ring_radius, double tube_radius) : ring_(ring_radius), tube_(tube_radius) {}

    std::vector<Hit> hits(const glm::dvec3& origin, const glm::dvec3& direction) const override {
        const double flat = std::hypot(direction.x, direction.y);
        std::vector<double> roots;
        if (glm::length(origin) < 1e-12) {
            // In the plane of ray and axis: |(flat, z)·t − (ring, 0)| = tube.
            const double middle = flat * ring_;
            const double squared = middle * middle - (ring_ * ring_ - tube_ * tube_);
            if (squared > 0.0) {
                roots = {middle - std::sqrt(squared), middle + std::sqrt(squared)};
            }
        } else if (flat < 1e-12) {
            const double across = std::hypot(origin.x, origin.y) - ring_;
            const double squared = tube_ * tube_ - across * across;
            if (squared > 0.0) {
                const double middle = -origin.z / direction.z;
                roots = {middle - std::sqrt(squared), middle + std::sqrt(squared)};
            }
        } else {
            throw std::logic_error("no closed form for this ray");
        }
        std::vector<Hit> hits;
        for (const double t : roots) {
            if (t > 0.0) {
                hits.push_back({t, normalAt(origin + t * direction)});
            }
        }
        return hits;
    }
    bool inside(const glm::dvec3& p) const override {
        return std::hypot(std::hypot(p.x, p.y) - ring_, p.z) < tube_;
    }

  private:
    [[nodiscard]] glm::dvec3 normalAt(const glm::dvec3& p) const {
        const double across = std::hypot(p.x, p.y);
        return (p - glm::dvec3(p.x, p.y, 0.0) * (ring_ / across)) / tube_;
    }

    double ring_;
    double tube_;
};

Affine inverseOf(const glm::dvec3& origin, const glm::dmat3& axes, const glm::dvec3& sides) {
    Affine affine;
    for (int i = 0; i < 3; ++i) {
        const glm::dvec3 row = axes[i] / sides[i];
        affine.row[i] = glm::vec4(glm::vec3(row), static_cast<float>(-glm::dot(row, origin)));
    }
    return affine;
}

void clearTexels(DepthMap& map) {
    map.texels.assign(map.texelBytes(), std::byte{0});
    for (std::uint32_t face = 0; face < map.faceCount(); ++face) {
        for (std::uint32_t y = 0; y < map.height; ++y) {
            for (std::uint32_t x = 0; x < map.width; ++x) {
                encodeTexel(map.format, {}, map.texelAt(face, x, y));
            }
        }
    }
}

Surface surface(double depth, const glm::dvec3& normal) {
    return {static_cast<float>(depth), glm::vec3(normal)};
}

}  // namespace

std::unique_ptr<Shape> makeSphere(const glm::dvec3& center, double radius) {
    return std::make_unique<Sphere>(center, radius);
}

std::unique_ptr<Shape> makeBox(const glm::dvec3& center, const glm::dvec3& half) {
    return std::make_unique<Box>(center, half);
}

std::unique_ptr<Shape> makeTorus(double ring_radius, double tube_radius) {
    return std::make_unique<Torus>(ring_radius, tube_radius);
}

glm::dvec3 OrthographicFrame::toMap(const glm::dvec3& p) const {
    return (glm::transpose(axes) * (p - origin)) / sides;
}

OrthographicFrame centeredFrame(const glm::dvec3& center, const glm::dmat3& axes, const glm::dvec3& sides) {
    return {center - axes * (0.5 * sides), axes, sides};
}

DepthMap emptyMap(const OrthographicFrame& frame, MapFormat format, Compare compare, std::uint32_t width,
                  std::uint32_t height) {
    DepthMap map;
    map.format = format;
    map.compare = compare;
    map.width = width;
    map.height = height;
    map.object_to_map = inverseOf(frame.origin, frame.axes, frame.sides);
    map.object_per_map = glm::vec3(frame.sides);
    clearTexels(map);
    return map;
}

DepthMap emptyMap(const CubeFrame& frame, Compare compare, std::uint32_t size) {
    return emptyMap(OrthographicFrame{frame.center, frame.axes, frame.half}, MapFormat::kCube8, compare, size,
                    size);
}

std::vector<Hit> texelHits(const Shape& shape, const OrthographicFrame& frame, const DepthMap& map,
                           std::uint32_t x, std::uint32_t y) {
    std::vector<Hit> hits =
        shape.hits(frame.toObject({(x + 0.5) / map.width, (y + 0.5) / map.height, 0.0}), frame.axes[2]);
    std::erase_if(hits, [&](const Hit& hit) { return hit.t > frame.sides.z; });
    return hits;
}

glm::dvec3 cubeTexelDirection(std::uint32_t face, std::uint32_t x, std::uint32_t y, std::uint32_t size) {
    const double sc = 2.0 * (x + 0.5) / size - 1.0;
    const double tc = 2.0 * (y + 0.5) / size - 1.0;
    const glm::dvec3 directions[] = {{1, -tc, -sc}, {-1, -tc, sc}, {sc, 1, tc},
                                     {sc, -1, -tc}, {sc, -tc, 1},  {-sc, -tc, -1}};
    return directions[face];
}

DepthMap makeMap(const Shape& shape, const OrthographicFrame& frame, MapFormat format, Compare compare,
                 std::uint32_t width, std::uint32_t height) {
    DepthMap map = emptyMap(frame, format, compare, width, height);
    for (std::uint32_t y = 1; y + 1 < height; ++y) {
        for (std::uint32_t x = 1; x + 1 < width; ++x) {
            const std::vector<Hit> hits = texelHits(shape, frame, map, x, y);
            if (hits.empty()) {
                continue;
            }
            const Surface first = surface(hits.front().t / frame.sides.z, hits.front().normal);
            const Surface last = surface(hits.back().t / frame.sides.z, hits.back().normal);
            Texel texel;
            texel.front = compare == Compare::kGreater ? last : first;
            if (compare == Compare::kBoth) {
                texel.back = last;
            }
            encodeTexel(format, texel, map.texelAt(0, x, y));
        }
    }
    return map;
}

DepthMap makeMap(const Shape& shape, const CubeFrame& frame, Compare compare, std::uint32_t size) {
    DepthMap map = emptyMap(frame, compare, size);
    for (std::uint32_t face = 0; face < 6; ++face) {
        for (std::uint32_t y = 0; y < size; ++y) {
            for (std::uint32_t x = 0; x < size; ++x) {
                const glm::dvec3 in_map = glm::normalize(cubeTexelDirection(face, x, y, size));
                const glm::dvec3 in_object = frame.axes * (frame.half * in_map);
                const double object_per_depth = glm::length(in_object);
                const std::vector<Hit> hits = shape.hits(frame.center, in_object / object_per_depth);
                if (!hits.empty()) {
                    const Hit& hit = compare == Compare::kLess ? hits.front() : hits.back();
                    encodeTexel(map.format, {surface(hit.t / object_per_depth, hit.normal), std::nullopt},
                                map.texelAt(face, x, y));
                }
            }
        }
    }
    return map;
}

Collider threeMaps(const Shape& shape, const glm::dvec3& center, const glm::dmat3& axes, double half,
                   std::uint32_t size, MapFormat format, Decode decode) {
    Collider collider;
    const double side = 2.0 * half * size / (size - 6);
    for (int k = 0; k < 3; ++k) {
        const glm::dmat3 look(axes[(k + 1) % 3], axes[(k + 2) % 3], axes[k]);
        collider.maps.push_back(makeMap(shape, centeredFrame(center, look, glm::dvec3(side)), format,
                                        Compare::kBoth, size, size));
        collider.maps.back().decode = decode;
    }
    return collider;
}

double angleInDegrees(const glm::dvec3& a, const glm::dvec3& b) {
    return glm::degrees(std::atan2(glm::length(glm::cross(a, b)), glm::dot(a, b)));
}

std::string nameOf(const Encoding& encoding) {
    return std::string(mapFormatName(encoding.format)) + " " + depthEncodingName(encoding.format) + " " +
           compareName(encoding.compare);
}

glm::dvec3 storedNormal(MapFormat format, const glm::dvec3& normal) {
    const glm::vec3 single(normal);
    return glm::dvec3(format == MapFormat::kFloat32 ? single : decodeNormal(encodeNormal(single)));
}

double depthQuantum(MapFormat format, double depth) {
    switch (format) {
        case MapFormat::kFloat32:
            return depth * 0x1p-24;
        case MapFormat::kFrontBackHalf:
            return std::max(depth * 0x1p-11, depth < 0x1p-14 ? 0x1p-14 : 0.0);
        case MapFormat::kFixed8:
        case MapFormat::kFrontBackFixed:
            return 0.5 / 65534.0 + 0x1p-22;
        case MapFormat::kCube8:
            return 0.5 * kCubeDepthMax / 65534.0 + 0x1p-22;
        case MapFormat::kPatches:
            break;
    }
    return 0.0;
}

double transformSlack(const glm::vec4& row, const glm::vec3& p) {
    const glm::dvec4 terms = glm::abs(glm::dvec4(row) * glm::dvec4(p, 1.0));
    return 8.0 * 0x1p-24 * (terms.x + terms.y + terms.z + terms.w);
}

double roundingSlack(const DepthMap& map, const glm::vec3& p, double from_surface) {
    double slack = 16.0 * 0x1p-24 * from_surface;
    for (int k = 0; k < 3; ++k) {
        slack += (transformSlack(map.object_to_map.row[k], p) + 0x1p-20) * double{map.object_per_map[k]};
    }
    return slack;
}

}  // namespace relief::test

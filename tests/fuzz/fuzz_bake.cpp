// SPDX-License-Identifier: Apache-2.0
// Small difficult meshes: integer solids that touch, overlap, nest, coincide or are inside out; sheets, slivers and
// loose triangles. Compares the sides of 2,000 points with exact arithmetic. No point deep in the solid may be outside
// the baked collider.
#include <algorithm>
#include <array>
#include <cmath>
#include <glm/vec4.hpp>
#include <optional>
#include <set>
#include <span>
#include <string>
#include <vector>

#include "bake/maps/bake_maps.h"
#include "bake/mesh/mesh_query.h"
#include "bake/repair/winding.h"
#include "bake/shape/shape.h"
#include "tests/fuzz/target.h"

namespace {

using namespace relief;

constexpr int kPoints = 2000;
/// Coordinates are at most 64, in these steps: a determinant of differences has less than 127 bits.
constexpr double kSteps = 0x1p30;
constexpr double kThickness = 0.4;

__extension__ using Int128 = __int128;
using Exact = std::array<std::int64_t, 3>;

/// The bytes of an input, followed by zeros.
class Bytes {
  public:
    explicit Bytes(std::span<const std::uint8_t> bytes) : bytes_(bytes) {}
    [[nodiscard]] bool empty() const { return next_ >= bytes_.size(); }
    unsigned below(unsigned n) { return (empty() ? 0U : bytes_[next_++]) % n; }
    glm::vec3 point(unsigned n) {
        const auto x = static_cast<float>(below(n));
        const auto y = static_cast<float>(below(n));
        return {x, y, static_cast<float>(below(n))};
    }

  private:
    std::span<const std::uint8_t> bytes_;
    std::size_t next_ = 0;
};

class MeshMaker {
  public:
    TriangleMesh make(Bytes& bytes) {
        const unsigned parts = 1 + bytes.below(8);
        for (unsigned i = 0; i < parts; ++i) {
            addPart(bytes);
        }
        mesh_.name = "fuzz";
        mesh_.content_hash = std::string(32, '0');
        return mesh_;
    }

  private:
    void add(const std::vector<glm::vec3>& positions, const std::vector<glm::uvec3>& triangles) {
        last_first_ = mesh_.triangles.size();
        const auto first = static_cast<std::uint32_t>(mesh_.positions.size());
        mesh_.positions.insert(mesh_.positions.end(), positions.begin(), positions.end());
        for (const glm::uvec3& t : triangles) {
            mesh_.triangles.push_back(t + first);
        }
    }

    void addBox(const glm::vec3& low, const glm::vec3& size) {
        std::vector<glm::vec3> corners;
        for (unsigned i = 0; i < 8; ++i) {
            corners.push_back(low + size * glm::vec3(i & 1U, i >> 1U & 1U, i >> 2U));
        }
        std::vector<glm::uvec3> triangles;
        for (const glm::uvec4& q : {glm::uvec4(0, 4, 6, 2), glm::uvec4(1, 3, 7, 5), glm::uvec4(0, 1, 5, 4),
                                    glm::uvec4(2, 6, 7, 3), glm::uvec4(0, 2, 3, 1), glm::uvec4(4, 5, 7, 6)}) {
            triangles.emplace_back(q.x, q.y, q.z);
            triangles.emplace_back(q.x, q.z, q.w);
        }
        add(corners, triangles);
    }

    /// Repeats the last part: unchanged, inside out, smaller about its middle, or slightly moved.
    void addAgain(Bytes& bytes) {
        std::vector<glm::vec3> positions;
        std::vector<glm::uvec3> triangles;
        glm::vec3 middle(0.0F);
        for (std::size_t i = last_first_; i < mesh_.triangles.size(); ++i) {
            const auto first = static_cast<std::uint32_t>(positions.size());
            triangles.emplace_back(first, first + 1, first + 2);
            for (int corner = 0; corner < 3; ++corner) {
                positions.push_back(mesh_.positions[mesh_.triangles[i][corner]]);
                middle += positions.back();
            }
        }
        if (positions.empty()) {
            return;
        }
        middle /= static_cast<float>(positions.size());
        const unsigned how = bytes.below(6);
        const float scale = std::array{1.0F, 1.0F, 0.5F, 0.999F, 0.99999F, 1.0F}[how];
        for (glm::vec3& p : positions) {
            p = how >= 2 && how <= 4 ? middle + scale * (p - middle) : p + (how == 5 ? 1e-5F : 0.0F);
        }
        const bool turned = how == 1 || bytes.below(2) == 1;
        for (glm::uvec3& t : triangles) {
            t = turned ? glm::uvec3(t.x, t.z, t.y) : t;
        }
        add(positions, triangles);
    }

    void addPart(Bytes& bytes) {
        switch (bytes.below(7)) {
            case 0:
            case 1: {
                const glm::vec3 low = bytes.point(12);
                addBox(low, bytes.point(8) + 1.0F);
                break;
            }
            case 2: {  // a tetrahedron, possibly a sliver
                const glm::vec3 a = bytes.point(16);
                const glm::vec3 b = bytes.point(16);
                const glm::vec3 c = bytes.point(16);
                add({a, b, c, bytes.point(16)}, {{0, 2, 1}, {0, 1, 3}, {1, 2, 3}, {0, 3, 2}});
                break;
            }
            case 3: {  // an octahedron
                const glm::vec3 at = bytes.point(12);
                const auto r = static_cast<float>(1 + bytes.below(6));
                add({at + glm::vec3(r, 0, 0), at - glm::vec3(r, 0, 0), at + glm::vec3(0, r, 0),
                     at - glm::vec3(0, r, 0), at + glm::vec3(0, 0, r), at - glm::vec3(0, 0, r)},
                    {{0, 2, 4}, {2, 1, 4}, {1, 3, 4}, {3, 0, 4}, {2, 0, 5}, {1, 2, 5}, {3, 1, 5}, {0, 3, 5}});
                break;
            }
            case 4: {  // loose triangles
                const unsigned count = 1 + bytes.below(4);
                for (unsigned i = 0; i < count; ++i) {
                    const glm::vec3 a = bytes.point(16);
                    const glm::vec3 b = bytes.point(16);
                    add({a, b, bytes.point(16)}, {{0, 1, 2}});
                }
                break;
            }
            case 5: {  // a box without one or two triangles
                const glm::vec3 low = bytes.point(12);
                addBox(low, bytes.point(8) + 1.0F);
                mesh_.triangles.resize(mesh_.triangles.size() - 1 - bytes.below(2));
                break;
            }
            default:
                addAgain(bytes);
        }
    }

    TriangleMesh mesh_;
    std::size_t last_first_ = 0;  // first triangle of the last part
};

/// Sides by exact arithmetic along +x. Shares no code with the baker.
class Oracle {
  public:
    explicit Oracle(const PreparedMesh& mesh) : mesh_(mesh), shells_(mesh.woundShells()) {
        for (const glm::vec3& p : mesh->positions) {
            positions_.push_back(exact(p));
        }
    }

    static Exact exact(const glm::vec3& p) {
        const auto one = [](float v) { return static_cast<std::int64_t>(std::llround(double{v} * kSteps)); };
        return {one(p.x), one(p.y), one(p.z)};
    }

    /// \return nullopt if the ray hits an edge
    [[nodiscard]] std::optional<bool> inside(const glm::vec3& point) const {
        const Exact p = exact(point);
        const std::vector<std::uint32_t>& bodies = mesh_.bodies();
        int winding = 0;
        bool odd = false;
        std::set<std::uint32_t> crossed;  // bodies crossed an odd number of times
        for (std::size_t i = 0; i < mesh_->triangles.size(); ++i) {
            const glm::uvec3& t = mesh_->triangles[i];
            const std::optional<int> way = crosses(p, positions_[t.x], positions_[t.y], positions_[t.z]);
            if (!way) {
                return std::nullopt;
            }
            odd = odd != (*way != 0);
            if (bodies.empty() || shells_ || bodies[i] == 0) {
                winding += *way;
            } else if (*way != 0 && crossed.erase(bodies[i]) == 0) {
                crossed.insert(bodies[i]);
            }
        }
        return bodies.empty() && !shells_ ? odd : winding != 0 || !crossed.empty();
    }

  private:
    static int sign(Int128 v) { return v > 0 ? 1 : v < 0 ? -1 : 0; }

    /// Orientation of the triangle p, a, b in the view along x.
    static int turn(const Exact& p, const Exact& a, const Exact& b) {
        return sign(Int128{a[1] - p[1]} * (b[2] - p[2]) - Int128{a[2] - p[2]} * (b[1] - p[1]));
    }

    /// The direction in which the ray from p along +x crosses a triangle, or 0.
    static std::optional<int> crosses(const Exact& p, const Exact& a, const Exact& b, const Exact& c) {
        const std::array<int, 3> turns = {turn(p, a, b), turn(p, b, c), turn(p, c, a)};
        const int least = *std::min_element(turns.begin(), turns.end());
        const int most = *std::max_element(turns.begin(), turns.end());
        if (least < 0 && most > 0) {
            return 0;
        }
        if (least == 0 || most == 0) {
            return std::nullopt;
        }
        // The crossing is ahead of p only if p is on one side of the triangle's plane.
        const auto d = [&p](const Exact& corner, std::size_t k) { return Int128{corner[k] - p[k]}; };
        const auto minor = [&](std::size_t i, std::size_t k) {
            return d(b, i) * d(c, k) - d(b, k) * d(c, i);
        };
        const Int128 volume = d(a, 0) * minor(1, 2) + d(a, 1) * minor(2, 0) + d(a, 2) * minor(0, 1);
        return sign(volume) == most ? most : 0;
    }

    const PreparedMesh& mesh_;
    bool shells_;
    std::vector<Exact> positions_;
};

/// The depth from which a point's texel is completely inside the solid.
double boundAt(const DepthMap& map, const glm::vec3& p) {
    const glm::dvec3 scale = map.object_per_map;
    const double largest = std::max({scale.x, scale.y, scale.z});
    if (map.projection() == Projection::kOrthographic) {
        return std::hypot(scale.x / map.width, scale.y / map.height) + scale.z / 65534.0 + 1e-5 * largest;
    }
    const glm::dvec3 q = map.object_to_map.apply(p);
    const double radius = std::sqrt(q.x * q.x + q.y * q.y + q.z * q.z);
    return largest * (2.0 * std::sqrt(2.0) / map.width * radius + 1e-4);
}

std::vector<MapSpec> mapsOf(Bytes& bytes) {
    const std::string size = ",size=" + std::to_string(8 + bytes.below(40));
    const std::string direction = std::to_string(1 + bytes.below(9)) + "/" + std::to_string(bytes.below(9)) +
                                  "/" + std::to_string(bytes.below(9));
    const glm::vec3 at = bytes.point(16);
    const std::string center = std::to_string(at.x) + "/" + std::to_string(at.y) + "/" + std::to_string(at.z);
    std::vector<MapSpec> maps;
    for (const std::string& text : {"front-back:dir=-z" + size, "front-back:dir=" + direction + size,
                                    "cube:size=12,center=" + center}) {
        const Result<MapSpec> spec = parseMapSpec(text);
        mustHold(spec.has_value(), "the text of a map can be read");
        maps.push_back(*spec);
    }
    maps.resize(1 + bytes.below(3));
    return maps;
}

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
    Bytes bytes(std::span(data, std::min<std::size_t>(size, 256)));
    BakeOptions options;
    options.threads = 1;
    options.quality = bytes.below(2) == 0 ? Quality::kFast : Quality::kNormal;
    options.maps = mapsOf(bytes);
    Result<TriangleMesh> mesh = finishMesh(MeshMaker().make(bytes));
    if (!mesh) {
        return 0;  // no triangle has an area
    }
    Result<Winding> winding = windOutwards(std::move(*mesh));
    mustHold(winding.has_value(), "any mesh can be wound");
    Result<ShapedMesh> shaped = shapeMesh(winding->mesh, {ShapeAs::kAuto, kThickness, {}});
    if (!shaped) {
        return 0;  // rejected with a one-line error
    }
    const PreparedMesh& solid = shaped->mesh;
    const Result<MeshQuery> query = MeshQuery::build(solid);
    mustHold(query.has_value(), "a solid can be queried");
    const Result<Baked> baked = bake(solid, options);
    if (!solid.closed()) {
        return 0;
    }
    const Oracle oracle(solid);
    const glm::vec3 low = solid->bounds.min;
    const glm::vec3 extent = solid->bounds.size();
    const double grain = 1e-5 * solid->bounds.longestSide();
    std::uint64_t state = size;
    const auto share = [&] {  // Knuth's MMIX generator
        state = state * 6364136223846793005U + 1442695040888963407U;
        return static_cast<float>(state >> 40U) * 0x1p-24F;
    };
    for (int i = 0; i < kPoints; ++i) {
        const float x = share();
        const float y = share();
        const glm::vec3 p = low + extent * glm::vec3(x, y, share());
        const double distance = query->closest(p).distance;
        if (distance <= grain) {
            continue;
        }
        const std::optional<bool> inside = oracle.inside(p);
        if (!inside) {
            continue;
        }
        mustHold(query->inside(p) == *inside, "the truth equals exact arithmetic");
        if (*inside && baked) {
            const FieldSample sample = evaluate(baked->collider, p);
            mustHold(sample.map < 0 || sample.inside() ||
                         distance <= boundAt(baked->collider.maps[static_cast<std::size_t>(sample.map)], p),
                     "no deep point is outside");
        }
    }
    return 0;
}

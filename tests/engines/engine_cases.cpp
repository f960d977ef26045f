// SPDX-License-Identifier: Apache-2.0
#include "tests/engines/engine_cases.h"

#include <algorithm>
#include <bit>
#include <cmath>
#include <cstring>
#include <functional>
#include <glm/common.hpp>
#include <glm/geometric.hpp>
#include <glm/mat3x3.hpp>
#include <glm/matrix.hpp>
#include <limits>
#include <random>
#include <sstream>
#include <utility>

#include "formats/container.h"
#include "formats/patch_tree.h"
#include "tests/formats/analytic_shapes.h"
#include "tests/formats/random_patches.h"
#include "tests/results.h"

namespace relief::engines {
namespace {

using Random = std::mt19937;

float within(Random& random, float low, float high) {
    return std::uniform_real_distribution<float>(low, high)(random);
}

std::uint32_t below(Random& random, std::uint32_t end) {
    return static_cast<std::uint32_t>(random() % end);
}

glm::vec3 direction(Random& random) {
    std::normal_distribution<float> gauss;
    const float x = gauss(random);
    const float y = gauss(random);
    return glm::normalize(glm::vec3(x, y, gauss(random)));
}

enum class Kind : std::uint8_t { kFlat, kSplit, kPatch, kPair };

struct Node {
    Kind kind = Kind::kFlat;
    std::uint32_t children = 0;  ///< mask, of splits
    std::size_t frame = 0;       ///< of patches
    std::uint32_t side = 2;      ///< of patches
};
/// Returns the node for a level and its index among the nodes of the tree.
using Choice = std::function<Node(std::uint32_t level, std::size_t index)>;

Node randomPatch(Random& random) {
    const auto frame = below(random, 13);
    return {Kind::kPatch, 0, frame, std::array{2U, 3U, 5U}[below(random, 3)]};
}

/// A tree of the chosen nodes with random planes and heights.
DepthMap makeTree(const PatchTreeSize& size, Random& random, const Choice& choose) {
    std::vector<Node> nodes;
    std::vector<std::uint32_t> first;
    for (std::uint32_t i = 0; i < size.roots.x * size.roots.y * size.roots.z; ++i) {
        nodes.push_back(choose(0, i));
    }
    std::size_t at = 0;
    for (std::uint32_t level = 0; level <= size.levels; ++level) {
        for (const std::size_t end = nodes.size(); at < end; ++at) {
            first.push_back(1 + static_cast<std::uint32_t>(nodes.size()));
            for (int i = nodes[at].kind == Kind::kSplit ? std::popcount(nodes[at].children) : 0; i > 0; --i) {
                nodes.push_back(choose(level + 1, nodes.size()));
            }
        }
    }
    std::vector<PatchRecord> records;
    std::vector<PatchRecord> behind;
    const auto place = [&] { return static_cast<std::uint32_t>(1 + nodes.size() + behind.size()); };
    const auto patch = [&](const Node& node) {
        std::array<double, 25> heights{};
        for (double& height : heights) {
            height = double{within(random, 0.0F, 1.5F)};
        }
        const PatchHeights codes =
            PatchHeights::of(std::span(heights).first(node.side * node.side), node.side);
        const PatchRecord record =
            PatchRecord::patch(patchFrames()[node.frame], below(random, 2) == 0, codes, place());
        for (std::uint32_t i = 0; i < heightTexels(node.side); ++i) {
            behind.push_back(codes.texel(i));
        }
        return record;
    };
    for (std::size_t i = 0; i < nodes.size(); ++i) {
        const Node& node = nodes[i];
        switch (node.kind) {
            case Kind::kFlat: {
                const bool inside = below(random, 2) == 0;
                const glm::vec3 normal = direction(random);
                records.push_back(
                    PatchRecord::flat(inside, normal, (inside ? -1.5F : 1.5F) * within(random, 0.0F, 1.0F)));
                break;
            }
            case Kind::kSplit: {
                const glm::vec3 normal = direction(random);
                const auto inside = below(random, 256);
                records.push_back(
                    PatchRecord::split(node.children, inside, first[i], normal, within(random, -0.9F, 0.9F)));
                break;
            }
            case Kind::kPatch:
                records.push_back(patch(node));
                break;
            case Kind::kPair: {
                const PatchRecord a = patch(node);
                const PatchRecord b = patch(randomPatch(random));
                records.push_back(PatchRecord::pair(below(random, 2) == 0, place()));
                behind.push_back(a);
                behind.push_back(b);
                break;
            }
        }
    }
    records.insert(records.end(), behind.begin(), behind.end());
    return test::patchesOf(size, records);
}

/// Rotates, then scales: a root cell has the edge `edge`. Reflects the first axis if asked.
void pose(DepthMap& map, double degrees, float edge, bool reflected, const glm::vec3& origin) {
    const glm::dmat3 turn = test::rotation({1, 2, 3}, degrees);
    map.object_per_map = glm::vec3(edge);
    for (int i = 0; i < 3; ++i) {
        const glm::vec3 row = (reflected && i == 0 ? -1.0F : 1.0F) * glm::vec3(turn[i]) / edge;
        map.object_to_map.row[i] = glm::vec4(row, origin[i]);
    }
}

glm::vec3 toObject(const DepthMap& map, const glm::vec3& q) {
    glm::dmat3 rows;
    glm::dvec3 origin;
    for (int i = 0; i < 3; ++i) {
        rows[i] = glm::dvec3(map.object_to_map.row[i]);
        origin[i] = double{map.object_to_map.row[i].w};
    }
    return {glm::inverse(glm::transpose(rows)) * (glm::dvec3(q) - origin)};
}

std::vector<Query> makeQueries(const Collider& collider, std::size_t count, Random& random) {
    const DepthMap& map = collider.maps[0];
    const glm::vec3 roots(patchTreeSize(map.texels).roots);
    const float edge = map.object_per_map.x;
    constexpr float kNan = std::numeric_limits<float>::quiet_NaN();
    constexpr float kInfinity = std::numeric_limits<float>::infinity();
    // No denormals: a GPU may flush them to zero.
    const glm::vec3 special[] = {{kNan, 0, 0},      {0, kNan, 0},          {0, 0, kNan},
                                 {kInfinity, 0, 0}, {0, -kInfinity, 0},    {1e30F, 1e30F, 1e30F},
                                 {0, 0, -3e38F},    {2e-38F, -2e-38F, 0},  {-0.0F, 0.0F, -0.0F},
                                 {0, 0, 0},         {3e38F, 3e38F, 3e38F}, {kNan, kInfinity, -kInfinity}};
    std::vector<Query> queries;
    queries.reserve(count);
    for (std::size_t i = 0; i < count; ++i) {
        glm::vec3 q;
        for (int axis = 0; axis < 3; ++axis) {
            // Every eighth query lies on borders of cells or of squares of heights, as far as rounding permits.
            const float uniform = within(random, -0.03F, 1.03F) * roots[axis];
            q[axis] = i % 8 == 0 ? std::round(16.0F * uniform) / 16.0F : uniform;
        }
        glm::vec3 p = toObject(map, q);
        if (i % 8 > 4) {  // close to the surface
            for (int step = 0; step < 2; ++step) {
                const FieldSample sample = evaluate(collider, p);
                p -= sample.distance < kFarOutside ? sample.distance * sample.normal : glm::vec3(0.0F);
            }
            p += edge * std::pow(10.0F, within(random, -7.0F, -2.0F)) * direction(random);
        }
        if (i % 64 == 0 && i / 64 < std::size(special)) {
            p = special[i / 64];
        }
        const glm::vec3 v = edge * within(random, 0.0F, 5.0F) * direction(random);
        const std::array<float, 3> bounce{within(random, 0.0F, 1.0F), within(random, 0.0F, 1.0F), 0.0F};
        const glm::vec3 reaction[] = {{0.05F, bounce[0], bounce[1]}, {0, 0, 0}, {0.01F, 0, 1}, {0, 1, 0}};
        const glm::vec3& own = reaction[i % 4];
        queries.push_back({{p, 0}, {v, 0}, {edge * own.x, own.y, own.z, 0}});
    }
    return queries;
}

Collider colliderOf(DepthMap map) {
    Collider collider;
    map.encloses = true;
    EXPECT_TRUE(validatePatches(map.texels));
    collider.maps.push_back(std::move(map));
    return collider;
}

bool isInPatch(const DepthMap& map, const glm::vec3& p) {
    return patchLeafAt(map.texels, map.object_to_map.apply(p)).record.kind() == PatchRecord::Kind::kPatch;
}

/// How an answer differs from a sample of the CPU.
struct Gap {
    bool sign = false;
    double distance = 0.0;  ///< in root cells, or relative to the CPU's distance if that is longer
    double normal = 0.0;
    [[nodiscard]] bool agrees() const { return !sign && distance <= kRounding && normal <= kNormalMax; }
};

Gap gapOf(const Answer& answer, const FieldSample& cpu, double edge) {
    const glm::vec4& own = answer.surface;
    Gap gap;
    // A NaN differs.
    gap.sign = !((own.w < 0.0F) == cpu.inside() && (own.w >= kFarOutside) == (cpu.distance >= kFarOutside) &&
                 !std::isnan(own.w));
    gap.distance =
        std::abs(double{own.w} - double{cpu.distance}) / std::max(edge, std::abs(double{cpu.distance}));
    gap.normal = double{glm::length(glm::vec3(own) - cpu.normal)};
    return gap;
}

/// Whether the answer agrees with the CPU at one of 26 points around p, at one of three distances by which rounding may
/// move p. The largest may cross another border.
bool isAtBorder(const Collider& collider, const glm::vec3& p, const Answer& answer) {
    const DepthMap& map = collider.maps[0];
    const double edge = double{map.object_per_map.x};
    float largest = 1.0F;
    for (const glm::vec4& row : map.object_to_map.row) {
        const glm::vec3 terms = glm::abs(glm::vec3(row) * p);
        largest = std::max({largest, terms.x + terms.y + terms.z, std::abs(row.w)});
    }
    for (const float ulps : {0.5F, 1.0F, 4.0F}) {
        const float step = map.object_per_map.x * ulps * static_cast<float>(kUlp) * largest;
        for (int k = 0; k < 27; ++k) {
            const glm::vec3 way(k % 3 - 1, k / 3 % 3 - 1, k / 9 - 1);
            if (gapOf(answer, evaluate(collider, p + step * way), edge).agrees()) {
                return true;
            }
        }
    }
    return false;
}

/// The error of a motion by the formula of relief.glsl, relative to positions and velocities; negative if the hit, the
/// distance or the normal is wrong.
double motionError(const Query& query, const Answer& answer) {
    const glm::dvec3 p(query.point);
    const glm::dvec3 v(query.velocity);
    const glm::dvec3 n(answer.normal);
    const double friction = double{query.reaction.z};
    const bool beyond = answer.surface.w == kFarOutside;  // a ball may reach the root cells
    const float distance = beyond ? answer.position.w : answer.surface.w - query.reaction.x;
    const bool hit = distance < 0.0F;
    const glm::vec3 normal = !hit ? glm::vec3(0.0F) : glm::vec3(beyond ? answer.normal : answer.surface);
    if (answer.position.w != distance || glm::vec3(answer.normal) != normal ||
        (hit && std::abs(glm::length(normal) - 1.0F) > 1e-5F)) {
        return -1.0;
    }
    if (!hit) {
        const bool unchanged = std::memcmp(&answer.position, &query.point, sizeof(glm::vec3)) == 0 &&
                               std::memcmp(&answer.velocity, &query.velocity, sizeof(glm::vec3)) == 0;
        // A NaN may change its bits.
        return unchanged || std::isnan(query.point.x + query.point.y + query.point.z) ? 0.0 : -1.0;
    }
    const double speed = glm::dot(v, n);
    const glm::dvec3 velocity =
        speed < 0.0 ? (1.0 - friction) * (v - speed * n) - double{query.reaction.y} * speed * n : v;
    const glm::dvec3 position = p - double{distance} * n;
    return std::max(
        glm::length(glm::dvec3(answer.position) - position) / (glm::length(p) + std::abs(double{distance})),
        glm::length(glm::dvec3(answer.velocity) - velocity) / (glm::length(v) + 1e-30));
}

}  // namespace

Case makeCase(std::string name, Collider collider, std::size_t count, std::uint32_t seed,
              std::uint32_t before) {
    Random random(seed);
    const DepthMap& map = collider.maps.at(0);
    Case one{std::move(name), {}, patchConstants(map, before), {}, makeQueries(collider, count, random)};
    const std::size_t texels = before + map.texels.size() / sizeof(PatchRecord);
    one.texels.resize((texels + kWidth - 1) / kWidth * kWidth * 4);
    std::generate_n(one.texels.begin(), 4 * before, [&] { return static_cast<std::uint16_t>(random()); });
    std::memcpy(&one.texels[std::size_t{4} * before], map.texels.data(), map.texels.size());
    one.collider = std::move(collider);
    return one;
}

std::vector<Case> makeCases(std::size_t count) {
    std::vector<Case> cases;
    const auto add = [&](const char* name, DepthMap map, std::uint32_t before = 0) {
        const auto seed = 100 + static_cast<std::uint32_t>(cases.size());
        cases.push_back(makeCase(name, colliderOf(std::move(map)), count, seed, before));
    };
    Random random(57);
    DepthMap map = makeTree({{13, 3, 1}, 0}, random, [](std::uint32_t, std::size_t i) {
        return Node{Kind::kPatch, 0, i % 13, std::array{2U, 3U, 5U}[i / 13]};
    });
    add("every frame and size", map);

    map = makeTree({{13, 6, 2}, 0}, random, [&](std::uint32_t, std::size_t i) {
        return Node{Kind::kPair, 0, i % 13, std::array{2U, 3U, 5U}[i / 13 % 3]};
    });
    pose(map, 31.0, 0.25F, false, {6, 3, 1});
    add("pairs", map);

    map = makeTree({{5, 6, 7}, 0}, random, [](std::uint32_t, std::size_t) { return Node{}; });
    pose(map, 77.0, 1000.0F, true, {2, 3, 3});
    add("cells without a patch", map);

    map = makeTree({{4, 4, 4}, 2}, random, [&](std::uint32_t level, std::size_t) {
        return level < 2 ? Node{Kind::kSplit, below(random, 256) & below(random, 256)} : Node{};
    });
    pose(map, 200.0, 0.001F, false, {2, 2, 2});
    add("coarse cells", map);

    map = makeTree({{1, 1, 1}, 15}, random, [&](std::uint32_t level, std::size_t i) {
        const bool splits = level < 15 && (level < 4 || i % 5 == 0);
        return splits ? Node{Kind::kSplit, below(random, 256) | 1U << below(random, 8)} : randomPatch(random);
    });
    pose(map, 120.0, 10.0F, true, {0.5F, 0.5F, 0.5F});
    add("a deep tree", map);

    map = makeTree({{24, 20, 16}, 1}, random, [&](std::uint32_t level, std::size_t i) {
        const auto kind = below(random, level == 0 ? 4 : 3);
        Node node = randomPatch(random);
        node.kind = kind == 0   ? Kind::kFlat
                    : kind == 1 ? Kind::kPatch
                    : kind == 2 ? Kind::kPair
                                : Kind::kSplit;
        node.children = static_cast<std::uint32_t>(i) & 255U;
        return node;
    });
    pose(map, 45.0, 0.1F, false, {12, 10, 8});
    add("many roots", map);

    map = test::randomPatches(random);
    add("random records", map);
    map = test::randomPatches(random);
    pose(map, 300.0, 2.5F, false, {1.5F, 1.0F, 2.0F});
    add("random records, rotated", map);
    map = test::randomPatches(random);
    pose(map, 150.0, 37.0F, true, {1.5F, 1.0F, 2.0F});
    add("random records, reflected, behind other texels", map, 3 * kWidth + 1021);

    cases.push_back(makeCase(
        "a bunny", required(loadCollider(RELIEF_SOURCE_DIR "/tests/engines/bunny.relief")), count, 99));
    return cases;
}

Difference compare(const Case& one, std::span<const Answer> answers) {
    Difference difference;
    const auto note = [&](std::size_t i, const char* text) {
        if (difference.first.empty()) {
            std::ostringstream out;
            out.precision(9);
            const glm::vec4& p = one.queries[i].point;
            out << text << " at query " << i << " (" << p.x << ' ' << p.y << ' ' << p.z << "), distance "
                << answers[i].surface.w << ", CPU " << evaluate(one.collider, glm::vec3(p)).distance;
            difference.first = out.str();
        }
    };
    const DepthMap& map = one.collider.maps[0];
    const double edge = double{map.object_per_map.x};
    for (std::size_t i = 0; i < one.queries.size(); ++i) {
        const glm::vec3 p(one.queries[i].point);
        const FieldSample cpu = evaluate(one.collider, p);
        const Gap gap = gapOf(answers[i], cpu, edge);
        if (!gap.agrees() && isAtBorder(one.collider, p, answers[i])) {
            ++difference.borders;
        } else if (gap.sign) {
            ++(gap.distance <= kRounding ? difference.rounded : difference.signs);
            if (gap.distance > kRounding) {
                note(i, "another sign");
            }
        } else {
            const bool far = cpu.distance >= kFarOutside;
            ++(far ? difference.beyond : cpu.inside() ? difference.inside : difference.outside);
            double& distance = !far && isInPatch(map, p) ? difference.patches : difference.flat;
            distance = std::max(distance, gap.distance);
            difference.normal = std::max(difference.normal, gap.normal);
            if (!gap.agrees()) {
                note(i, "another distance");
            }
        }
        const double error = motionError(one.queries[i], answers[i]);
        difference.hits += answers[i].position.w < 0.0F ? 1U : 0U;
        difference.motion = std::max(difference.motion, error);
        if (!(error >= 0.0)) {
            ++difference.reactions;
            note(i, "another reaction");
        }
    }
    return difference;
}

bool Difference::isWithinBounds(Match match) const {
    const auto queries = static_cast<double>(inside + outside + beyond);
    const bool moves = reactions == 0 && motion <= kMotionMax;
    if (match == Match::kFused) {
        return moves && static_cast<double>(signs) <= kFusedSignsMax * queries;
    }
    const double borders_max = match == Match::kRounded ? kBorderMax * queries : 0.0;
    return moves && signs == 0 && flat <= kRounding && normal <= kNormalMax &&
           patches <= (match == Match::kBits ? 0.0 : kRounding) &&
           static_cast<double>(rounded + borders) <= borders_max;
}

std::string Difference::text() const {
    std::ostringstream out;
    out.precision(3);
    out << inside << " inside, " << outside << " outside, " << beyond << " beyond, " << hits << " hits; "
        << signs << " signs differ, " << rounded << " within rounding, " << borders
        << " at borders; distances " << patches / kUlp << " ulp at patches, " << flat / kUlp
        << " ulp elsewhere; normals " << normal << "; motions " << motion << ", " << reactions
        << " reactions differ";
    return first.empty() ? out.str() : out.str() + "; " + first;
}

}  // namespace relief::engines

// SPDX-License-Identifier: Apache-2.0
#include "formats/patch_tree.h"

#include <algorithm>
#include <bit>
#include <cmath>
#include <cstring>
#include <glm/common.hpp>
#include <limits>
#include <string>

#include "formats/normal_index.h"
#include "formats/texel.h"

namespace relief {
namespace {

constexpr int kBaseZero = 2048;
constexpr int kOffsetZero = 128;  // code of a coarse plane through the cell's centre; also the steps per cell
constexpr int kCoarseHalfRange = 63;

std::uint32_t bitsOf(float value) {
    std::uint32_t bits = 0;
    std::memcpy(&bits, &value, sizeof(bits));
    return bits;
}

float floatOf(std::uint32_t bits) {
    float value = 0.0F;
    std::memcpy(&value, &bits, sizeof(value));
    return value;
}

float dot(const glm::vec3& a, const glm::vec3& b) {
    return a.x * b.x + (a.y * b.y + a.z * b.z);
}

glm::vec3 unit(const glm::vec3& v) {
    return v / std::sqrt(v.x * v.x + v.y * v.y + v.z * v.z);
}

/// Decodes equation 3 of the paper for any number of steps; exact except for the unit length.
glm::vec3 octahedron(std::uint32_t s, std::uint32_t t, int half_range) {
    const auto half = static_cast<float>(half_range);
    const float x = static_cast<float>(s) - half;
    const float y = static_cast<float>(t) - half;
    const float z = half - std::abs(x) - std::abs(y);
    const float beyond = std::max(-z, 0.0F);
    return unit({x - std::copysign(beyond, x), y - std::copysign(beyond, y), z});
}

/// Returns the coarse index of a normal by rounding in the square.
std::array<std::uint32_t, 2> coarseIndex(const glm::vec3& normal) {
    const NormalIndex fine = encodeNormal(normal);
    const auto coarse = [](int index) {
        return static_cast<std::uint32_t>(
            std::lround(static_cast<double>(index) * kCoarseHalfRange / kNormalHalfRange));
    };
    return {coarse(fine.s), coarse(fine.t)};
}

/// Returns a distance on the given side of the surface, with at least the magnitude `nearest`.
float onSide(bool inside, float distance, float nearest) {
    return inside ? std::min(distance, -nearest) : std::max(distance, nearest);
}

/// Minimum distance between the surface and cells without a patch, in cells, after rounding.
constexpr float kNearest = 1.0F / 1024.0F;

/// Rounding margin of box tests: in cells along w, in height samples along u and v.
constexpr float kBoxMargin = 1e-4F;
/// A box that meets more roots is not tested.
constexpr float kBoxRootsMax = 512.0F;

/// Returns the encoded range of a patch's heights, without their codes.
PatchHeights heightRange(const PatchRecord& patch) {
    PatchHeights heights;
    heights.side = patch.side();
    heights.base = static_cast<int>(patch.low >> 11U & 0xfffU) - kBaseZero;
    heights.scale = static_cast<std::uint8_t>(patch.high >> 24U);
    return heights;
}

/// \param i  of a height, u fastest.
std::uint8_t heightCode(PatchTexels texels, const PatchRecord& patch, std::uint32_t i) {
    const std::uint32_t side = patch.side();
    if (i == side * side - 1) {
        return static_cast<std::uint8_t>(patch.low >> 23U);
    }
    const PatchRecord texel = side == 2 ? patch : patchTexel(texels, patch.first() + i / 8);
    return static_cast<std::uint8_t>((side == 2 || (i & 4U) != 0 ? texel.high : texel.low) >> 8U * (i & 3U));
}

float signOf(const PatchRecord& patch) {
    return (patch.low & 16U) != 0 ? -1.0F : 1.0F;
}

/// The height of a patch at a point.
struct HeightAt {
    float ahead = 0.0F;  // from the surface to the point, along w of the frame; positive outside
    float by_u = 0.0F;   // derivatives of the height
    float by_v = 0.0F;
};
HeightAt heightAt(PatchTexels texels, const PatchRecord& patch, const glm::vec3& in_cell) {
    const std::uint32_t side = patch.side();
    const glm::vec3 at = patch.frame().across(in_cell);
    const auto last = static_cast<float>(side - 1);
    const float x = at.x * last;
    const float y = at.y * last;
    const float column = std::clamp(std::floor(x), 0.0F, last - 1.0F);
    const float row = std::clamp(std::floor(y), 0.0F, last - 1.0F);
    const float s = x - column;
    const float t = y - row;
    const std::uint32_t corner = static_cast<std::uint32_t>(row) * side + static_cast<std::uint32_t>(column);
    const auto code = [&](std::uint32_t i) { return static_cast<float>(heightCode(texels, patch, i)); };
    const float c00 = code(corner);
    const float c10 = code(corner + 1);
    const float c01 = code(corner + side);
    const float c11 = code(corner + side + 1);
    const PatchHeights heights = heightRange(patch);
    const float step = heights.step();
    const float lower = c00 + s * (c10 - c00);
    const float upper = c01 + s * (c11 - c01);
    const float height = heights.low() + step * (lower + t * (upper - lower));
    return {signOf(patch) * (at.z - height), (step * last) * ((c10 - c00) + t * ((c11 - c01) - (c10 - c00))),
            (step * last) * (upper - lower)};
}

PatchVote votePatch(PatchTexels texels, const PatchRecord& patch, const glm::vec3& in_cell) {
    const HeightAt surface = heightAt(texels, patch, in_cell);
    const glm::vec3 gradient = patch.frame().gradient(surface.by_u, surface.by_v);
    const float per_length = 1.0F / std::sqrt(dot(gradient, gradient));
    return {surface.ahead * per_length, (signOf(patch) * per_length) * gradient};
}

/// Returns the height of a code step for each PatchHeights::scale, in ascending order.
const std::array<float, 256>& stepsOfScales() {
    static const auto kSteps = [] {
        std::array<float, 256> steps;
        for (int scale = 0; scale < 256; ++scale) {
            const float mantissa = 1.0F + static_cast<float>(scale & 15) * (1.0F / 16.0F);
            steps[static_cast<std::size_t>(scale)] =
                mantissa * std::ldexp(1.0F, (scale >> 4) - 12) * (1.0F / 255.0F);
        }
        return steps;
    }();
    return kSteps;
}

/// Returns whether inside is behind both surfaces of a pair, not behind either.
bool isIntersection(const PatchRecord& pair) {
    return (pair.low & 16U) != 0;
}

/// Returns whether a leaf with a surface is inside. \param behind  returns whether the point or box is behind a patch
template <class Behind>
bool isInside(PatchTexels texels, const PatchRecord& leaf, const Behind& behind) {
    if (!leaf.isPair()) {
        return behind(leaf);
    }
    const bool first = behind(patchTexel(texels, leaf.first()));
    return first != isIntersection(leaf) ? first : behind(patchTexel(texels, leaf.first() + 1));
}

PatchVote votePair(PatchTexels texels, const PatchRecord& pair, const glm::vec3& in_cell) {
    const PatchVote a = votePatch(texels, patchTexel(texels, pair.first()), in_cell);
    const PatchVote b = votePatch(texels, patchTexel(texels, pair.first() + 1), in_cell);
    return (isIntersection(pair) ? b.distance > a.distance : b.distance < a.distance) ? b : a;
}

/// Returns whether the roots contain a point; false for NaN. \param p  map space
bool isInRoots(PatchTexels texels, const glm::vec3& p) {
    const glm::vec3 size(patchTreeSize(texels).roots);
    return p.x >= 0.0F && p.y >= 0.0F && p.z >= 0.0F && p.x < size.x && p.y < size.y && p.z < size.z;
}

/// Whether a box in the unit cube of a cell may contain points behind a patch.
bool mayBeBehind(PatchTexels texels, const PatchRecord& patch, const glm::vec3& low, const glm::vec3& high) {
    glm::vec3 least(std::numeric_limits<float>::infinity());
    glm::vec3 most = -least;
    for (unsigned corner = 0; corner < 8; ++corner) {
        const glm::vec3 in_cell((corner & 1U) != 0 ? high.x : low.x, (corner & 2U) != 0 ? high.y : low.y,
                                (corner & 4U) != 0 ? high.z : low.z);
        const glm::vec3 at = patch.frame().across(in_cell);
        least = glm::min(least, at);
        most = glm::max(most, at);
    }
    const std::uint32_t side = patch.side();
    const auto last = static_cast<float>(side - 1);
    const auto first = [&](float at) {
        return static_cast<std::uint32_t>(std::clamp(std::floor(at * last - kBoxMargin), 0.0F, last));
    };
    const auto end = [&](float at) {
        return static_cast<std::uint32_t>(std::clamp(std::ceil(at * last + kBoxMargin), 0.0F, last));
    };
    std::uint8_t lowest = 255;
    std::uint8_t highest = 0;
    for (std::uint32_t row = first(least.y); row <= end(most.y); ++row) {
        for (std::uint32_t column = first(least.x); column <= end(most.x); ++column) {
            const std::uint8_t code = heightCode(texels, patch, row * side + column);
            lowest = std::min(lowest, code);
            highest = std::max(highest, code);
        }
    }
    const PatchHeights heights = heightRange(patch);
    const auto height = [&](std::uint8_t code) {
        return heights.low() + heights.step() * static_cast<float>(code);
    };
    return signOf(patch) > 0.0F ? least.z < height(highest) + kBoxMargin
                                : most.z > height(lowest) - kBoxMargin;
}

/// \param low, high  a box within the unit cube of the record's cell.
bool mayBeInside(PatchTexels texels, const PatchRecord& record, const glm::vec3& low, const glm::vec3& high) {
    if (record.kind() == PatchRecord::Kind::kPatch) {
        return isInside(texels, record,
                        [&](const PatchRecord& patch) { return mayBeBehind(texels, patch, low, high); });
    }
    if (record.kind() != PatchRecord::Kind::kSplit) {
        return record.kind() == PatchRecord::Kind::kInside;
    }
    std::uint32_t child = record.first();
    for (std::uint32_t octant = 0; octant < 8; ++octant) {
        const glm::vec3 at(octant & 1U, octant >> 1U & 1U, octant >> 2U);
        const glm::vec3 octant_low = glm::max(2.0F * low - at, glm::vec3(0.0F));
        const glm::vec3 octant_high = glm::min(2.0F * high - at, glm::vec3(1.0F));
        const bool meets =
            octant_low.x <= octant_high.x && octant_low.y <= octant_high.y && octant_low.z <= octant_high.z;
        if ((record.children() >> octant & 1U) == 0) {
            if (meets && (record.low >> (10U + octant) & 1U) != 0) {
                return true;
            }
            continue;
        }
        if (meets && mayBeInside(texels, patchTexel(texels, child), octant_low, octant_high)) {
            return true;
        }
        ++child;
    }
    return false;
}

template <class Vec, class Real = typename Vec::value_type>
Vec acrossOf(const PatchFrame& frame, const Vec& in_cell) {
    Real a = in_cell[frame.first];
    Real b = in_cell[frame.first == 2 ? 0 : frame.first + 1];
    const Real c = in_cell[frame.first == 0 ? 2 : frame.first - 1];
    a = (frame.mirrored & 1U) != 0 ? Real(1) - a : a;
    b = (frame.mirrored & 2U) != 0 ? Real(1) - b : b;
    if (frame.diagonal == 0) {
        return {b, c, a};
    }
    const Real u = Real(0.5) * (a - b + Real(1));
    return frame.diagonal == 1 ? Vec(u, c, a + b)
                               : Vec(u, Real(0.25) * (a + b - Real(2) * c + Real(2)), a + b + c);
}

tl::unexpected<Error> invalid(std::uint32_t texel, const std::string& text) {
    return invalidInput("texel " + std::to_string(texel) + " " + text);
}

}  // namespace

glm::vec3 PatchFrame::across(const glm::vec3& in_cell) const {
    return acrossOf(*this, in_cell);
}

glm::dvec3 PatchFrame::across(const glm::dvec3& in_cell) const {
    return acrossOf(*this, in_cell);
}

glm::vec3 PatchFrame::gradient(float by_u, float by_v) const {
    glm::vec3 by(1.0F, -by_u, -by_v);  // derivatives with respect to a, b and c of across()
    if (diagonal == 1) {
        by = {1.0F - 0.5F * by_u, 1.0F + 0.5F * by_u, -by_v};
    } else if (diagonal == 2) {
        by = {1.0F - 0.5F * by_u - 0.25F * by_v, 1.0F + 0.5F * by_u - 0.25F * by_v, 1.0F + 0.5F * by_v};
    }
    by.x = (mirrored & 1U) != 0 ? -by.x : by.x;
    by.y = (mirrored & 2U) != 0 ? -by.y : by.y;
    return first == 0 ? by : first == 1 ? glm::vec3(by.z, by.x, by.y) : glm::vec3(by.y, by.z, by.x);
}

const std::array<PatchFrame, 13>& patchFrames() {
    static constexpr std::array<PatchFrame, 13> kFrames = {{{0, 0, 0},
                                                            {0, 1, 0},
                                                            {0, 2, 0},
                                                            {1, 0, 0},
                                                            {1, 1, 0},
                                                            {1, 2, 0},
                                                            {1, 0, 1},
                                                            {1, 1, 1},
                                                            {1, 2, 1},
                                                            {2, 0, 0},
                                                            {2, 0, 1},
                                                            {2, 0, 2},
                                                            {2, 0, 3}}};
    return kFrames;
}

float PatchHeights::step() const {
    return stepsOfScales()[scale];
}

PatchHeights PatchHeights::of(std::span<const double> heights, std::uint32_t side) {
    PatchHeights result;
    result.side = side;
    const auto held = [](double height) { return std::clamp(height, -3.99, 3.99); };
    double lowest = held(heights.front());
    double highest = lowest;
    for (const double height : heights) {
        lowest = std::min(lowest, held(height));
        highest = std::max(highest, held(height));
    }
    result.base = static_cast<int>(std::floor(lowest * 512.0));
    const double range = highest - double{result.low()};
    const auto& steps = stepsOfScales();
    const auto enough = std::partition_point(steps.begin(), steps.end(),
                                             [&](float step) { return 255.0 * double{step} < range; });
    result.scale = static_cast<std::uint8_t>(std::min<std::ptrdiff_t>(enough - steps.begin(), 255));
    for (std::size_t i = 0; i < std::size_t{side} * side; ++i) {
        const double code = (held(heights[i]) - double{result.low()}) / double{result.step()};
        result.codes[i] = static_cast<std::uint8_t>(std::clamp(std::lround(code), 0L, 255L));
    }
    return result;
}

PatchRecord PatchHeights::texel(std::uint32_t index) const {
    PatchRecord record;
    for (std::uint32_t i = 0; i < kPatchTexelBytes; ++i) {
        (i < 4 ? record.low : record.high) |= std::uint32_t{codes[kPatchTexelBytes * index + i]}
                                              << 8U * (i % 4);
    }
    return record;
}

void PatchHeights::decode(std::span<double> out) const {
    for (std::size_t i = 0; i < std::size_t{side} * side; ++i) {
        out[i] = double{low()} + double{step()} * codes[i];
    }
}

PatchFrame PatchRecord::frame() const {
    return {static_cast<std::uint8_t>(low >> 5U & 3U), static_cast<std::uint8_t>(low >> 7U & 3U),
            static_cast<std::uint8_t>(low >> 9U & 3U)};
}

PatchRecord PatchRecord::flat(bool inside, const glm::vec3& normal, float distance) {
    return {(inside ? 1U : 0U) | static_cast<std::uint32_t>(packNormal(encodeNormal(normal))) << 16U,
            bitsOf(distance)};
}

PatchRecord PatchRecord::split(std::uint32_t children, std::uint32_t inside, std::uint32_t first,
                               const glm::vec3& normal, float offset) {
    const auto [s, t] = coarseIndex(normal);
    const auto code = static_cast<std::uint32_t>(
        std::clamp(std::lround(double{offset} * kOffsetZero) + kOffsetZero, 0L, 255L));
    return {2U | children << 2U | inside << 10U | s << 18U | t << 25U, first | code << 24U};
}

PatchRecord PatchRecord::pair(bool both, std::uint32_t first) {
    return {15U | (both ? 16U : 0U), first};
}

PatchRecord PatchRecord::patch(const PatchFrame& frame, bool outside_below, const PatchHeights& heights,
                               std::uint32_t first) {
    const std::uint32_t count = heights.side * heights.side;
    PatchRecord record;
    record.low = 3U |
                 (heights.side == 2   ? 0U
                  : heights.side == 3 ? 1U
                                      : 2U)
                     << 2U |
                 (outside_below ? 16U : 0U) | static_cast<std::uint32_t>(frame.diagonal) << 5U |
                 static_cast<std::uint32_t>(frame.first) << 7U |
                 static_cast<std::uint32_t>(frame.mirrored) << 9U |
                 static_cast<std::uint32_t>(heights.base + kBaseZero) << 11U |
                 static_cast<std::uint32_t>(heights.codes[count - 1]) << 23U;
    record.high = static_cast<std::uint32_t>(heights.scale) << 24U;
    if (heights.side == 2) {
        record.high |= heights.codes[0] | static_cast<std::uint32_t>(heights.codes[1]) << 8U |
                       static_cast<std::uint32_t>(heights.codes[2]) << 16U;
    } else {
        record.high |= first;
    }
    return record;
}

PatchRecord patchTexel(PatchTexels texels, std::uint32_t index) {
    PatchRecord record;
    std::memcpy(&record, texels.data() + std::size_t{index} * kPatchTexelBytes, kPatchTexelBytes);
    return record;
}

PatchHeights patchHeights(PatchTexels texels, const PatchRecord& patch) {
    PatchHeights heights = heightRange(patch);
    for (std::uint32_t i = 0; i < heights.side * heights.side; ++i) {
        heights.codes[i] = heightCode(texels, patch, i);
    }
    return heights;
}

void appendPatchTexel(std::vector<std::byte>& texels, const PatchRecord& record) {
    const auto bytes = std::as_bytes(std::span(&record, 1));
    texels.insert(texels.end(), bytes.begin(), bytes.end());
}

PatchTreeSize patchTreeSize(PatchTexels texels) {
    const PatchRecord head = patchTexel(texels, 0);
    return {{head.low & 0xffffU, head.low >> 16U, head.high & 0xffffU}, head.high >> 16U};
}

double patchSpacing(PatchTexels texels) {
    return std::ldexp(1.0 / (kPatchSideMax - 1), -static_cast<int>(patchTreeSize(texels).levels));
}

PatchMapSize patchMapSize(std::size_t texels) {
    std::uint32_t width = 16;
    while (std::size_t{width} * kMapSizeMax < texels) {
        width *= 2;
    }
    return {width, static_cast<std::uint32_t>((texels + width - 1) / width)};
}

PatchLeaf patchLeafAt(PatchTexels texels, const glm::vec3& p) {
    const auto [roots, levels] = patchTreeSize(texels);
    const glm::vec3 root(std::floor(p.x), std::floor(p.y), std::floor(p.z));
    const glm::uvec3 at(root);
    PatchLeaf leaf{patchTexel(texels, 1 + (at.z * roots.y + at.y) * roots.x + at.x), p - root};
    leaf.inside = leaf.record.kind() == PatchRecord::Kind::kInside;
    for (std::uint32_t level = 0;
         level < levels && leaf.record.kind() == PatchRecord::Kind::kSplit && !leaf.beside; ++level) {
        const glm::vec3 child = 2.0F * leaf.in_cell;
        const std::uint32_t x = child.x >= 1.0F ? 1 : 0;
        const std::uint32_t y = child.y >= 1.0F ? 1 : 0;
        const std::uint32_t z = child.z >= 1.0F ? 1 : 0;
        const std::uint32_t octant = x + 2 * y + 4 * z;
        leaf.beside = (leaf.record.children() >> octant & 1U) == 0;
        if (leaf.beside) {
            leaf.inside = (leaf.record.low >> (10U + octant) & 1U) != 0;
        } else {
            leaf.in_cell = {child.x - static_cast<float>(x), child.y - static_cast<float>(y),
                            child.z - static_cast<float>(z)};
            leaf.cell *= 0.5F;
            const auto before =
                static_cast<std::uint32_t>(std::popcount(leaf.record.children() & ((1U << octant) - 1U)));
            leaf.record = patchTexel(texels, leaf.record.first() + before);
            leaf.inside = leaf.record.kind() == PatchRecord::Kind::kInside;
        }
    }
    return leaf;
}

std::optional<PatchVote> votePatches(PatchTexels texels, const glm::vec3& p) {
    if (!isInRoots(texels, p)) {
        return std::nullopt;
    }
    const PatchLeaf leaf = patchLeafAt(texels, p);
    const PatchRecord& record = leaf.record;
    PatchVote vote;
    if (record.kind() == PatchRecord::Kind::kPatch) {
        vote = record.isPair() ? votePair(texels, record, leaf.in_cell)
                               : votePatch(texels, record, leaf.in_cell);
        vote.distance *= leaf.cell;
    } else if (record.kind() == PatchRecord::Kind::kSplit) {
        vote.normal = octahedron(record.low >> 18U & 127U, record.low >> 25U, kCoarseHalfRange);
        const float offset =
            (static_cast<float>(record.high >> 24U) - float{kOffsetZero}) * (1.0F / float{kOffsetZero});
        vote.distance =
            leaf.cell * onSide(leaf.inside, dot(vote.normal, leaf.in_cell - 0.5F) + offset, kNearest);
    } else {
        vote.normal = decodeNormal(unpackNormal(static_cast<std::uint16_t>(record.low >> 16U)));
        const float distance = floatOf(record.high) + leaf.cell * dot(vote.normal, leaf.in_cell - 0.5F);
        vote.distance = onSide(leaf.inside, distance, leaf.cell * kNearest);
    }
    return vote;
}

bool isOutsidePatches(PatchTexels texels, const glm::vec3& p) {
    if (!isInRoots(texels, p)) {
        return false;
    }
    const PatchLeaf leaf = patchLeafAt(texels, p);
    if (leaf.record.kind() != PatchRecord::Kind::kPatch) {
        return !leaf.inside;
    }
    return !isInside(texels, leaf.record, [&](const PatchRecord& patch) {
        return heightAt(texels, patch, leaf.in_cell).ahead < 0.0F;
    });
}

bool mayBeInsidePatches(PatchTexels texels, const glm::vec3& low, const glm::vec3& high) {
    const glm::uvec3 roots = patchTreeSize(texels).roots;
    const glm::vec3 first = glm::max(glm::floor(low), glm::vec3(0.0F));
    const glm::vec3 last = glm::min(glm::floor(high), glm::vec3(roots) - 1.0F);
    const glm::vec3 count = glm::max(last - first + 1.0F, glm::vec3(0.0F));
    if (!(count.x * count.y * count.z <= kBoxRootsMax)) {
        return true;
    }
    for (float z = first.z; z <= last.z; ++z) {
        for (float y = first.y; y <= last.y; ++y) {
            for (float x = first.x; x <= last.x; ++x) {
                const glm::vec3 at(x, y, z);
                const glm::uvec3 root(at);
                const PatchRecord record =
                    patchTexel(texels, 1 + (root.z * roots.y + root.y) * roots.x + root.x);
                if (mayBeInside(texels, record, glm::max(low - at, glm::vec3(0.0F)),
                                glm::min(high - at, glm::vec3(1.0F)))) {
                    return true;
                }
            }
        }
    }
    return false;
}

Result<void> validatePatches(PatchTexels texels) {
    const std::size_t count = texels.size() / kPatchTexelBytes;
    if (count == 0 || count > kPatchTexelsMax) {
        return invalidInput("its tree of patches has " + std::to_string(count) + " texels; 1 to " +
                            std::to_string(kPatchTexelsMax) + " are allowed");
    }
    const auto [roots, levels] = patchTreeSize(texels);
    const std::uint64_t root_count = std::uint64_t{roots.x} * roots.y * roots.z;
    if (root_count == 0 || levels > kPatchLevelsMax || 1 + root_count > count) {
        return invalid(0, "of its tree of patches declares an invalid size");
    }
    // Check level by level: [at, end) are the records of one level, and the next level begins at `end`.
    std::uint64_t at = 1;
    std::uint64_t end = 1 + root_count;
    std::vector<std::uint32_t> leaves;
    for (std::uint32_t level = 0; at < end; ++level) {
        std::uint64_t next = end;
        for (; at < end; ++at) {
            const auto index = static_cast<std::uint32_t>(at);
            const PatchRecord record = patchTexel(texels, index);
            if (record.kind() == PatchRecord::Kind::kSplit) {
                const auto children = static_cast<std::uint64_t>(std::popcount(record.children()));
                if (level == levels || record.first() != next || next + children > count) {
                    return invalid(index, "is a split cell whose children are not the next texels");
                }
                next += children;
            } else if (record.kind() == PatchRecord::Kind::kPatch) {
                leaves.push_back(index);
            } else if ((record.low >> 16U & 0xffU) == 0xffU || record.low >> 24U == 0xffU) {
                return invalid(index, "has the invalid normal index 255");
            } else if (!std::isfinite(floatOf(record.high))) {
                return invalid(index, "contains a number that is not finite");
            }
        }
        end = next;
    }
    const auto behind = [&](const PatchRecord& record, std::uint32_t used) {
        return record.first() >= end && std::uint64_t{record.first()} + used <= count;
    };
    const auto check = [&](std::uint32_t index) -> Result<void> {
        const PatchRecord record = patchTexel(texels, index);
        const PatchFrame frame = record.frame();
        const std::uint32_t side = record.side();
        if (record.kind() != PatchRecord::Kind::kPatch || side == 0 || frame.diagonal > 2 ||
            frame.first > 2) {
            return invalid(index, "is a patch of an unknown kind");
        }
        if (side > 2 && !behind(record, heightTexels(side))) {
            return invalid(index, "is a patch whose heights are out of place");
        }
        return {};
    };
    for (const std::uint32_t index : leaves) {
        const PatchRecord record = patchTexel(texels, index);
        if (!record.isPair()) {
            RELIEF_TRY(check(index));
            continue;
        }
        if (!behind(record, 2)) {
            return invalid(index, "is a pair whose patches are out of place");
        }
        RELIEF_TRY(check(record.first()));
        RELIEF_TRY(check(record.first() + 1));
    }
    return {};
}

}  // namespace relief

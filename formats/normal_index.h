// SPDX-License-Identifier: Apache-2.0
// Encodes unit vectors in two bytes: the L1 (octahedral) parametrisation of Kolb et al. 2004, section 4.2, equation 3.
#pragma once

#include <array>
#include <cstdint>
#include <glm/vec3.hpp>

namespace relief {

/// Number of index steps from coordinate 0 to coordinate 1.
inline constexpr int kNormalHalfRange = 127;

/// A normal as a pair of 8-bit indices (s, t) into the 256×256 table of normals.
///
/// Index i encodes the coordinate (i − 127)/127 in [−1, 1], so that 0 and the six axis directions are exact. 255 is
/// never written and decodes like 254.
///
///     (s, t) = (127, 127) -> (0, 0, 1)      (254, 127) -> (1, 0, 0)      (127, 0) -> (0, −1, 0)
///     (s, t) = (0, 0)     -> (0, 0, −1), as for the three other corners of the square
struct NormalIndex {
    std::uint8_t s = 127;
    std::uint8_t t = 127;

    friend bool operator==(const NormalIndex&, const NormalIndex&) = default;
};

/// Returns the unit vector of an index. Defined for every pair of bytes; never NaN.
[[nodiscard]] glm::vec3 decodeNormal(NormalIndex index);

/// Returns a table of decodeNormal() by packed index, because a bake decodes millions. Computed on the first call.
[[nodiscard]] const std::array<glm::vec3, 65536>& decodedNormals();

/// Returns the lowest s and t of the four indices around a vector in the square. The other three are one step further
/// along s, t or both.
/// \param normal  any finite nonzero vector.
[[nodiscard]] NormalIndex lowestAround(const glm::vec3& normal);

/// Returns the index whose vector is nearest to `normal` by angle among the four that surround it in the square
/// (Cigolle et al., JCGT 2014, "oct16 precise"). The error is at most 0.64°, against 0.96° for rounding.
/// \param normal  any finite nonzero vector.
[[nodiscard]] NormalIndex encodeNormal(const glm::vec3& normal);

/// Packs both indices into 16 bits, s in the high byte: the red or green channel of a front-back texel.
[[nodiscard]] constexpr std::uint16_t packNormal(NormalIndex index) {
    return static_cast<std::uint16_t>(index.s << 8 | index.t);
}
[[nodiscard]] constexpr NormalIndex unpackNormal(std::uint16_t packed) {
    return {static_cast<std::uint8_t>(packed >> 8), static_cast<std::uint8_t>(packed & 0xff)};
}

}  // namespace relief

// SPDX-License-Identifier: Apache-2.0
// Small colliders for the tests of the container, and the worked example of formats/README.md.
#pragma once

#include <cstddef>
#include <string>
#include <vector>

#include "formats/collider.h"

namespace relief::test {

/// One map of every format, 8 texels wide at most, sparse enough for zstd to shrink each.
[[nodiscard]] Collider oneMapOfEveryFormat();

/// A cube of side 4 about the origin. Octant 7 is split: its octant 0 is of material 2, the others of 1; octant 0 is a pair of
/// sides along x − y, the rest is of material 0.
[[nodiscard]] Materials someMaterials();

/// The worked example of formats/README.md.
[[nodiscard]] Collider readmeExample();

/// The collider's container. The test that asks fails if it cannot be written.
[[nodiscard]] std::vector<std::byte> written(const Collider& collider, int level = 0);

/// Sets a container's checksums to what its bytes say: the metadata's and then the header's.
void mendChecksums(std::vector<std::byte>& bytes);

[[nodiscard]] std::vector<std::byte> toBytes(const std::string& text);

}  // namespace relief::test

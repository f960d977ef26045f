// SPDX-License-Identifier: Apache-2.0
// Small colliders for container tests, and the worked example of formats/README.md.
#pragma once

#include <cstddef>
#include <string>
#include <vector>

#include "formats/collider.h"

namespace relief::test {

/// One map of every format, at most 8 texels wide, sparse enough for zstd to compress.
[[nodiscard]] Collider oneMapOfEveryFormat();

/// A cube of side 4 around the origin. Octant 7 is split: its octant 0 has material 2, the others 1. Octant 0 is a pair
/// of sides along x − y. All other octants have material 0.
[[nodiscard]] Materials someMaterials();

/// The worked example of formats/README.md.
[[nodiscard]] Collider readmeExample();

/// The collider's container. The calling test fails if it cannot be written.
[[nodiscard]] std::vector<std::byte> written(const Collider& collider, int level = 0);

/// Recomputes a container's checksums: the metadata's, then the header's.
void fixChecksums(std::vector<std::byte>& bytes);

[[nodiscard]] std::vector<std::byte> toBytes(const std::string& text);

}  // namespace relief::test

// SPDX-License-Identifier: Apache-2.0
// XXH3 hashes: container checksums, and the content hash of a mesh.
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <string>
#include <string_view>

namespace relief {

[[nodiscard]] std::uint64_t xxh3_64(std::span<const std::byte> bytes);

/// Returns XXH3-128 as 32 lower-case hexadecimal digits, high half first, as `xxhsum -H2` prints it.
[[nodiscard]] std::string xxh3_128Hex(std::span<const std::byte> bytes);
/// Returns whether a text is 32 lower-case hexadecimal digits.
[[nodiscard]] bool isHash(std::string_view text);

}  // namespace relief

// SPDX-License-Identifier: Apache-2.0
// The version of the container format, what readers take at most, and how a payload lies in a file.
#pragma once

#include <cstddef>
#include <cstdint>
#include <limits>

namespace relief {

inline constexpr std::uint16_t kContainerMajor = 2;
inline constexpr std::uint16_t kContainerMinor = 0;

/// Of texels to their file: accepted by default. Ordinary maps shrink to a third or a fifth.
inline constexpr std::uint64_t kUnpackedPerStored = 16;

struct ContainerLimits {
    std::uint32_t maps = 1024;
    /// Of all maps together, uncompressed. A machine of 32 bits (WebAssembly) has room for less.
    std::uint64_t texel_bytes = std::uint64_t{1} << (sizeof(std::size_t) == 4 ? 29 : 31);
    /// What texels may take in memory whatever the size of their file. Beyond it they may take kUnpackedPerStored times
    /// their file: a file of 66 kB can claim 2 GiB. The tools lower it (runtime/command_line/option_values.h).
    std::uint64_t memory = std::numeric_limits<std::uint64_t>::max();
};

/// How a map's texels lie in a file.
enum class Packing : std::uint8_t {
    kNone = 0,  ///< as they are
    kZstd = 1,  ///< a zstd frame
};

[[nodiscard]] const char* packingName(Packing packing);  ///< "none" or "zstd"

/// How each payload lies in a file; for `relief info`.
struct PayloadInfo {
    std::uint64_t offset = 0;
    std::uint64_t stored_size = 0;
    std::uint64_t raw_size = 0;
    Packing packing = Packing::kNone;
};

}  // namespace relief

// SPDX-License-Identifier: Apache-2.0
// Version of the container format, limits of readers, and the storage of payloads.
#pragma once

#include <cstddef>
#include <cstdint>
#include <limits>

namespace relief {

inline constexpr std::uint16_t kContainerMajor = 2;
inline constexpr std::uint16_t kContainerMinor = 0;

/// Limit on the ratio of texel bytes to file size, applied above ContainerLimits::memory. Typical maps compress to
/// between a third and a fifth.
inline constexpr std::uint64_t kUnpackedPerStored = 16;

struct ContainerLimits {
    std::uint32_t maps = 1024;
    /// Total of all maps, uncompressed. Lower on 32-bit platforms (WebAssembly).
    std::uint64_t texel_bytes = std::uint64_t{1} << (sizeof(std::size_t) == 4 ? 29 : 31);
    /// Texel bytes accepted regardless of file size. More are accepted only up to kUnpackedPerStored times the file
    /// size, because a 66 kB file can claim 2 GiB. The tools set a lower value (runtime/command_line/option_values.h).
    std::uint64_t memory = std::numeric_limits<std::uint64_t>::max();
};

/// Encoding of a map's texels in a file.
enum class Packing : std::uint8_t {
    kNone = 0,  ///< uncompressed
    kZstd = 1,  ///< a zstd frame
};

[[nodiscard]] const char* packingName(Packing packing);  ///< "none" or "zstd"

/// Location and encoding of a payload; for `relief info`.
struct PayloadInfo {
    std::uint64_t offset = 0;
    std::uint64_t stored_size = 0;
    std::uint64_t raw_size = 0;
    Packing packing = Packing::kNone;
};

}  // namespace relief

// The version of the container format, what readers take at most, and how a payload lies in a file.
#pragma once

#include <cstdint>

namespace relief {

inline constexpr std::uint16_t kContainerMajor = 1;
inline constexpr std::uint16_t kContainerMinor = 0;

struct ContainerLimits {
    std::uint32_t maps = 1024;
    std::uint64_t texel_bytes = std::uint64_t{2} << 30;  ///< of all maps together, uncompressed
};

/// How each payload lies in a file; for `relief info`.
struct PayloadInfo {
    std::uint64_t offset = 0;
    std::uint64_t stored_size = 0;
    std::uint64_t raw_size = 0;
    bool compressed = false;
};

}  // namespace relief

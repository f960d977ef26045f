// The steps of reading a container. None believes what another has not checked. container.cpp takes them in
// order and stops at the first that fails; inspect.cpp goes on, and says what is left of a damaged file.
#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "formats/base/result.h"
#include "formats/collider.h"
#include "formats/container_limits.h"

namespace relief {

inline constexpr std::uint64_t kPayloadAlignment = 64;  ///< bytes

/// The offset of a payload behind something that ends at `end`.
[[nodiscard]] constexpr std::uint64_t alignPayload(std::uint64_t end) {
    return (end + kPayloadAlignment - 1) / kPayloadAlignment * kPayloadAlignment;
}

/// The longest file that readContainer could take: payloads are never longer than their texels.
[[nodiscard]] std::uint64_t containerSizeMax(const ContainerLimits& limits);

/// What is wrong with texels of so many bytes in a file of so many; nothing: they may be unpacked.
[[nodiscard]] std::optional<std::string> texelsBeyond(const ContainerLimits& limits,
                                                      std::uint64_t texel_bytes, std::uint64_t file_size);

/// One payload in a file, and how to check it.
struct StoredPayload {
    PayloadInfo info;
    std::uint64_t hash = 0;
};

/// A map as the metadata has it; no value has been checked.
struct ParsedMap {
    DepthMap frame;  ///< no texels; its enums, and the payload's packing, may be out of range
    StoredPayload payload;
};

/// Metadata that is a table of a collider; no value has been checked.
struct ParsedMetadata {
    Collider collider;  ///< without maps
    std::vector<ParsedMap> maps;
};

/// \param bytes  the metadata, at any alignment.
/// Errors: kInvalidInput (the FlatBuffers verifier refuses it), kLimit (more than `maps_max` maps).
/// Throws std::bad_alloc.
[[nodiscard]] Result<ParsedMetadata> parseMetadata(std::span<const std::byte> bytes, std::uint32_t maps_max);

/// Checks that a payload's sizes go with its frame, which must be valid. Its place is not looked at.
/// Errors: kInvalidInput, without the map's index.
[[nodiscard]] Result<void> validatePayloadSizes(const ParsedMap& map);

/// The texels of a payload: all of them, whatever its packing.
/// \param map  passed validateFrame and validatePayloadSizes: raw_size bytes are taken.
/// Errors: kInvalidInput, without the map's index. Throws std::bad_alloc.
[[nodiscard]] Result<std::vector<std::byte>> unpackPayload(std::span<const std::byte> stored,
                                                           const ParsedMap& map);

}  // namespace relief

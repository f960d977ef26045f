// SPDX-License-Identifier: Apache-2.0
// The one walk over a container. Each step checks before it believes, and notes what is wrong as an issue. Loading
// (container.cpp) refuses a file with any error; inspect.cpp reports all of them, and what is left of the file.
#pragma once

#include <array>
#include <bit>
#include <cstddef>
#include <cstdint>
#include <new>
#include <optional>
#include <span>
#include <stdexcept>
#include <string>
#include <vector>

#include "formats/base/hash.h"
#include "formats/base/result.h"
#include "formats/collider.h"
#include "formats/container_limits.h"
#include "formats/issue.h"

namespace relief {

/// The first 64 bytes (README.md beside this file, "Bytes"), as they lie in the file.
struct ContainerHeader {
    /// «RELIEF» in Latin-1, then bytes that a transfer as text would change.
    static constexpr std::array<std::uint8_t, 12> kSignature = {0xab, 'R',  'E',  'L',  'I',  'E',
                                                                'F',  0xbb, 0x0d, 0x0a, 0x1a, 0x0a};

    std::array<std::uint8_t, 12> signature = kSignature;
    std::uint16_t major = kContainerMajor;
    std::uint16_t minor = kContainerMinor;
    std::uint32_t header_size = 64;
    std::uint32_t reserved = 0;
    std::uint64_t file_size = 0;
    std::uint64_t metadata_offset = 64;
    std::uint64_t metadata_size = 0;
    std::uint64_t metadata_hash = 0;  ///< XXH3-64 of the metadata
    std::uint64_t header_hash = 0;    ///< XXH3-64 of the 56 bytes before it

    /// What header_hash has to be.
    [[nodiscard]] std::uint64_t computeHash() const {
        return xxh3_64(std::as_bytes(std::span(this, 1)).first(offsetof(ContainerHeader, header_hash)));
    }
};
static_assert(std::endian::native == std::endian::little,
              "containers are little-endian and copied as they are");
static_assert(sizeof(ContainerHeader) == 64);
static_assert(offsetof(ContainerHeader, file_size) == 24 && offsetof(ContainerHeader, header_hash) == 56);

inline constexpr std::uint64_t kContainerMetadataMax = std::uint64_t{16} << 20;  ///< bytes

inline constexpr std::uint64_t kPayloadAlignment = 64;  ///< bytes

/// The offset of a payload behind something that ends at `end`.
[[nodiscard]] constexpr std::uint64_t alignPayload(std::uint64_t end) {
    return (end + kPayloadAlignment - 1) / kPayloadAlignment * kPayloadAlignment;
}

/// The longest file that readContainer could take: payloads are never longer than their texels.
[[nodiscard]] std::uint64_t containerSizeMax(const ContainerLimits& limits);

/// A map as the metadata has it.
struct StoredMap {
    DepthMap frame;  ///< no texels before readTexels(); any value where `framed` is false
    PayloadInfo payload;
    std::uint64_t hash = 0;
    bool framed = false;  ///< the frame is valid
    bool readable =
        false;  ///< so are the payload's sizes, it lies within the file, and the texels within the limits
    bool intact = false;  ///< after readTexels(): the payload's checksum is right
};

/// Holds on to `bytes`. Throws std::bad_alloc and std::length_error (withinMemory).
class ContainerReader {
  public:
    ContainerReader(std::span<const std::byte> bytes, const ContainerLimits& limits)
        : bytes_(bytes), limits_(limits) {}

    /// Header, metadata, frames, and the sizes and places of payloads, none of which is looked at.
    void readDescription();

    /// \param index  of a map that is `readable`. \return whether its texels are valid.
    bool readTexels(std::size_t index);

    /// The error of loading, by the issues found so far; nothing where they are warnings at most.
    [[nodiscard]] std::optional<Error> refusal() const;

    void add(IssueCode code, std::string message, std::optional<std::uint64_t> offset = {}, int map = -1);

    ContainerHeader header{.major = 0,
                           .minor = 0};  ///< as it lies in the file; of version 0.0 where it was not read
    PartState header_state = PartState::kUnreadable;
    PartState metadata_state = PartState::kUnreadable;
    bool metadata_intact = false;  ///< its checksum is right
    bool bounds_valid = false;
    Collider collider;  ///< without maps
    std::vector<StoredMap> maps;
    std::vector<Issue> issues;        ///< in the order of the file, but that those of payloads come last
    std::size_t first_map_issue = 0;  ///< those before it are of header and metadata

  private:
    [[nodiscard]] bool readHeader();
    [[nodiscard]] bool checkSizes();
    [[nodiscard]] bool readMetadata();
    void checkDescription();
    void checkMaps();
    [[nodiscard]] bool checkFrame(StoredMap& map, int index);
    [[nodiscard]] bool checkPlace(const PayloadInfo& payload, int index, std::uint64_t end);

    /// Bytes that were found to lie within the file.
    [[nodiscard]] std::span<const std::byte> part(std::uint64_t offset, std::uint64_t size) const {
        return bytes_.subspan(static_cast<std::size_t>(offset), static_cast<std::size_t>(size));
    }

    std::span<const std::byte> bytes_;
    ContainerLimits limits_;
    bool header_intact_ = false;
};

/// How to get a file that loads, to append to the issue's message; "" if that names it.
/// \param major  of the file.
[[nodiscard]] std::string cureOf(IssueCode code, std::uint16_t major);

/// kUnsupported for another major version, kLimit if limits are all that is wrong, else kInvalidInput.
[[nodiscard]] ErrorCode errorCodeOf(std::span<const Issue> issues);

/// Runs f; an allocation that fails, or is too large to be tried, becomes an Error.
template <class F>
auto withinMemory(F f) -> decltype(f()) {
    const auto error = [] {
        return fail(ErrorCode::kLimit, "the collider does not fit into memory; use fewer or smaller maps");
    };
    try {
        return f();
    } catch (const std::bad_alloc&) {
        return error();
    } catch (const std::length_error&) {
        return error();
    }
}

}  // namespace relief

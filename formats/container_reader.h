// SPDX-License-Identifier: Apache-2.0
// The library's only parser of containers. Each step validates before use and records every problem as an issue.
// Loading (container.cpp) rejects a file with any error; inspect.cpp reports all issues and what is still readable.
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

/// The first 64 bytes, in file layout (README.md in this folder, "Bytes").
struct ContainerHeader {
    /// «RELIEF» in Latin-1, then bytes that a text-mode transfer would change.
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
    std::uint64_t header_hash = 0;    ///< XXH3-64 of the preceding 56 bytes

    /// Returns the correct value of header_hash.
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

/// Returns the offset of a payload that follows data ending at `end`.
[[nodiscard]] constexpr std::uint64_t alignPayload(std::uint64_t end) {
    return (end + kPayloadAlignment - 1) / kPayloadAlignment * kPayloadAlignment;
}

/// Returns the maximum size of a file that readContainer accepts, with all payloads uncompressed.
[[nodiscard]] std::uint64_t containerSizeMax(const ContainerLimits& limits);

/// Map metadata.
struct StoredMap {
    DepthMap frame;  ///< the map, without texels before readTexels(); invalid if `framed` is false
    PayloadInfo payload;
    std::uint64_t hash = 0;
    bool framed = false;  ///< `frame` is valid
    /// `framed` is true, the payload has valid sizes and lies within the file, and the texels are within the limits.
    bool readable = false;
    bool intact = false;  ///< set by readTexels(): the payload's checksum matches
};

/// Borrows `bytes`. Throws std::bad_alloc and std::length_error; see withinMemory().
class ContainerReader {
  public:
    ContainerReader(std::span<const std::byte> bytes, const ContainerLimits& limits)
        : bytes_(bytes), limits_(limits) {}

    /// Reads the header and the metadata. Checks the sizes and offsets of payloads, but not their contents.
    void readDescription();

    /// Reads the texels of a map. \param index  of a `readable` map. \return whether the texels are valid.
    bool readTexels(std::size_t index);

    /// Returns the load error for the issues found so far; nullopt if there are only warnings.
    [[nodiscard]] std::optional<Error> refusal() const;

    void add(IssueCode code, std::string message, std::optional<std::uint64_t> offset = {}, int map = -1);

    ContainerHeader header{.major = 0, .minor = 0};  ///< as in the file; version 0.0 if it was not read
    PartState header_state = PartState::kUnreadable;
    PartState metadata_state = PartState::kUnreadable;
    bool metadata_intact = false;  ///< its checksum matches
    bool bounds_valid = false;
    Collider collider;  ///< without maps
    std::vector<StoredMap> maps;
    std::vector<Issue> issues;  ///< in file order, except that those of readTexels() come last
    /// Index of the first issue of a map; earlier ones concern header and metadata.
    std::size_t first_map_issue = 0;

  private:
    [[nodiscard]] bool readHeader();
    [[nodiscard]] bool checkSizes();
    [[nodiscard]] bool readMetadata();
    void checkDescription();
    void checkMaps();
    [[nodiscard]] bool checkFrame(StoredMap& map, int index);
    [[nodiscard]] bool checkPlace(const PayloadInfo& payload, int index, std::uint64_t end);

    /// Returns a range that was already checked against the file size.
    [[nodiscard]] std::span<const std::byte> part(std::uint64_t offset, std::uint64_t size) const {
        return bytes_.subspan(static_cast<std::size_t>(offset), static_cast<std::size_t>(size));
    }

    std::span<const std::byte> bytes_;
    ContainerLimits limits_;
    bool header_intact_ = false;
};

/// Returns the fix to append to an issue's message; "" if the message already includes it.
/// \param major  format version of the file.
[[nodiscard]] std::string fixFor(IssueCode code, std::uint16_t major);

/// Returns kUnsupported for another major version, kLimit if every error is an exceeded limit, else kInvalidInput.
[[nodiscard]] ErrorCode errorCodeOf(std::span<const Issue> issues);

/// Runs f and converts an allocation failure into an Error.
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

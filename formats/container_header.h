// The first 64 bytes of a `.relief` container (README.md beside this file, "Bytes").
#pragma once

#include <array>
#include <bit>
#include <cstddef>
#include <cstdint>
#include <span>

#include "formats/base/hash.h"
#include "formats/container_limits.h"

namespace relief {

/// As it lies in the file.
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

}  // namespace relief

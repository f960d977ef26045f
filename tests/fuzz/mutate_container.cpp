// SPDX-License-Identifier: Apache-2.0
// Mutations of a format with checksums are rejected early. So most mutants get correct checksums, to reach the code
// behind.
#include <cstring>
#include <span>

#include "collider_generated.h"
#include "formats/base/hash.h"
#include "formats/container_reader.h"

namespace {

using relief::ContainerHeader;

/// Corrects the payload checksums in the metadata, if it can be read.
void fixPayloadChecksums(std::span<std::uint8_t> bytes, const ContainerHeader& header) {
    std::uint8_t* metadata = bytes.data() + header.metadata_offset;
    // FlatBuffers requires the file's alignment, which the vector has.
    flatbuffers::Verifier verifier(metadata, header.metadata_size);
    if (!relief::fb::VerifyColliderBuffer(verifier)) {
        return;
    }
    for (const relief::fb::Map* map : *relief::fb::GetCollider(metadata)->maps()) {
        const relief::fb::Payload& payload = *map->payload();
        if (payload.offset() > bytes.size() || payload.stored_size() > bytes.size() - payload.offset()) {
            continue;
        }
        const std::uint64_t hash =
            relief::xxh3_64(std::as_bytes(std::span(bytes)).subspan(payload.offset(), payload.stored_size()));
        constexpr std::size_t kHashAt = 24;  // the fourth of four 64-bit numbers (collider.fbs)
        static_assert(sizeof(relief::fb::Payload) == 32);
        const std::size_t at =
            static_cast<std::size_t>(reinterpret_cast<const std::uint8_t*>(&payload) - bytes.data());
        std::memcpy(bytes.data() + at + kHashAt, &hash, sizeof(hash));
    }
}

/// Corrects the size and every checksum.
void fixChecksums(std::span<std::uint8_t> bytes) {
    ContainerHeader header;
    if (bytes.size() < sizeof(header)) {
        return;
    }
    std::memcpy(&header, bytes.data(), sizeof(header));
    header.file_size = bytes.size();
    if (header.metadata_offset == sizeof(header) && header.metadata_size <= bytes.size() - sizeof(header)) {
        fixPayloadChecksums(bytes, header);
        header.metadata_hash = relief::xxh3_64(
            std::as_bytes(std::span(bytes)).subspan(header.metadata_offset, header.metadata_size));
    }
    header.header_hash = header.computeHash();
    std::memcpy(bytes.data(), &header, sizeof(header));
}

}  // namespace

// Provided by libFuzzer.
extern "C" std::size_t LLVMFuzzerMutate(std::uint8_t* data, std::size_t size, std::size_t max_size);

extern "C" std::size_t LLVMFuzzerCustomMutator(std::uint8_t* data, std::size_t size, std::size_t max_size,
                                               unsigned seed) {
    const std::size_t new_size = LLVMFuzzerMutate(data, size, max_size);
    if (seed % 8 != 0) {
        fixChecksums({data, new_size});
    }
    return new_size;
}

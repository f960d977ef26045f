#include "formats/container_header.h"

#include <algorithm>
#include <bit>
#include <cstring>
#include <string>

#include "formats/base/hash.h"

namespace relief {
namespace {

static_assert(std::endian::native == std::endian::little,
              "containers are little-endian and copied as they are");

constexpr std::ptrdiff_t kTextSafeSignatureSize = 8;

Result<void> checkSignature(const ContainerHeader& header) {
    const auto& expected = ContainerHeader::kSignature;
    if (header.signature == expected) {
        return {};
    }
    if (std::equal(expected.begin(), expected.begin() + kTextSafeSignatureSize, header.signature.begin())) {
        return invalidInput(
            "bytes 8...11 of the signature are wrong: the file was changed, perhaps by a transfer as text; "
            "copy it again as binary");
    }
    return invalidInput("it is no .relief container: bytes 0...11 are not its signature");
}

Result<void> checkFields(const ContainerHeader& header, std::uint64_t size) {
    const ContainerHeader expected;
    if (header.header_size != expected.header_size || header.reserved != expected.reserved ||
        header.metadata_offset != expected.metadata_offset) {
        return invalidInput(
            "header_size, reserved or metadata_offset (bytes 16...23 and 32...39) are not those of "
            "version " +
            std::to_string(kContainerMajor));
    }
    if (header.file_size > size) {
        return invalidInput("truncated: " + std::to_string(size) + " of " + std::to_string(header.file_size) +
                            " bytes; copy the file again");
    }
    if (header.file_size < size) {
        return invalidInput(std::to_string(size - header.file_size) + " bytes follow its end at byte " +
                            std::to_string(header.file_size) + "; copy the file again");
    }
    if (header.metadata_size > kContainerMetadataMax) {
        return fail(ErrorCode::kLimit, "metadata_size at byte 40 is " + std::to_string(header.metadata_size) +
                                           ", at most " + std::to_string(kContainerMetadataMax) +
                                           " are allowed");
    }
    if (header.metadata_size > size - sizeof(ContainerHeader)) {
        return invalidInput("metadata_size at byte 40 is " + std::to_string(header.metadata_size) +
                            ", beyond the end of the file");
    }
    return {};
}

}  // namespace

std::uint64_t ContainerHeader::computeHash() const {
    return xxh3_64(std::as_bytes(std::span(this, 1)).first(offsetof(ContainerHeader, header_hash)));
}

Result<ContainerHeader> readContainerHeader(std::span<const std::byte> bytes) {
    ContainerHeader header;
    if (bytes.size() < sizeof(header)) {
        return invalidInput("truncated, or no .relief container: " + std::to_string(bytes.size()) +
                            " of at least " + std::to_string(sizeof(header)) + " bytes");
    }
    std::memcpy(&header, bytes.data(), sizeof(header));
    RELIEF_TRY(checkSignature(header));
    if (header.major != kContainerMajor) {
        return fail(ErrorCode::kUnsupported, "it is of container version " + std::to_string(header.major) +
                                                 "." + std::to_string(header.minor) +
                                                 ", this program reads version " +
                                                 std::to_string(kContainerMajor) + "; use a matching Relief");
    }
    if (header.header_hash != header.computeHash()) {
        return invalidInput("damaged: the checksum at byte 56 is not that of the header");
    }
    RELIEF_TRY(checkFields(header, bytes.size()));
    return header;
}

}  // namespace relief

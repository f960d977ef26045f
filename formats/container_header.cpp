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

tl::unexpected<Error> invalid(std::string message) {
    return fail(ErrorCode::kInvalidInput, std::move(message));
}

std::string decimal(std::uint64_t value) {
    return std::to_string(value);
}

Result<void> checkSignature(const ContainerHeader& header) {
    const auto& expected = ContainerHeader::kSignature;
    if (header.signature == expected) {
        return {};
    }
    if (std::equal(expected.begin(), expected.begin() + kTextSafeSignatureSize, header.signature.begin())) {
        return invalid(
            "bytes 8...11 of the signature are wrong: the file was changed, perhaps by a transfer as text; "
            "copy it again as binary");
    }
    return invalid("it is no .relief container: bytes 0...11 are not its signature");
}

Result<void> checkFields(const ContainerHeader& header, std::uint64_t size) {
    const ContainerHeader expected;
    if (header.header_size != expected.header_size || header.reserved != expected.reserved ||
        header.metadata_offset != expected.metadata_offset) {
        return invalid(
            "header_size, reserved or metadata_offset (bytes 16...23 and 32...39) are not those of "
            "version " +
            decimal(kContainerMajor));
    }
    if (header.file_size > size) {
        return invalid("truncated: " + decimal(size) + " of " + decimal(header.file_size) +
                       " bytes; copy the file again");
    }
    if (header.file_size < size) {
        return invalid(decimal(size - header.file_size) + " bytes follow its end at byte " +
                       decimal(header.file_size) + "; copy the file again");
    }
    if (header.metadata_size > kContainerMetadataMax) {
        return fail(ErrorCode::kLimit, "metadata_size at byte 40 is " + decimal(header.metadata_size) +
                                           ", at most " + decimal(kContainerMetadataMax) + " are allowed");
    }
    if (header.metadata_size > size - sizeof(ContainerHeader)) {
        return invalid("metadata_size at byte 40 is " + decimal(header.metadata_size) +
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
        return invalid("truncated, or no .relief container: " + decimal(bytes.size()) + " of at least " +
                       decimal(sizeof(header)) + " bytes");
    }
    std::memcpy(&header, bytes.data(), sizeof(header));
    RELIEF_TRY(checkSignature(header));
    if (header.major != kContainerMajor) {
        return fail(ErrorCode::kUnsupported, "it is of container version " + decimal(header.major) + "." +
                                                 decimal(header.minor) + ", this program reads version " +
                                                 decimal(kContainerMajor) + "; use a matching Relief");
    }
    if (header.header_hash != header.computeHash()) {
        return invalid("damaged: the checksum at byte 56 is not that of the header");
    }
    RELIEF_TRY(checkFields(header, bytes.size()));
    return header;
}

}  // namespace relief

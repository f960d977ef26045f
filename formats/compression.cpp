// SPDX-License-Identifier: Apache-2.0
#include "formats/compression.h"

#include <zstd.h>

#include <string>

namespace relief {

Result<std::vector<std::byte>> compress(std::span<const std::byte> raw, int level) {
    std::vector<std::byte> bytes(ZSTD_compressBound(raw.size()));
    const std::size_t size = ZSTD_compress(bytes.data(), bytes.size(), raw.data(), raw.size(), level);
    if (ZSTD_isError(size) != 0) {
        return fail(ErrorCode::kFailure,
                    std::string("zstd could not compress it: ") + ZSTD_getErrorName(size));
    }
    bytes.resize(size);
    bytes.shrink_to_fit();
    return bytes;
}

Result<std::vector<std::byte>> decompress(std::span<const std::byte> stored, std::uint64_t raw_size) {
    if (ZSTD_getFrameContentSize(stored.data(), stored.size()) != raw_size) {
        return invalidInput("its payload is not a zstd frame with a content size of " +
                            std::to_string(raw_size) + " bytes");
    }
    if (ZSTD_findFrameCompressedSize(stored.data(), stored.size()) != stored.size()) {
        return invalidInput("its payload is not exactly one zstd frame");
    }
    std::vector<std::byte> raw(static_cast<std::size_t>(raw_size));
    const std::size_t size = ZSTD_decompress(raw.data(), raw.size(), stored.data(), stored.size());
    if (ZSTD_isError(size) != 0) {
        return invalidInput(std::string("its payload cannot be decompressed: ") + ZSTD_getErrorName(size));
    }
    if (size != raw_size) {
        return invalidInput("its payload decompresses to " + std::to_string(size) + " bytes, not " +
                            std::to_string(raw_size));
    }
    return raw;
}

}  // namespace relief

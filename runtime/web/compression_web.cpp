// zstd in a browser: the page's decoder.
#include <string>

#include "formats/compression.h"

extern "C" int relief_js_decompress(const void* stored, int stored_size, void* raw, int raw_size);

namespace relief {

Result<std::vector<std::byte>> compress(std::span<const std::byte>, int) {
    return fail(ErrorCode::kUnsupported, "a browser compresses nothing; write the collider without zstd");
}

Result<std::vector<std::byte>> decompress(std::span<const std::byte> stored, std::uint64_t raw_size) {
    std::vector<std::byte> raw(static_cast<std::size_t>(raw_size));
    const int size = relief_js_decompress(stored.data(), static_cast<int>(stored.size()), raw.data(),
                                          static_cast<int>(raw.size()));
    if (size < 0) {
        return invalidInput("its payload is no zstd frame, or does not decompress");
    }
    if (static_cast<std::size_t>(size) != raw.size()) {
        return invalidInput("its payload decompresses to " + std::to_string(size) + " bytes, not " +
                            std::to_string(raw_size));
    }
    return raw;
}

}  // namespace relief

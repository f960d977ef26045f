// SPDX-License-Identifier: Apache-2.0
#include "formats/base/hash.h"

#include <xxhash.h>

#include <cinttypes>
#include <cstdio>

namespace relief {

std::uint64_t xxh3_64(std::span<const std::byte> bytes) {
    return XXH3_64bits(bytes.data(), bytes.size());
}

std::string xxh3_128Hex(std::span<const std::byte> bytes) {
    const XXH128_hash_t hash = XXH3_128bits(bytes.data(), bytes.size());
    char text[33];
    std::snprintf(text, sizeof(text), "%016" PRIx64 "%016" PRIx64, static_cast<std::uint64_t>(hash.high64),
                  static_cast<std::uint64_t>(hash.low64));
    return text;
}

bool isHash(std::string_view text) {
    return text.size() == 32 && text.find_first_not_of("0123456789abcdef") == std::string_view::npos;
}

}  // namespace relief

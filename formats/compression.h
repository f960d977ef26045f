// SPDX-License-Identifier: Apache-2.0
// Converts texels to and from a zstd frame (RFC 8878). compression.cpp uses libzstd; runtime/web/stand_ins.cpp uses the
// decoder of the page.
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include "formats/base/result.h"

namespace relief {

/// Compresses into one frame that stores its content size.
/// \param level  1…19
/// Errors: kFailure (with zstd's message), kUnsupported (in the browser).
[[nodiscard]] Result<std::vector<std::byte>> compress(std::span<const std::byte> raw, int level);

/// Decompresses one frame.
/// \param stored    untrusted.
/// \param raw_size  exact decompressed size in bytes.
/// Errors: kInvalidInput (not exactly one frame, or a different size).
[[nodiscard]] Result<std::vector<std::byte>> decompress(std::span<const std::byte> stored,
                                                        std::uint64_t raw_size);

}  // namespace relief

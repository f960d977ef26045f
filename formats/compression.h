// SPDX-License-Identifier: Apache-2.0
// Texels as a zstd frame (RFC 8878). compression.cpp uses libzstd, web/compression.cpp the page's own decoder.
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include "formats/base/result.h"

namespace relief {

/// One frame that states its content's size.
/// \param level  1…19
/// Errors: kFailure (zstd's words), kUnsupported (in the browser).
[[nodiscard]] Result<std::vector<std::byte>> compress(std::span<const std::byte> raw, int level);

/// \param stored    untrusted.
/// \param raw_size  what it must decompress to, exactly.
/// Errors: kInvalidInput (no frame, more than one, or one of another content).
[[nodiscard]] Result<std::vector<std::byte>> decompress(std::span<const std::byte> stored,
                                                        std::uint64_t raw_size);

}  // namespace relief

// Bytes as text, for pages that hold everything themselves.
#pragma once

#include <cstddef>
#include <span>
#include <string>

namespace relief {

/// RFC 4648, with padding and without line ends.
[[nodiscard]] std::string base64(std::span<const std::byte> bytes);

}  // namespace relief

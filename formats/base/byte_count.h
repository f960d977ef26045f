// Numbers of bytes as people write them.
#pragma once

#include <cstdint>
#include <optional>
#include <string_view>

namespace relief {

/// "4MB", "0.25 MB", "512kB", "1MiB", "65536", "64B": kB, MB and GB are powers of 1000, KiB, MiB and GiB of
/// 1024; the case of letters does not matter. Rounded down to whole bytes.
/// \return nullopt for anything else, for less than one byte, and beyond 2^53.
[[nodiscard]] std::optional<std::uint64_t> parseByteCount(std::string_view text);

}  // namespace relief

// SPDX-License-Identifier: Apache-2.0
// Builds the bytes of a binary little-endian PLY, in file order.
#pragma once

#include <cstddef>
#include <cstdint>
#include <string_view>
#include <utility>
#include <vector>

namespace relief {

class PlyBytes {
  public:
    void text(std::string_view text) {
        for (const char c : text) {
            byte(static_cast<std::uint8_t>(c));
        }
    }
    void byte(std::uint8_t value) { bytes_.push_back(static_cast<std::byte>(value)); }
    void word(std::uint32_t word) {
        for (int shift = 0; shift < 32; shift += 8) {
            byte(static_cast<std::uint8_t>(word >> shift & 0xffU));
        }
    }
    void number(float value) { word(__builtin_bit_cast(std::uint32_t, value)); }
    void reserve(std::size_t bytes) { bytes_.reserve(bytes); }
    [[nodiscard]] std::vector<std::byte> take() { return std::move(bytes_); }

  private:
    std::vector<std::byte> bytes_;
};

}  // namespace relief

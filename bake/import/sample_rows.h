// SPDX-License-Identifier: Apache-2.0
// Reads the samples of a height map row by row, from the first row.
#pragma once

#include <cstdint>
#include <span>

#include "formats/base/result.h"

namespace relief {

inline constexpr std::uint32_t kHeightsSideMax = 1U << 24;  ///< samples per row

class SampleRows {
  public:
    SampleRows() = default;
    SampleRows(const SampleRows&) = delete;
    SampleRows& operator=(const SampleRows&) = delete;
    virtual ~SampleRows() = default;

    [[nodiscard]] std::uint64_t columns() const { return columns_; }
    [[nodiscard]] std::uint64_t rows() const { return rows_; }
    /// Maximum possible value of unsigned samples; 0 for other types, which are heights in metres.
    [[nodiscard]] std::uint32_t most() const { return most_; }

    /// Reads the next row, which must exist.
    /// \param out  columns() samples; NaN is a hole.
    /// Errors, without the file name: kInvalidInput, kUnsupported.
    [[nodiscard]] virtual Result<void> next(std::span<float> out) = 0;

  protected:
    std::uint64_t columns_ = 0;
    std::uint64_t rows_ = 0;
    std::uint32_t most_ = 0;
};

}  // namespace relief

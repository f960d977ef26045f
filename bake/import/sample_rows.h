// SPDX-License-Identifier: Apache-2.0
// The samples of a height map as its file has them, one row after the other from the first.
#pragma once

#include <cstdint>
#include <span>

#include "formats/base/result.h"

namespace relief {

inline constexpr std::uint32_t kHeightsSideMax = 1U << 24;  ///< samples in a row

class SampleRows {
  public:
    SampleRows() = default;
    SampleRows(const SampleRows&) = delete;
    SampleRows& operator=(const SampleRows&) = delete;
    virtual ~SampleRows() = default;

    [[nodiscard]] std::uint64_t columns() const { return columns_; }
    [[nodiscard]] std::uint64_t rows() const { return rows_; }
    /// The largest whole number that a sample may be; 0: samples are heights.
    [[nodiscard]] std::uint32_t most() const { return most_; }

    /// \param out  columns() samples of the next row; NaN is a hole. There must be such a row.
    /// Errors, without the file's name: kInvalidInput, kUnsupported.
    [[nodiscard]] virtual Result<void> next(std::span<float> out) = 0;

  protected:
    std::uint64_t columns_ = 0;
    std::uint64_t rows_ = 0;
    std::uint32_t most_ = 0;
};

}  // namespace relief

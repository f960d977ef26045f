// SPDX-License-Identifier: Apache-2.0
// A height map from its file, row by row: PNG and EXR, decoded by a process of their own, or raw samples.
#pragma once

#include <algorithm>
#include <array>
#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <limits>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "bake/heights/heights_spec.h"
#include "bake/import/import_job.h"
#include "bake/import/sample_rows.h"
#include "formats/base/descriptor.h"
#include "formats/base/result.h"

namespace relief {

inline constexpr std::uint64_t kHeightSamplesMax = std::uint64_t{1} << 28;

/// The lowest or the highest value of all samples, if more than half of their range lies between it and the others.
struct LoneSample {
    float sample = 0.0F;  ///< as the file has it
    bool lowest = false;
    double gap = 0.0;  ///< to the next sample, metres
};

/// The two lowest and the two highest values.
class SampleRange {
  public:
    void add(float sample) {
        if (sample < low_[1] && sample != low_[0]) {
            low_[1] = std::max(sample, low_[0]);
            low_[0] = std::min(sample, low_[0]);
        }
        if (sample > high_[1] && sample != high_[0]) {
            high_[1] = std::min(sample, high_[0]);
            high_[0] = std::max(sample, high_[0]);
        }
    }
    /// Its gap is in samples. nullopt also of fewer than three values.
    [[nodiscard]] std::optional<LoneSample> lone() const;

  private:
    static constexpr float kNone = std::numeric_limits<float>::infinity();
    std::array<float, 2> low_{kNone, kNone};
    std::array<float, 2> high_{-kNone, -kNone};
};

class HeightMap {
  public:
    /// Reads the file, and the image's header; its rows are decoded one by one.
    /// Errors, with the file in front: those of readFile; kInvalidInput, kUnsupported (no such image); kLimit (more samples
    /// than kHeightSamplesMax); kUsage (settings that are not for such an image, or are missing); those of
    /// openImageRowsInWorker.
    [[nodiscard]] static Result<HeightMap> open(const std::filesystem::path& path, const HeightsSpec& spec,
                                                const ImportLimits& limits = {});

    [[nodiscard]] std::uint32_t columns() const {
        return static_cast<std::uint32_t>(rows_->columns());
    }  ///< 2 or more
    [[nodiscard]] std::uint32_t rows() const {
        return static_cast<std::uint32_t>(rows_->rows());
    }                                                                ///< 2 or more
    [[nodiscard]] const std::string& name() const { return name_; }  ///< of the file, without its folder
    [[nodiscard]] const std::string& hash() const { return hash_; }  ///< XXH3-128 of its bytes
    /// The settings, with those that the file's name implies.
    [[nodiscard]] const HeightsSpec& spec() const { return spec_; }
    /// Of the rows read so far, holes left out.
    [[nodiscard]] std::optional<LoneSample> lone() const;
    /// Settings of raw samples by which neighbours differ far less: "order=big". Empty: there are none.
    [[nodiscard]] std::string likelierFormat() const;
    /// Whether nothing in the file states the format of its samples.
    [[nodiscard]] bool isRaw() const;
    /// Whether samples stand for heights from low to high.
    [[nodiscard]] bool hasLow() const { return rows_->most() > 0; }

    /// \param out  columns() heights of the next row, metres; NaN is a hole.
    /// Errors, with the file in front: kInvalidInput, kUnsupported; those of openImageRowsInWorker.
    [[nodiscard]] Result<void> next(std::span<float> out);

    /// Begins again before the first row. Errors: those of open(), with the file in front.
    [[nodiscard]] Result<void> rewind();

  private:
    [[nodiscard]] Result<std::unique_ptr<SampleRows>> openRows() const;

    ImportLimits limits_;
    HeightsSpec spec_;
    std::string shown_;  // the path in quotes
    std::string name_;
    std::string hash_;
    std::vector<std::byte> bytes_;  // of raw samples
    Descriptor image_;              // sharedBytes() of an image
    std::unique_ptr<SampleRows> rows_;
    double low_ = 0.0;   // height of sample 0
    double unit_ = 1.0;  // height of a sample's step
    bool has_hole_ = false;
    float hole_ = 0.0F;  // as the file has it
    SampleRange range_;
};

}  // namespace relief

// SPDX-License-Identifier: Apache-2.0
// A height map from its file, row by row: PNG and EXR, decoded by a process of their own, or raw samples.
#pragma once

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

#include "bake/height_map/heights_spec.h"
#include "bake/height_map/raw_rows.h"
#include "bake/import/import_job.h"
#include "bake/import/sample_rows.h"
#include "formats/base/descriptor.h"
#include "formats/base/result.h"

namespace relief {

inline constexpr std::uint64_t kHeightSamplesMax = std::uint64_t{1} << 28;

/// The lowest or the highest value, or up to three of them, far from all others: the gap is more than half the range.
struct LoneSample {
    float sample = 0.0F;  ///< the extreme, as stored in the file
    float last = 0.0F;    ///< the one next to the gap; `sample` if there is only one
    bool lowest = false;
    double gap = 0.0;  ///< to the next sample, metres
};

/// The lowest and the highest values.
class SampleRange {
  public:
    void add(float sample) {
        insert(low_, sample);
        insert(high_, -sample);
    }
    /// The gap is in samples. Returns nullopt unless there are more than twice as many other values.
    [[nodiscard]] std::optional<LoneSample> lone() const;

  private:
    static constexpr std::size_t kGroupMax = 3;
    using Least = std::array<float, 2 * kGroupMax + 1>;  ///< different values, ascending; then infinity

    static void insert(Least& least, float sample) {
        if (sample < least.back() && sample != least.front()) {
            insertInside(least, sample);
        }
    }
    static void insertInside(Least& least, float sample);
    static constexpr Least none() {
        Least least{};
        least.fill(std::numeric_limits<float>::infinity());
        return least;
    }
    Least low_ = none();
    Least high_ = none();  ///< negated
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
    /// The settings, with those that the name of a raw file implies.
    [[nodiscard]] const HeightsSpec& spec() const { return spec_; }
    /// The lone samples of the rows read so far, without holes.
    [[nodiscard]] std::optional<LoneSample> lone() const;
    /// Empty for images.
    [[nodiscard]] LikelierFormat likelierFormat() const;
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
    float hole_ = 0.0F;  // as stored in the file
    SampleRange range_;
};

}  // namespace relief

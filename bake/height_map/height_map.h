// SPDX-License-Identifier: Apache-2.0
// Reads a height map file row by row: PNG and EXR, decoded in a worker process, or raw samples.
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
#include "bake/import/import_job.h"
#include "bake/import/sample_rows.h"
#include "formats/base/descriptor.h"
#include "formats/base/result.h"

namespace relief {

inline constexpr std::uint64_t kHeightSamplesMax = std::uint64_t{1} << 28;

/// Opens raw samples without a header. `spec` states their type, byte order and width, because the file does not.
/// \param bytes  untrusted; must outlive the rows.
/// Errors, without the file name: kInvalidInput (not a whole number of rows or, without a width, not a square).
[[nodiscard]] Result<std::unique_ptr<SampleRows>> openRawRows(std::span<const std::byte> bytes,
                                                              const HeightsSpec& spec);

/// Settings that fit raw samples better than the given ones.
struct BetterFormat {
    std::optional<SampleType> type = {};  ///< nullopt: as given
    std::optional<ByteOrder> order = {};  ///< nullopt: as given
    bool eight_bits = false;              ///< in the given byte order, samples may be 8-bit values times 256
    /// No better setting was found, but the samples look like noise, or neighbours differ less with the other
    /// signedness.
    bool doubtful = false;

    [[nodiscard]] bool found() const { return type || order; }
    friend bool operator==(const BetterFormat&, const BetterFormat&) = default;
};
/// "type=int16,order=big"; empty if no better setting was found.
[[nodiscard]] std::string toString(const BetterFormat& format);

/// Searches for better settings. Compares how neighbours differ in at most 64 rows, and which byte values occur in the
/// file.
[[nodiscard]] BetterFormat findBetterRawFormat(std::span<const std::byte> bytes, const HeightsSpec& spec);

/// Up to three extreme values, lowest or highest, far from all others: the gap is more than half the range.
struct OutlierSample {
    float sample = 0.0F;  ///< the extreme, as stored in the file
    float last = 0.0F;    ///< the value next to the gap; equals `sample` if it is the only outlier
    bool lowest = false;
    double gap = 0.0;  ///< to the next value, metres
};

class SampleRange {
  public:
    void add(float sample) {
        insert(low_, sample);
        insert(high_, -sample);
    }
    /// Returns the outliers, with the gap in sample units; nullopt unless the other values outnumber them.
    [[nodiscard]] std::optional<OutlierSample> outliers() const;

  private:
    static constexpr std::size_t kGroupMax = 3;
    using Least = std::array<float, 2 * kGroupMax + 1>;  ///< distinct values, ascending, padded with infinity

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
    /// Reads the file and, for an image, its header. Rows are decoded on demand.
    /// Errors, prefixed with the file: those of readFile; kInvalidInput, kUnsupported (not a supported image); kLimit
    /// (more than kHeightSamplesMax samples); kUsage (settings that do not apply to the file, or are missing); those
    /// of openImageRowsInWorker.
    [[nodiscard]] static Result<HeightMap> open(const std::filesystem::path& path, const HeightsSpec& spec,
                                                const ImportLimits& limits = {});

    [[nodiscard]] std::uint32_t columns() const {
        return static_cast<std::uint32_t>(rows_->columns());
    }  ///< 2 or more
    [[nodiscard]] std::uint32_t rows() const {
        return static_cast<std::uint32_t>(rows_->rows());
    }                                                                ///< 2 or more
    [[nodiscard]] const std::string& name() const { return name_; }  ///< file name without its folder
    [[nodiscard]] const std::string& hash() const { return hash_; }  ///< XXH3-128 of the file
    /// The settings, including those that a raw file's extension implies.
    [[nodiscard]] const HeightsSpec& spec() const { return spec_; }
    /// The outliers among the samples read so far, excluding holes.
    [[nodiscard]] std::optional<OutlierSample> outliers() const;
    /// Always empty for images.
    [[nodiscard]] BetterFormat betterFormat() const;
    /// Whether the file does not state the format of its samples.
    [[nodiscard]] bool isRaw() const { return !image_; }
    /// Whether samples map to heights from spec().low to spec().high.
    [[nodiscard]] bool hasLow() const { return rows_->most() > 0; }

    /// Reads the next row.
    /// \param out  columns() heights in metres; NaN is a hole.
    /// Errors, prefixed with the file: kInvalidInput, kUnsupported; those of openImageRowsInWorker.
    [[nodiscard]] Result<void> next(std::span<float> out);

    /// Restarts before the first row. Errors: those of open().
    [[nodiscard]] Result<void> rewind();

  private:
    [[nodiscard]] Result<std::unique_ptr<SampleRows>> openRows() const;

    ImportLimits limits_;
    HeightsSpec spec_;
    std::string shown_;  // the quoted path
    std::string name_;
    std::string hash_;
    std::vector<std::byte> bytes_;  // raw samples
    Descriptor image_;              // sharedBytes() of an image
    std::unique_ptr<SampleRows> rows_;
    double low_ = 0.0;   // height of sample 0
    double unit_ = 1.0;  // height of one sample step
    bool has_hole_ = false;
    float hole_ = 0.0F;  // as stored in the file
    SampleRange range_;
};

}  // namespace relief

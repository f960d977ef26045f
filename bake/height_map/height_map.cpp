// SPDX-License-Identifier: Apache-2.0
#include "bake/height_map/height_map.h"

#include <algorithm>
#include <cerrno>
#include <cmath>
#include <limits>
#include <utility>

#include "bake/import/image_rows.h"
#include "bake/import/import_process.h"
#include "formats/base/file_io.h"
#include "formats/base/hash.h"
#include "formats/base/text.h"
#include "formats/fields/text.h"

namespace relief {
namespace {

/// Floats, plus a margin for headers of images that do not compress.
constexpr std::uint64_t kFileMax = 4 * kHeightSamplesMax + (std::uint64_t{64} << 20);

Result<void> checkKind(const std::filesystem::path& path, bool image, const HeightsSpec& spec) {
    const char* const raw = spec.width ? "width" : spec.type ? "type" : spec.order ? "order" : nullptr;
    if (image && raw != nullptr) {
        return fail(ErrorCode::kUsage,
                    std::string("--heights ") + raw +
                        " applies only to raw samples, but this is an image; leave it out");
    }
    const std::string extension = lowerCase(path.extension().string());
    if (!image && raw == nullptr && extension != ".raw" && extension != ".r16") {
        return fail(
            ErrorCode::kUnsupported,
            "it is not a PNG or EXR image; if it contains raw samples, give --heights type= or width=");
    }
    return {};
}

Result<void> checkSize(const SampleRows& rows) {
    const std::string size = std::to_string(rows.columns()) + "x" + std::to_string(rows.rows());
    if (rows.columns() < 2 || rows.rows() < 2) {
        return invalidInput("it has " + size + " samples; a height map has at least 2x2");
    }
    if (rows.columns() > kHeightsSideMax || rows.rows() > kHeightsSideMax ||
        rows.columns() * rows.rows() > kHeightSamplesMax) {
        return fail(ErrorCode::kLimit,
                    "it has " + size + " samples, more than the limit of " +
                        std::to_string(kHeightSamplesMax) +
                        "; split it into several maps, each with its own --heights offset");
    }
    return {};
}

Result<void> checkHole(const HeightsSpec& spec, int least, int most) {
    if (spec.hole && !(*spec.hole >= least && *spec.hole <= most && std::floor(*spec.hole) == *spec.hole)) {
        return fail(ErrorCode::kUsage, "--heights hole is " + numberWord(*spec.hole) +
                                           " but must be a whole number from " + std::to_string(least) +
                                           " to " + std::to_string(most));
    }
    return {};
}

/// Checks settings that apply only to some images.
Result<void> checkSettings(const SampleRows& rows, const HeightsSpec& spec) {
    if (rows.most() == 0) {
        if (spec.low || spec.high) {
            return fail(ErrorCode::kUsage,
                        std::string("--heights ") + (spec.low ? "low" : "high") +
                            " applies only to unsigned samples, but these are heights; leave it out");
        }
        return spec.type == SampleType::kInt16 ? checkHole(spec, -32768, 32767) : Result<void>();
    }
    if (!spec.low || !spec.high) {
        return fail(ErrorCode::kUsage, std::string("--heights needs ") + (spec.low ? "high" : "low") +
                                           "=, the height of sample value " +
                                           (spec.low ? std::to_string(rows.most()) : "0"));
    }
    return checkHole(spec, 0, static_cast<int>(rows.most()));
}

}  // namespace

Result<HeightMap> HeightMap::open(const std::filesystem::path& path, const HeightsSpec& spec,
                                  const ImportLimits& limits) {
    HeightMap map;
    map.limits_ = limits;
    map.shown_ = path == "-" ? "standard input" : quotedPath(path);
    map.name_ = path == "-" ? "standard input" : cleanUtf8(path.filename().string(), 255);
    map.bytes_ = RELIEF_TRY(readFile(path, kFileMax));
    map.hash_ = xxh3_128Hex(map.bytes_);
    const bool image = isImage(map.bytes_);
    map.spec_ = image ? spec : completed(spec, path);
    RELIEF_TRY(withPrefix(map.shown_, checkKind(path, image, map.spec_)));
    if (image) {
        map.image_ = sharedBytes(map.bytes_);
        if (!map.image_) {
            return withPrefix(map.shown_, Result<HeightMap>(ImportProcess::notStarted(errno)));
        }
        map.bytes_ = {};
    }
    map.rows_ = RELIEF_TRY(map.openRows());
    RELIEF_TRY(withPrefix(map.shown_, checkSize(*map.rows_)));
    RELIEF_TRY(withPrefix(map.shown_, checkSettings(*map.rows_, map.spec_)));
    if (map.rows_->most() > 0) {
        map.low_ = *spec.low;
        map.unit_ = (*spec.high - *spec.low) / map.rows_->most();
    }
    map.has_hole_ = map.spec_.hole.has_value();
    constexpr double kMaxValue = std::numeric_limits<float>::max();
    map.hole_ = static_cast<float>(std::clamp(map.spec_.hole.value_or(0.0), -kMaxValue, kMaxValue));
    return map;
}

void SampleRange::insertInside(Least& least, float sample) {
    auto* const at = std::lower_bound(least.begin(), least.end(), sample);
    if (*at != sample) {
        std::move_backward(at, least.end() - 1, least.end());
        *at = sample;
    }
}

std::optional<OutlierSample> SampleRange::outliers() const {
    const double range = -double{high_[0]} - double{low_[0]};
    for (const Least* side : {&low_, &high_}) {
        for (std::size_t last = 0; last < kGroupMax; ++last) {
            const double gap = double{(*side)[last + 1]} - double{(*side)[last]};
            if (2.0 * gap > range && std::isfinite((*side)[2 * last + 2])) {
                const float sign = side == &low_ ? 1.0F : -1.0F;
                return OutlierSample{sign * (*side)[0], sign * (*side)[last], side == &low_, gap};
            }
        }
    }
    return std::nullopt;
}

std::optional<OutlierSample> HeightMap::outliers() const {
    std::optional<OutlierSample> outliers = range_.outliers();
    if (outliers) {
        outliers->gap *= unit_;
    }
    return outliers;
}

BetterFormat HeightMap::betterFormat() const {
    return isRaw() ? findBetterRawFormat(bytes_, spec_) : BetterFormat();
}

Result<std::unique_ptr<SampleRows>> HeightMap::openRows() const {
    return withPrefix(shown_,
                      isRaw() ? openRawRows(bytes_, spec_) : openImageRowsInWorker(image_.get(), limits_));
}

Result<void> HeightMap::rewind() {
    std::unique_ptr<SampleRows> again = RELIEF_TRY(openRows());
    if (again->columns() != rows_->columns() || again->rows() != rows_->rows() ||
        again->most() != rows_->most()) {
        return invalidInput(shown_ + ": the importer returned two different sizes; save the image again");
    }
    rows_ = std::move(again);
    return {};
}

Result<void> HeightMap::next(std::span<float> out) {
    RELIEF_TRY(withPrefix(shown_, rows_->next(out)));
    for (float& sample : out) {
        if (std::isnan(sample) || (has_hole_ && sample == hole_)) {
            sample = std::numeric_limits<float>::quiet_NaN();
            continue;
        }
        range_.add(sample);
        sample = static_cast<float>(low_ + unit_ * double{sample});
        if (!(std::abs(double{sample}) <= kHeightMax)) {
            const BetterFormat format = betterFormat();
            return invalidInput(shown_ + ": it has a height of " + shortest(sample) + ", beyond 1e9; " +
                                (format.found() ? "give --heights " + toString(format)
                                 : std::isfinite(sample)
                                     ? "if it stands for a hole, give --heights hole=" + shortest(sample)
                                     : "if it stands for a hole, save it as NaN"));
        }
    }
    return {};
}

}  // namespace relief

// SPDX-License-Identifier: Apache-2.0
#include "bake/heights/height_map.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <utility>

#include "bake/heights/exr_rows.h"
#include "bake/heights/png_rows.h"
#include "formats/base/file_io.h"
#include "formats/base/hash.h"
#include "formats/base/text.h"
#include "formats/fields/text.h"

namespace relief {
namespace {

constexpr std::uint64_t kSample = 2;  ///< bytes of a raw one
/// Floats, and some room for the headers of images that do not shrink.
constexpr std::uint64_t kFileMax = 4 * kHeightSamplesMax + (std::uint64_t{64} << 20);

/// Unsigned numbers of 16 bits, little-endian, without a header.
class RawRows : public SampleRows {
  public:
    RawRows(std::span<const std::byte> bytes, std::uint64_t columns) : left_(bytes) {
        columns_ = columns;
        rows_ = bytes.size() / kSample / columns;
        most_ = 65535;
    }
    Result<void> next(std::span<float> out) override {
        for (std::size_t i = 0; i < out.size(); ++i) {
            out[i] = static_cast<float>(std::to_integer<unsigned>(left_[2 * i]) |
                                        std::to_integer<unsigned>(left_[2 * i + 1]) << 8U);
        }
        left_ = left_.subspan(kSample * out.size());
        return {};
    }

  private:
    std::span<const std::byte> left_;
};

bool beginsWith(std::span<const std::byte> bytes, std::span<const unsigned char> signature) {
    if (bytes.size() < signature.size()) {
        return false;
    }
    for (std::size_t i = 0; i < signature.size(); ++i) {
        if (std::to_integer<unsigned char>(bytes[i]) != signature[i]) {
            return false;
        }
    }
    return true;
}

constexpr std::array<unsigned char, 8> kPng = {0x89, 'P', 'N', 'G', 0x0d, 0x0a, 0x1a, 0x0a};
constexpr std::array<unsigned char, 4> kExr = {0x76, 0x2f, 0x31, 0x01};

Result<std::unique_ptr<SampleRows>> openRaw(std::span<const std::byte> bytes,
                                            std::optional<std::uint32_t> width) {
    const std::uint64_t samples = bytes.size() / kSample;
    const auto side = static_cast<std::uint64_t>(std::sqrt(static_cast<double>(samples)));
    const std::uint64_t columns = width ? *width : side;
    if (bytes.size() % kSample != 0 || columns == 0 || samples % columns != 0 ||
        (!width && side * side != samples)) {
        const std::string size = std::to_string(bytes.size()) + " bytes, which are no ";
        return invalidInput(
            width ? "it has " + size + "rows of " + std::to_string(*width) +
                        " samples of 16 bits; give another width, or copy it again"
                  : "it has " + size +
                        "square of samples of 16 bits; give --heights width=N, or copy it again");
    }
    return std::make_unique<RawRows>(bytes, columns);
}

Result<std::unique_ptr<SampleRows>> openRows(const std::filesystem::path& path,
                                             std::span<const std::byte> bytes, const HeightsSpec& spec) {
    const bool png = beginsWith(bytes, kPng);
    if (png || beginsWith(bytes, kExr)) {
        if (spec.width) {
            return fail(ErrorCode::kUsage,
                        "--heights width is for raw samples, and this is an image; leave it out");
        }
        return png ? openPngRows(bytes) : openExrRows(bytes);
    }
    const std::string extension = lowerCase(path.extension().string());
    if (extension != ".raw" && extension != ".r16" && !spec.width) {
        return fail(ErrorCode::kUnsupported,
                    "it is no PNG or EXR image; if it holds raw samples of 16 bits, name it .r16 or give "
                    "--heights width=N");
    }
    return openRaw(bytes, spec.width);
}

Result<void> checkSize(const SampleRows& rows) {
    const std::string size = std::to_string(rows.columns()) + "x" + std::to_string(rows.rows());
    if (rows.columns() < 2 || rows.rows() < 2) {
        return invalidInput("it has " + size + " samples; a height map has at least 2x2");
    }
    if (rows.columns() > kHeightsSideMax || rows.rows() > kHeightsSideMax ||
        rows.columns() * rows.rows() > kHeightSamplesMax) {
        return fail(ErrorCode::kLimit,
                    "it has " + size + " samples, and " + std::to_string(kHeightSamplesMax) +
                        " are the most; cut it into several, each with its --heights offset");
    }
    return {};
}

/// The settings that only some images have.
Result<void> checkSettings(const SampleRows& rows, const HeightsSpec& spec) {
    if (rows.most() == 0) {
        if (spec.low || spec.high) {
            return fail(ErrorCode::kUsage,
                        std::string("--heights ") + (spec.low ? "low" : "high") +
                            " is for images of whole numbers, and these are heights; leave it out");
        }
        return {};
    }
    if (!spec.low || !spec.high) {
        return fail(ErrorCode::kUsage, std::string("--heights needs ") + (spec.low ? "high" : "low") +
                                           "=, the height of sample " +
                                           (spec.low ? std::to_string(rows.most()) : "0"));
    }
    if (spec.hole &&
        !(*spec.hole >= 0.0 && *spec.hole <= rows.most() && std::floor(*spec.hole) == *spec.hole)) {
        return fail(ErrorCode::kUsage, "--heights hole is " + numberWord(*spec.hole) +
                                           " but must be a whole number from 0 to " +
                                           std::to_string(rows.most()));
    }
    return {};
}

}  // namespace

Result<HeightMap> HeightMap::open(const std::filesystem::path& path, const HeightsSpec& spec) {
    HeightMap map;
    map.path_ = path;
    map.spec_ = spec;
    map.shown_ = path == "-" ? "standard input" : quotedPath(path);
    map.name_ = path == "-" ? "standard input" : cleanUtf8(path.filename().string(), 255);
    map.bytes_ = RELIEF_TRY(readFile(path, kFileMax));
    map.hash_ = xxh3_128Hex(map.bytes_);
    RELIEF_TRY(map.rewind());
    RELIEF_TRY(inFront(map.shown_, checkSize(*map.rows_)));
    RELIEF_TRY(inFront(map.shown_, checkSettings(*map.rows_, spec)));
    if (map.rows_->most() > 0) {
        map.low_ = *spec.low;
        map.unit_ = (*spec.high - *spec.low) / map.rows_->most();
    }
    map.has_hole_ = spec.hole.has_value();
    constexpr double kMost = std::numeric_limits<float>::max();
    map.hole_ = static_cast<float>(std::clamp(spec.hole.value_or(0.0), -kMost, kMost));
    return map;
}

Result<void> HeightMap::rewind() {
    rows_.reset();  // they borrow the bytes
    rows_ = RELIEF_TRY(inFront(shown_, openRows(path_, bytes_, spec_)));
    return {};
}

Result<void> HeightMap::next(std::span<float> out) {
    RELIEF_TRY(inFront(shown_, rows_->next(out)));
    for (float& sample : out) {
        if (std::isnan(sample) || (has_hole_ && sample == hole_)) {
            sample = std::numeric_limits<float>::quiet_NaN();
            continue;
        }
        sample = static_cast<float>(low_ + unit_ * double{sample});
        if (!(std::abs(double{sample}) <= kHeightMax)) {
            return invalidInput(shown_ + ": it has a height of " + shortest(sample) +
                                ", beyond 1e9; if it stands for a hole, " +
                                (std::isfinite(sample) ? "give --heights hole=" + shortest(sample)
                                                       : std::string("save it as NaN")));
        }
    }
    return {};
}

}  // namespace relief

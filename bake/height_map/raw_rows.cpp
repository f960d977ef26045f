// SPDX-License-Identifier: Apache-2.0
#include "bake/height_map/height_map.h"

#include <algorithm>
#include <array>
#include <bit>
#include <bitset>
#include <cmath>
#include <cstdint>
#include <limits>
#include <optional>
#include <set>
#include <vector>

namespace relief {
namespace {

struct RawFormat {
    SampleType type = SampleType::kUint16;
    ByteOrder order = ByteOrder::kLittle;
    friend bool operator==(const RawFormat&, const RawFormat&) = default;

    [[nodiscard]] std::size_t bytes() const { return type == SampleType::kFloat32 ? 4 : 2; }
};

RawFormat formatOf(const HeightsSpec& spec) {
    return {spec.type.value_or(SampleType::kUint16), spec.order.value_or(ByteOrder::kLittle)};
}

/// Whether a 16-bit sample is -32768 in int16, which usually stands for no data. The search for better settings ignores
/// these samples in every format, unless they are the majority: they are spikes that hide how smooth the ground is.
bool isUsualHole(float sample, SampleType type) {
    return (type == SampleType::kInt16 && sample == -32768.0F) ||
           (type == SampleType::kUint16 && sample == 32768.0F);
}

/// Returns the hole of `spec`; NaN if `spec` has none, or another format.
double holeOf(const HeightsSpec& spec, const RawFormat& format) {
    constexpr double kNone = std::numeric_limits<double>::quiet_NaN();
    return format == formatOf(spec) ? spec.hole.value_or(kNone) : kNone;
}

class RawRows : public SampleRows {
  public:
    RawRows(std::span<const std::byte> bytes, std::uint64_t columns, const RawFormat& format)
        : left_(bytes), format_(format) {
        columns_ = columns;
        rows_ = bytes.size() / format.bytes() / columns;
        most_ = format.type == SampleType::kUint16 ? 65535 : 0;
    }
    Result<void> next(std::span<float> out) override {
        switch (format_.type) {
            case SampleType::kUint16:
                decode<2>(out, [](std::uint32_t bits) { return static_cast<float>(bits); });
                break;
            case SampleType::kInt16:
                decode<2>(out, [](std::uint32_t bits) {
                    return static_cast<float>(static_cast<std::int16_t>(bits));
                });
                break;
            case SampleType::kFloat32:
                decode<4>(out, [](std::uint32_t bits) { return std::bit_cast<float>(bits); });
        }
        return {};
    }

  private:
    template <std::size_t kBytes, class Value>
    void decode(std::span<float> out, const Value& value) {
        const std::size_t swap = format_.order == ByteOrder::kBig ? kBytes - 1 : 0;
        for (std::size_t i = 0; i < out.size(); ++i) {
            std::uint32_t bits = 0;
            for (std::size_t byte = 0; byte < kBytes; ++byte) {
                bits |= std::to_integer<std::uint32_t>(left_[kBytes * i + (byte ^ swap)]) << 8U * byte;
            }
            out[i] = value(bits);
        }
        left_ = left_.subspan(kBytes * out.size());
    }

    std::span<const std::byte> left_;
    RawFormat format_;
};

/// Returns the samples per row of a raw file of this size; 0 if the size is not a number of whole rows.
std::uint64_t columnsOf(std::size_t bytes, std::optional<std::uint32_t> width, const RawFormat& format) {
    const std::uint64_t samples = bytes / format.bytes();
    const auto side = static_cast<std::uint64_t>(std::sqrt(static_cast<double>(samples)));
    const std::uint64_t columns = width ? *width : side;
    const bool whole = bytes % format.bytes() == 0 && columns > 0 && samples % columns == 0;
    return whole && (width || side * side == samples) ? columns : 0;
}

/// Differences between neighbours.
struct Variation {
    double between = 0.0;  ///< mean difference of neighbours in a row
    double spread = 0.0;   ///< mean deviation from the mean

    /// Far below 1 for smooth ground, about 1.3 for noise.
    [[nodiscard]] double roughness() const {
        return spread > 0.0 ? between / spread : std::numeric_limits<double>::infinity();
    }
};

/// Reads at most 64 rows of a raw file, without the holes of `spec`. Returns nullopt if the file has no rows of this
/// format, or if most of its samples are not heights.
std::optional<Variation> variationOf(std::span<const std::byte> bytes, const HeightsSpec& spec,
                                     const RawFormat& format) {
    constexpr std::uint64_t kRows = 64;
    constexpr std::uint64_t kSamples = std::uint64_t{1} << 20;
    const std::uint64_t columns = columnsOf(bytes.size(), spec.width, format);
    if (columns == 0) {
        return std::nullopt;
    }
    const std::uint64_t rows = bytes.size() / format.bytes() / columns;
    const std::uint64_t read = std::min({rows, kRows, 1 + kSamples / columns});
    std::vector<float> samples(read * columns);
    for (std::uint64_t i = 0; i < read; ++i) {
        const std::span<const std::byte> row = bytes.subspan(i * rows / read * columns * format.bytes());
        static_cast<void>(
            RawRows(row, columns, format).next(std::span(samples).subspan(i * columns, columns)));
    }
    const double hole = holeOf(spec, format);
    const auto usual =
        std::ranges::count_if(samples, [&](float sample) { return isUsualHole(sample, format.type); });
    const bool ignored = 2 * static_cast<std::size_t>(usual) <= samples.size();
    constexpr float kLeast = 1e-20F;  // small integers read as floats are smaller
    const auto isHeight = [&](float sample) {
        return std::abs(double{sample}) <= kHeightMax && double{sample} != hole &&
               !(ignored && isUsualHole(sample, format.type)) &&
               (sample == 0.0F || std::abs(sample) >= kLeast);
    };
    double sum = 0.0;
    double count = 0.0;
    Variation variation;
    double pairs = 0.0;
    for (std::size_t i = 0; i < samples.size(); ++i) {
        if (!isHeight(samples[i])) {
            continue;
        }
        sum += double{samples[i]};
        ++count;
        if (i % columns > 0 && isHeight(samples[i - 1])) {
            variation.between += std::abs(double{samples[i]} - double{samples[i - 1]});
            ++pairs;
        }
    }
    if (count < 0.5 * static_cast<double>(samples.size()) || pairs == 0.0) {
        return std::nullopt;
    }
    variation.between /= pairs;
    for (const float sample : samples) {
        variation.spread += isHeight(sample) ? std::abs(double{sample} - sum / count) / count : 0.0;
    }
    return variation;
}

/// The numbers of distinct low and high bytes in 16-bit samples. Samples that are isUsualHole() in the other byte order
/// are excluded.
struct ByteValues {
    std::size_t low = 0;
    std::size_t high = 0;
};
ByteValues byteValues(std::span<const std::byte> bytes, ByteOrder order) {
    std::array<std::bitset<256>, 2> values;
    const std::size_t low = order == ByteOrder::kLittle ? 0 : 1;
    for (std::size_t i = 0; i + 1 < bytes.size(); i += 2) {
        const auto low_byte = std::to_integer<std::size_t>(bytes[i + low]);
        const auto high_byte = std::to_integer<std::size_t>(bytes[i + 1 - low]);
        if (low_byte != 0x80 || high_byte != 0) {
            values[0].set(low_byte);
            values[1].set(high_byte);
        }
    }
    return {values[0].count(), values[1].count()};
}

/// Whether 16-bit samples probably have the opposite signedness: 65535 next to 0 is -1 in int16. True if samples lie
/// only at the two ends of their type's range, and neighbours at opposite ends are as close as other neighbours if the
/// range wraps around. False for files with only two values, which may be two levels.
bool wrapsAround(std::span<const std::byte> bytes, const HeightsSpec& spec, const RawFormat& format) {
    const std::uint64_t columns = columnsOf(bytes.size(), spec.width, format);
    if (columns == 0) {
        return false;
    }
    const double middle = format.type == SampleType::kInt16 ? 0.0 : 32768.0;
    constexpr double kClear = 16384.0;  // above all heights in metres
    const double hole = holeOf(spec, format);
    std::set<float> values;
    struct Steps {
        double sum = 0.0;
        double count = 0.0;
        [[nodiscard]] double mean() const { return count > 0.0 ? sum / count : 0.0; }
    };
    std::array<Steps, 2> steps;  // within an end, between the ends
    RawRows rows(bytes, columns, format);
    std::vector<float> row(columns);
    for (std::uint64_t i = 0; i < rows.rows(); ++i) {
        static_cast<void>(rows.next(row));
        const float* before = nullptr;
        for (const float& sample : row) {
            if (double{sample} == hole || isUsualHole(sample, format.type)) {
                before = nullptr;
                continue;
            }
            if (std::abs(double{sample} - middle) < kClear) {
                return false;
            }
            if (values.size() < 3) {
                values.insert(sample);
            }
            if (before != nullptr) {
                const double step = std::abs(double{sample} - double{*before});
                Steps& group = steps.at(step > 2.0 * kClear ? 1 : 0);
                group.sum += std::min(step, 65536.0 - step);
                ++group.count;
            }
            before = &sample;
        }
    }
    return values.size() > 2 && steps[1].count > 0.0 && steps[1].mean() <= 4.0 * steps[0].mean() + 2.0;
}

}  // namespace

Result<std::unique_ptr<SampleRows>> openRawRows(std::span<const std::byte> bytes, const HeightsSpec& spec) {
    const RawFormat format = formatOf(spec);
    const std::uint64_t columns = columnsOf(bytes.size(), spec.width, format);
    if (columns == 0) {
        const std::string size = "it has " + std::to_string(bytes.size()) + " bytes, which do not form ";
        const std::string samples = " samples of " + std::to_string(8 * format.bytes()) + " bits; give ";
        return invalidInput(spec.width ? size + "rows of " + std::to_string(*spec.width) + samples +
                                             "another width or type, or copy it again"
                                       : size + "a square of" + samples +
                                             "--heights width=N or type=, or copy it again");
    }
    return std::make_unique<RawRows>(bytes, columns, format);
}

std::string toString(const BetterFormat& format) {
    const std::string type = format.type ? "type=" + std::string(wordOf(*format.type)) : std::string();
    const std::string order = format.order ? "order=" + std::string(wordOf(*format.order)) : std::string();
    return type + (type.empty() || order.empty() ? "" : ",") + order;
}

BetterFormat findBetterRawFormat(std::span<const std::byte> bytes, const HeightsSpec& spec) {
    const RawFormat own = formatOf(spec);
    const auto ofTwoBytes = [&](ByteOrder order) {
        RawFormat format{own.bytes() == 2 ? own.type : SampleType::kUint16, order};
        if (wrapsAround(bytes, spec, format)) {
            format.type = format.type == SampleType::kInt16 ? SampleType::kUint16 : SampleType::kInt16;
        }
        return format;
    };
    const std::array<RawFormat, 4> formats = {ofTwoBytes(ByteOrder::kLittle), ofTwoBytes(ByteOrder::kBig),
                                              RawFormat{SampleType::kFloat32, ByteOrder::kLittle},
                                              RawFormat{SampleType::kFloat32, ByteOrder::kBig}};
    const auto roughnessOf = [&](const RawFormat& format) {
        return variationOf(bytes, spec, format).value_or(Variation()).roughness();
    };
    std::array<double, 4> roughness{};
    std::transform(formats.begin(), formats.end(), roughness.begin(), roughnessOf);
    const std::size_t in_order = own.order == ByteOrder::kLittle ? 0 : 1;
    std::size_t best = own.bytes() == 2 ? in_order : 2 + in_order;
    const std::size_t swapped = 1 - in_order;
    constexpr double kSimilar = 1.25;
    const ByteValues values = own.bytes() == 2 ? byteValues(bytes, own.order) : ByteValues{};
    // Heights within 256 m are as smooth in the wrong byte order as in the right one, and scaled by 256.
    if (values.high > 2 * values.low && roughness.at(swapped) <= kSimilar * roughness.at(best)) {
        best = swapped;
    }
    const RawFormat first = formats.at(best);
    constexpr double kNoise = 1.3;
    constexpr double kLess = 0.95;  // ignored samples change the roughness by less
    if (first.order != own.order || first == own) {
        double least = 0.5 * std::min(roughness.at(best), kNoise);
        for (std::size_t i = 0; i < formats.size(); ++i) {
            if (roughness.at(i) < kLess * least) {
                least = roughness.at(i);
                best = i;
            }
        }
    }
    const RawFormat& found = formats.at(best);
    BetterFormat better;
    if (found.type != own.type) {
        better.type = found.type;
    }
    if (found.order != own.order) {
        better.order = found.order;
        better.eight_bits = values.low == 1;
    }
    if (!better.found()) {
        const SampleType sign = own.type == SampleType::kInt16 ? SampleType::kUint16 : SampleType::kInt16;
        const auto between = [&](SampleType type) {
            return variationOf(bytes, spec, {type, own.order}).value_or(Variation()).between;
        };
        better.doubtful =
            !(roughness.at(best) < 0.5 * kNoise) || (own.bytes() == 2 && between(sign) < between(own.type));
    }
    return better;
}

}  // namespace relief

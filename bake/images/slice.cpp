// SPDX-License-Identifier: Apache-2.0
#include "bake/images/slice.h"

#include <tbb/parallel_for.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <optional>
#include <string>
#include <tuple>

#include "bake/images/canvas.h"
#include "formats/base/text.h"

namespace relief {
namespace {

constexpr double kMargin = 0.1;  // around the bounds, in units of their longer side in the plane

constexpr Color kFarColor{0.865, 0.87, 0.86};
constexpr Color kAbstainedColor{0.80, 0.70, 0.82};

/// Returns blue inside and orange outside, darker with the distance; legible in print and for colour-blind readers.
/// \param u  distance divided by the largest distance shown.
Color distanceColor(double u) {
    const Color light = u < 0.0 ? Color(0.91, 0.95, 1.0) : Color(1.0, 0.95, 0.91);
    const Color middle = u < 0.0 ? Color(0.50, 0.66, 0.87) : Color(0.82, 0.60, 0.43);
    const Color dark = u < 0.0 ? Color(0.10, 0.27, 0.50) : Color(0.45, 0.19, 0.04);
    const double t = 2.0 * std::min(std::abs(u), 1.0);
    return t < 1.0 ? light + t * (middle - light) : middle + (t - 1.0) * (dark - middle);
}

/// Returns the distance at which colours saturate: the largest distance inside, or half the largest distance outside if
/// nothing is inside.
double colorRange(const Slice& slice) {
    double inside = 0.0;
    double outside = 0.0;
    for (const FieldSample& sample : slice.samples) {
        if (sample.map >= 0 && sample.distance < kFarOutside) {
            double& farthest = sample.inside() ? inside : outside;
            farthest = std::max(farthest, std::abs(double{sample.distance}));
        }
    }
    const double range = inside > 0.0 ? inside : 0.5 * outside;
    return range > 0.0 && std::isfinite(range) ? range : slice.spacing * slice.width;
}

class Figure {
  public:
    Figure(const Slice& slice, const SliceFigureOptions& options)
        : slice_(slice), unit_(options.unit), range_(colorRange(slice)) {
        const double longest = std::max(slice.width, slice.height);
        zoom_ = std::max(1.0, std::ceil(440.0 / longest));
        em_ = std::max(12.0, std::floor(longest * zoom_ / 40.0));
        width_ = slice.width * zoom_;
        height_ = slice.height * zoom_;
        left_ = em_;
        top_ = 3.0 * em_;
        bar_ = std::max(height_, 12.0 * em_);  // taller than a panel of few rows
        canvas_.emplace(left_ + std::max(width_, 24.0 * em_) + 10.0 * em_, top_ + bar_ + 2.5 * em_, em_);
    }

    Result<std::vector<std::byte>> draw(const std::string& title) {
        canvas_->text(left_, 1.8 * em_, title);
        canvas_->image(
            left_, top_, slice_.width, slice_.height, zoom_,
            [this](std::uint32_t x, std::uint32_t y) { return colorAt(x, slice_.height - 1 - y); });
        drawColorBar();
        drawLegend();
        return canvas_->png();
    }

  private:
    /// The contour consists of the outermost pixels inside.
    [[nodiscard]] Color colorAt(std::uint32_t x, std::uint32_t y) const {
        const FieldSample& sample = slice_.sample(x, y);
        if (sample.map < 0) {
            return kAbstainedColor;
        }
        const auto outside = [&](std::uint32_t at_x, std::uint32_t at_y) {
            return at_x < slice_.width && at_y < slice_.height && !slice_.sample(at_x, at_y).inside();
        };
        if (sample.inside() &&
            (outside(x - 1, y) || outside(x + 1, y) || outside(x, y - 1) || outside(x, y + 1))) {
            return kInk;
        }
        return sample.distance < kFarOutside ? distanceColor(sample.distance / range_) : kFarColor;
    }

    void drawColorBar() {
        const double x = left_ + width_ + em_;
        for (int y = 0; y < static_cast<int>(bar_); ++y) {
            canvas_->fill(x, top_ + y, em_, 1.0, distanceColor(1.0 - 2.0 * (y + 0.5) / bar_));
        }
        for (int i = -2; i <= 2; ++i) {
            canvas_->text(x + 1.5 * em_, top_ + 0.25 * bar_ * (2 - i) + 0.35 * em_,
                          formatted("%.3g", 0.5 * i * range_));
        }
        canvas_->text(x, top_ - 0.5 * em_, "distance" + (unit_.empty() ? "" : ", " + unit_));
    }

    void drawLegend() {
        const auto has = [&](auto of) { return std::ranges::any_of(slice_.samples, of); };
        const bool far = has([](const FieldSample& s) { return s.map >= 0 && s.distance >= kFarOutside; });
        const bool abstained = has([](const FieldSample& s) { return s.map < 0; });
        const std::tuple<bool, Color, const char*> entries[] = {
            {true, distanceColor(-0.5), "inside"},        {true, kInk, "surface"},
            {true, distanceColor(0.5), "outside"},        {far, kFarColor, "outside, no distance known"},
            {abstained, kAbstainedColor, "no map votes"},
        };
        double x = left_;
        const double y = top_ + bar_ + 1.5 * em_;
        for (const auto& [shown, color, words] : entries) {
            if (shown) {
                canvas_->fill(x, y - 0.8 * em_, em_, em_, color);
                canvas_->text(x + 1.4 * em_, y, words);
                x += 2.6 * em_ + canvas_->textWidth(words);
            }
        }
    }

    const Slice& slice_;
    std::string unit_;
    double range_;
    // In pixels, except zoom_ (pixels per sample): size of text, size of the panel, its upper left corner, and the bar.
    double zoom_, em_, width_, height_, left_, top_, bar_;
    std::optional<Canvas> canvas_;
};

}  // namespace

Result<Slice> evaluateSlice(const Collider& collider, const SliceOptions& options) {
    if (options.size < 2) {
        return fail(ErrorCode::kUsage,
                    "--size is " + std::to_string(options.size) + " but must be at least 2");
    }
    if (options.size > kSliceSizeMax) {
        return fail(ErrorCode::kLimit, "--size is " + std::to_string(options.size) + "; the limit is " +
                                           std::to_string(kSliceSizeMax));
    }
    // The axes of these views match those of the image.
    const int view = options.axis == 2 ? 5 : 2 * options.axis;
    Slice slice{RELIEF_TRY(gridAcross(collider.bounds, view, options.size, kMargin))};
    slice.at = options.at.value_or(collider.bounds.center()[options.axis]);
    slice.samples.resize(std::size_t{slice.width} * slice.height);
    tbb::parallel_for(std::uint32_t{0}, slice.height, [&](std::uint32_t y) {
        for (std::uint32_t x = 0; x < slice.width; ++x) {
            slice.samples[std::size_t{y} * slice.width + x] = evaluate(collider, slice.point(x, y));
        }
    });
    return slice;
}

ExrImage distanceImage(const Slice& slice, const Collider& collider) {
    ExrImage image = slice.image(slice.at, collider, {"distance"});
    image.attributes.emplace_back("relief.plane", axisName(slice.axis()) + (" = " + shortest(slice.at)));
    image.attributes.emplace_back(
        "relief.distance",
        "object units, negative inside; +inf: outside, no distance known; NaN: no map votes");
    for (std::uint32_t y = 0; y < slice.height; ++y) {
        for (std::uint32_t x = 0; x < slice.width; ++x) {
            const FieldSample& sample = slice.sample(x, y);
            image.channels[0].values[slice.pixel(x, y)] =
                sample.map < 0                  ? std::numeric_limits<float>::quiet_NaN()
                : sample.distance < kFarOutside ? sample.distance
                                                : std::numeric_limits<float>::infinity();
        }
    }
    return image;
}

Result<std::vector<std::byte>> drawSlice(const Slice& slice, const SliceFigureOptions& options) {
    const std::string title = options.name + " \xe2\x80\x94 plane " + axisName(slice.axis()) + " = " +
                              shortest(slice.at) + (options.unit.empty() ? "" : " " + options.unit);
    return Figure(slice, options).draw(title);
}

}  // namespace relief

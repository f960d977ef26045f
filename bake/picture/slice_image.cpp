// A slice as a figure; the only user of Cairo.
#include <cairo.h>

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <cstring>
#include <memory>
#include <tuple>

#include "bake/picture/slice.h"
#include "formats/base/text.h"

namespace relief {
namespace {

using Surface = std::unique_ptr<cairo_surface_t, decltype(&cairo_surface_destroy)>;
using Context = std::unique_ptr<cairo_t, decltype(&cairo_destroy)>;

/// sRGB, each in [0, 1].
using Color = glm::dvec3;

constexpr Color kInk{0.13, 0.14, 0.16};
constexpr Color kFarColor{0.865, 0.87, 0.86};
constexpr Color kAbstainedColor{0.80, 0.70, 0.82};

/// Blue inside and orange outside, darker with the distance, legible in print and to the colour-blind.
/// \param u  distance over its largest shown value.
Color distanceColor(double u) {
    const Color light = u < 0.0 ? Color(0.91, 0.95, 1.0) : Color(1.0, 0.95, 0.91);
    const Color middle = u < 0.0 ? Color(0.50, 0.66, 0.87) : Color(0.82, 0.60, 0.43);
    const Color dark = u < 0.0 ? Color(0.10, 0.27, 0.50) : Color(0.45, 0.19, 0.04);
    const double t = 2.0 * std::min(std::abs(u), 1.0);
    return t < 1.0 ? light + t * (middle - light) : middle + (t - 1.0) * (dark - middle);
}

/// The distance of the strongest colours: the deepest inside; where nothing is, half of the farthest outside.
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
        bar_ = std::max(height_, 12.0 * em_);  // a panel of few rows is lower
        surface_.reset(cairo_image_surface_create(
            CAIRO_FORMAT_RGB24, static_cast<int>(left_ + std::max(width_, 24.0 * em_) + 10.0 * em_),
            static_cast<int>(top_ + bar_ + 2.5 * em_)));
        context_.reset(cairo_create(surface_.get()));
        cr_ = context_.get();
    }

    Result<std::vector<std::byte>> draw(const std::string& title) {
        // Grey antialiasing without hints: the same glyphs on every screen and machine.
        cairo_font_options_t* font = cairo_font_options_create();
        cairo_font_options_set_antialias(font, CAIRO_ANTIALIAS_GRAY);
        cairo_font_options_set_hint_style(font, CAIRO_HINT_STYLE_NONE);
        cairo_font_options_set_hint_metrics(font, CAIRO_HINT_METRICS_OFF);
        cairo_set_font_options(cr_, font);
        cairo_font_options_destroy(font);
        cairo_select_font_face(cr_, "sans-serif", CAIRO_FONT_SLANT_NORMAL, CAIRO_FONT_WEIGHT_NORMAL);
        cairo_set_font_size(cr_, em_);
        cairo_set_source_rgb(cr_, 1.0, 1.0, 1.0);
        cairo_paint(cr_);

        text(left_, 1.8 * em_, title);
        drawSamples();
        drawColorBar();
        drawLegend();
        cairo_surface_flush(surface_.get());
        std::vector<std::byte> png;
        const auto append = [](void* to, const unsigned char* data, unsigned length) {
            auto* bytes = static_cast<std::vector<std::byte>*>(to);
            const auto* first = reinterpret_cast<const std::byte*>(data);
            bytes->insert(bytes->end(), first, first + length);
            return CAIRO_STATUS_SUCCESS;
        };
        const cairo_status_t status = cairo_surface_write_to_png_stream(surface_.get(), append, &png);
        if (status != CAIRO_STATUS_SUCCESS) {
            return fail(ErrorCode::kFailure, std::string("cannot draw the slice: ") +
                                                 cairo_status_to_string(status) + "; lower --size");
        }
        return png;
    }

  private:
    void setColor(const Color& color) { cairo_set_source_rgb(cr_, color.r, color.g, color.b); }
    void fill(double x, double y, double width, double height, const Color& color) {
        setColor(color);
        cairo_rectangle(cr_, x, y, width, height);
        cairo_fill(cr_);
    }
    void text(double x, double y, const std::string& words) {
        setColor(kInk);
        cairo_move_to(cr_, x, y);
        cairo_show_text(cr_, words.c_str());
    }
    [[nodiscard]] double textWidth(const std::string& words) const {
        cairo_text_extents_t extents;
        cairo_text_extents(cr_, words.c_str(), &extents);
        return extents.x_advance;
    }

    /// The last pixels inside are the contour.
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

    /// One pixel per sample.
    void drawSamples() {
        const Surface image(cairo_image_surface_create(CAIRO_FORMAT_RGB24, static_cast<int>(slice_.width),
                                                       static_cast<int>(slice_.height)),
                            &cairo_surface_destroy);
        if (cairo_surface_status(image.get()) != CAIRO_STATUS_SUCCESS) {
            return;
        }
        unsigned char* to = cairo_image_surface_get_data(image.get());
        const auto stride = static_cast<std::size_t>(cairo_image_surface_get_stride(image.get()));
        for (std::uint32_t y = 0; y < slice_.height; ++y) {
            for (std::uint32_t x = 0; x < slice_.width; ++x) {
                const glm::uvec3 byte(glm::dvec3(0.5) + 255.0 * colorAt(x, slice_.height - 1 - y));
                const std::uint32_t pixel = byte.r << 16 | byte.g << 8 | byte.b;
                std::memcpy(to + y * stride + x * sizeof(pixel), &pixel, sizeof(pixel));
            }
        }
        cairo_surface_mark_dirty(image.get());
        cairo_save(cr_);
        cairo_translate(cr_, left_, top_);
        cairo_scale(cr_, zoom_, zoom_);
        cairo_set_source_surface(cr_, image.get(), 0.0, 0.0);
        cairo_pattern_set_filter(cairo_get_source(cr_), CAIRO_FILTER_NEAREST);
        cairo_paint(cr_);
        cairo_restore(cr_);
    }

    void drawColorBar() {
        const double x = left_ + width_ + em_;
        for (int y = 0; y < static_cast<int>(bar_); ++y) {
            fill(x, top_ + y, em_, 1.0, distanceColor(1.0 - 2.0 * (y + 0.5) / bar_));
        }
        for (int i = -2; i <= 2; ++i) {
            char number[32];
            std::snprintf(number, sizeof(number), "%.3g", 0.5 * i * range_);
            text(x + 1.5 * em_, top_ + 0.25 * bar_ * (2 - i) + 0.35 * em_, number);
        }
        text(x, top_ - 0.5 * em_, "distance" + (unit_.empty() ? "" : ", " + unit_));
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
                fill(x, y - 0.8 * em_, em_, em_, color);
                text(x + 1.4 * em_, y, words);
                x += 2.6 * em_ + textWidth(words);
            }
        }
    }

    const Slice& slice_;
    std::string unit_;
    double range_;
    // Pixels, as is zoom_ of a sample: the size of text, the panel, and its upper left corner.
    double zoom_, em_, width_, height_, left_, top_, bar_;
    Surface surface_{nullptr, &cairo_surface_destroy};
    Context context_{nullptr, &cairo_destroy};
    cairo_t* cr_ = nullptr;  // context_
};

}  // namespace

Result<std::vector<std::byte>> drawSlice(const Slice& slice, const SliceFigureOptions& options) {
    const std::string title = options.name + " \xe2\x80\x94 plane " + axisName(slice.axis) + " = " +
                              shortest(slice.at) + (options.unit.empty() ? "" : " " + options.unit);
    return Figure(slice, options).draw(title);
}

}  // namespace relief

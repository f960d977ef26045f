// A slice as a figure, like figure 6 of the paper; the only user of Cairo.
#include <cairo.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdio>
#include <cstring>
#include <memory>

#include "bake/picture/slice.h"
#include "formats/base/portable_math.h"
#include "formats/base/text.h"

namespace relief {
namespace {

enum class SampleKind { kDistance, kFar, kAbstained };

SampleKind kindOf(const FieldSample& sample) {
    return sample.map < 0                   ? SampleKind::kAbstained
           : sample.distance >= kFarOutside ? SampleKind::kFar
                                            : SampleKind::kDistance;
}

/// Marching squares for one level of the distance. Coordinates in samples from the centre of the first.
class Contour {
  public:
    Contour(const Slice& slice, double level, double jump) : slice_(slice), level_(level), jump_(jump) {}

    /// Calls segment(x0, y0, x1, y1) for every piece.
    template <class Segment>
    void trace(const Segment& segment) const {
        for (std::uint32_t y = 0; y + 1 < slice_.height; ++y) {
            for (std::uint32_t x = 0; x + 1 < slice_.width; ++x) {
                traceCell(x, y, segment);
            }
        }
    }

  private:
    using Point = std::array<double, 2>;

    template <class Segment>
    void traceCell(std::uint32_t x, std::uint32_t y, const Segment& segment) const {
        constexpr std::array<std::array<int, 2>, 4> kCorner = {{{0, 0}, {1, 0}, {1, 1}, {0, 1}}};
        std::array<double, 4> value{};
        for (std::size_t i = 0; i < 4; ++i) {
            const FieldSample& sample = slice_.sample(x + static_cast<std::uint32_t>(kCorner[i][0]),
                                                      y + static_cast<std::uint32_t>(kCorner[i][1]));
            const SampleKind kind = kindOf(sample);
            // Only the zero contour borders on what is outside without a distance.
            if (kind == SampleKind::kAbstained || (kind == SampleKind::kFar && level_ != 0.0)) {
                return;
            }
            value[i] = static_cast<double>(sample.distance) - level_;
        }
        const auto [low, high] = std::minmax_element(value.begin(), value.end());
        if (*low >= 0.0 || *high < 0.0 || (level_ != 0.0 && *high - *low > jump_)) {
            return;
        }
        std::array<Point, 4> crossing{};
        std::size_t count = 0;
        for (std::size_t i = 0; i < 4; ++i) {
            const std::size_t j = (i + 1) % 4;
            if ((value[i] < 0.0) != (value[j] < 0.0)) {
                // Across a jump of the field the surface may be anywhere: the middle.
                const bool jumps = std::abs(value[i] - value[j]) > jump_;
                const double t = jumps ? 0.5 : value[i] / (value[i] - value[j]);
                crossing[count++] = {x + kCorner[i][0] + t * (kCorner[j][0] - kCorner[i][0]),
                                     y + kCorner[i][1] + t * (kCorner[j][1] - kCorner[i][1])};
            }
        }
        // A saddle has four crossings, paired by the sign of the middle.
        const bool middle_inside = value[0] + value[1] + value[2] + value[3] < 0.0;
        const std::size_t shift = count == 4 && (value[0] < 0.0) == middle_inside ? 1 : 0;
        // Shift 1 joins edges 0-1 and 2-3 (corners 1 and 3 cut off); shift 0 joins 3-0 and 1-2.
        if (count == 4 && shift == 0) {
            std::rotate(crossing.begin(), crossing.begin() + 3, crossing.end());
        }
        for (std::size_t i = 0; i + 1 < count; i += 2) {
            segment(crossing[i][0], crossing[i][1], crossing[i + 1][0], crossing[i + 1][1]);
        }
    }

    const Slice& slice_;
    double level_;
    double jump_;
};

struct SurfaceDestroy {
    void operator()(cairo_surface_t* surface) const { cairo_surface_destroy(surface); }
};
struct ContextDestroy {
    void operator()(cairo_t* context) const { cairo_destroy(context); }
};
using Surface = std::unique_ptr<cairo_surface_t, SurfaceDestroy>;
using Context = std::unique_ptr<cairo_t, ContextDestroy>;

/// sRGB, each in [0, 1].
struct Color {
    double r, g, b;
};

constexpr Color kInsideColor{0.23, 0.29, 0.38};
constexpr Color kOutsideColor{0.94, 0.945, 0.95};
constexpr Color kPaper{1.0, 1.0, 1.0};
constexpr Color kInk{0.13, 0.14, 0.16};
constexpr Color kFaintInk{0.42, 0.44, 0.47};
constexpr Color kFarColor{0.865, 0.87, 0.86};
constexpr Color kAbstainedColor{0.80, 0.70, 0.82};

double toSrgb(double linear) {
    const double c = std::clamp(linear, 0.0, 1.0);
    return c <= 0.0031308 ? 12.92 * c : 1.055 * portable::pow(c, 1.0 / 2.4) - 0.055;
}

/// Ottosson, "A perceptual color space for image processing" (2020). Hue in degrees; clamped to sRGB.
Color fromOklch(double lightness, double chroma, double hue) {
    const double a = chroma * portable::cos(hue * 3.14159265358979323846 / 180.0);
    const double b = chroma * portable::sin(hue * 3.14159265358979323846 / 180.0);
    const auto cube = [](double v) { return v * v * v; };
    const double l = cube(lightness + 0.3963377774 * a + 0.2158037573 * b);
    const double m = cube(lightness - 0.1055613458 * a - 0.0638541728 * b);
    const double s = cube(lightness - 0.0894841775 * a - 1.2914855480 * b);
    return {toSrgb(4.0767416621 * l - 3.3077115913 * m + 0.2309699292 * s),
            toSrgb(-1.2684380046 * l + 2.6097574011 * m - 0.3413193965 * s),
            toSrgb(-0.0041960863 * l - 0.7034186147 * m + 1.7076147010 * s)};
}

/// Diverging: lightness falls evenly with |u|, blue inside and orange outside, legible in print and to the colour-blind.
/// \param u  distance over its largest shown value, clamped to [−1, 1].
Color distanceColor(double u) {
    const double amount = std::min(std::abs(u), 1.0);
    const double lightness = 0.97 - 0.56 * amount;
    const double chroma = 0.135 * std::sqrt(amount) * (1.0 - 0.25 * amount);
    return u < 0.0 ? fromOklch(lightness, chroma, 255.0) : fromOklch(lightness, chroma, 60.0 - 12.0 * amount);
}

/// 0xRRGGBB
std::uint32_t toPixel(const Color& c) {
    const auto byte = [](double v) { return static_cast<std::uint32_t>(std::lround(v * 255.0)); };
    return byte(c.r) << 16 | byte(c.g) << 8 | byte(c.b);
}

cairo_status_t append(void* png, const unsigned char* data, unsigned length) {
    auto* bytes = static_cast<std::vector<std::byte>*>(png);
    const auto* first = reinterpret_cast<const std::byte*>(data);
    bytes->insert(bytes->end(), first, first + length);
    return CAIRO_STATUS_SUCCESS;
}

double log10(double value) {
    constexpr double kLogTen = 2.302585092994046;
    return portable::log(value) / kLogTen;
}

double powerOfTen(int exponent) {
    double power = 1.0;
    for (int i = 0; i < std::abs(exponent); ++i) {
        power *= 10.0;
    }
    return exponent < 0 ? 1.0 / power : power;
}

/// 1, 2 or 5 times a power of ten, at least `value`.
double niceAbove(double value) {
    const double power = powerOfTen(static_cast<int>(std::floor(log10(value))));
    for (const double factor : {1.0, 2.0, 5.0}) {
        if (factor * power >= value * (1.0 - 1e-9)) {
            return factor * power;
        }
    }
    return 10.0 * power;
}

/// A multiple of `step` with the digits that the step needs.
std::string tickText(double value, double step) {
    if (std::abs(value) < 0.5 * step) {
        return "0";
    }
    const double magnitude = std::abs(value);
    char text[64];
    if (magnitude >= 1e5 || step < 1e-5) {
        std::snprintf(text, sizeof(text), "%.3g", magnitude);
    } else {
        const int digits = std::max(0, static_cast<int>(std::ceil(-log10(step) - 1e-9)));
        std::snprintf(text, sizeof(text), "%.*f", digits, magnitude);
    }
    return (value < 0.0 ? "\xe2\x88\x92" : "") + std::string(text);  // a true minus sign
}

/// The distance of the strongest colours: covers most of the inside, and as much outside.
double colorRange(const Slice& slice) {
    std::vector<float> inside;
    std::vector<float> outside;
    for (const FieldSample& sample : slice.samples) {
        if (kindOf(sample) == SampleKind::kDistance) {
            (sample.distance < 0.0F ? inside : outside).push_back(std::abs(sample.distance));
        }
    }
    const auto quantile = [](std::vector<float>& values, double share) {
        if (values.empty()) {
            return 0.0;
        }
        const auto at =
            values.begin() + static_cast<std::ptrdiff_t>(share * static_cast<double>(values.size() - 1));
        std::nth_element(values.begin(), at, values.end());
        return static_cast<double>(*at);
    };
    const double range = std::max(quantile(inside, 0.995), 0.5 * quantile(outside, 0.9));
    return range > 0.0 && std::isfinite(range) ? range : slice.spacing * slice.width;
}

constexpr double kPanelPixelsMin = 440.0;  // of the longer side
constexpr double kPanelPixelsNormal = 480.0;

struct Rect {
    double x, y, width, height;
};

class Figure {
  public:
    Figure(const Slice& slice, const SliceFigureOptions& options) : slice_(slice), options_(options) {
        const double longest = std::max(slice.width, slice.height);
        zoom_ = std::max(1.0, std::ceil(kPanelPixelsMin / longest));
        unit_ = std::max(1.0, std::round(8.0 * longest * zoom_ / kPanelPixelsNormal) / 8.0);
        range_ = colorRange(slice);
        level_step_ = niceAbove(range_ / 6.5);

        const double width = slice.width * zoom_;
        const double height = slice.height * zoom_;
        const double content = 2.0 * width + em(6.2) + em(11.0);
        const double canvas = std::max(em(4.6) + content + em(1.0), em(46.0));
        const double left = std::floor(em(4.6) + 0.5 * (canvas - em(5.6) - content));
        const double top = std::floor(em(5.0));
        inside_panel_ = {left, top, width, height};
        distance_panel_ = {left + width + std::floor(em(6.2)), top, width, height};
        color_bar_ = {distance_panel_.x + width + std::floor(em(1.2)), top, std::floor(em(1.1)), height};
        // On a panel of few rows the bar is taller than the panel.
        color_bar_.height = std::max(height, std::floor(em(12.0)));
        canvas_width_ = static_cast<int>(std::ceil(canvas));
        canvas_height_ = static_cast<int>(std::ceil(top + color_bar_.height + em(6.4)));
        surface_.reset(cairo_image_surface_create(CAIRO_FORMAT_RGB24, canvas_width_, canvas_height_));
        context_.reset(cairo_create(surface_.get()));
        cr_ = context_.get();
    }

    Result<std::vector<std::byte>> draw() {
        if (cairo_status(cr_) == CAIRO_STATUS_SUCCESS) {
            // Grey antialiasing without hints: the same glyphs on every screen and machine.
            cairo_font_options_t* font = cairo_font_options_create();
            cairo_font_options_set_antialias(font, CAIRO_ANTIALIAS_GRAY);
            cairo_font_options_set_hint_style(font, CAIRO_HINT_STYLE_NONE);
            cairo_font_options_set_hint_metrics(font, CAIRO_HINT_METRICS_OFF);
            cairo_set_font_options(cr_, font);
            cairo_font_options_destroy(font);

            setColor(kPaper);
            cairo_paint(cr_);
            drawTitle();
            drawPanel(inside_panel_, "inside and outside", false);
            drawPanel(distance_panel_, "signed distance", true);
            drawColorBar();
            drawLegend();
            cairo_surface_flush(surface_.get());
        }
        std::vector<std::byte> png;
        const cairo_status_t status = cairo_surface_write_to_png_stream(surface_.get(), append, &png);
        if (status != CAIRO_STATUS_SUCCESS) {
            return fail(ErrorCode::kFailure, std::string("cannot draw the slice: ") +
                                                 cairo_status_to_string(status) + "; lower --size");
        }
        return png;
    }

  private:
    /// Relative to the size of the text, 12 pixels for a panel of 480.
    [[nodiscard]] double em(double n) const { return 12.0 * n * unit_; }
    [[nodiscard]] double thinLine() const { return std::max(1.0, std::round(unit_)); }

    void setColor(const Color& color, double alpha = 1.0) {
        cairo_set_source_rgba(cr_, color.r, color.g, color.b, alpha);
    }
    void fill(const Color& color) {
        setColor(color);
        cairo_fill(cr_);
    }
    void stroke(double width, const Color& color, double alpha = 1.0) {
        cairo_set_line_width(cr_, width);
        setColor(color, alpha);
        cairo_stroke(cr_);
    }
    void addLine(double x0, double y0, double x1, double y1) {
        cairo_move_to(cr_, x0, y0);
        cairo_line_to(cr_, x1, y1);
    }
    [[nodiscard]] std::string withUnit() const {
        return options_.unit.empty() ? "object units" : options_.unit;
    }

    /// \param align  0: left of x … 1: right of x.
    void text(double x, double y, const std::string& words, double size, double align, bool bold = false,
              const Color& color = kInk) {
        cairo_select_font_face(cr_, "sans-serif", CAIRO_FONT_SLANT_NORMAL,
                               bold ? CAIRO_FONT_WEIGHT_BOLD : CAIRO_FONT_WEIGHT_NORMAL);
        cairo_set_font_size(cr_, em(size));
        setColor(color);
        cairo_move_to(cr_, x - align * textWidth(words), y);
        cairo_show_text(cr_, words.c_str());
    }
    /// In the font that text() selected last.
    [[nodiscard]] double textWidth(const std::string& words) const {
        cairo_text_extents_t extents;
        cairo_text_extents(cr_, words.c_str(), &extents);
        return extents.x_advance;
    }

    void drawTitle() {
        const double x = inside_panel_.x;
        const std::string plane = std::string("plane ") + axisName(slice_.axis) + " = " +
                                  shortest(slice_.at) + (options_.unit.empty() ? "" : " " + options_.unit);
        text(x, em(2.0), options_.name + " \xe2\x80\x94 " + plane, 1.25, 0.0, true);
    }

    void drawPanel(const Rect& panel, const char* caption, bool distance) {
        text(panel.x, panel.y - em(0.7), caption, 1.0, 0.0, false, kFaintInk);
        drawSamples(panel, distance);
        cairo_save(cr_);
        cairo_rectangle(cr_, panel.x, panel.y, panel.width, panel.height);
        cairo_clip(cr_);
        if (distance) {
            for (double level = level_step_; level <= range_ * 1.001; level += level_step_) {
                strokeContour(panel, level, 0.06, 0.32);
                strokeContour(panel, -level, 0.06, 0.32);
            }
        }
        strokeContour(panel, 0.0, 0.13, 1.0);
        cairo_restore(cr_);
        drawAxes(panel);
    }

    /// One pixel per sample; check its status.
    [[nodiscard]] Surface surfaceOf(bool distance) const {
        Surface surface(cairo_image_surface_create(CAIRO_FORMAT_RGB24, static_cast<int>(slice_.width),
                                                   static_cast<int>(slice_.height)));
        if (cairo_surface_status(surface.get()) == CAIRO_STATUS_SUCCESS) {
            cairo_surface_flush(surface.get());
            unsigned char* to = cairo_image_surface_get_data(surface.get());
            const auto stride = static_cast<std::size_t>(cairo_image_surface_get_stride(surface.get()));
            for (std::uint32_t y = 0; y < slice_.height; ++y) {
                for (std::uint32_t x = 0; x < slice_.width; ++x) {
                    const FieldSample& sample = slice_.sample(x, slice_.height - 1 - y);
                    const std::uint32_t pixel = toPixel(sampleColor(sample, distance));
                    std::memcpy(to + y * stride + x * sizeof(pixel), &pixel, sizeof(pixel));
                }
            }
            cairo_surface_mark_dirty(surface.get());
        }
        return surface;
    }

    void drawSamples(const Rect& panel, bool distance) {
        const Surface image = surfaceOf(distance);
        if (cairo_surface_status(image.get()) != CAIRO_STATUS_SUCCESS) {
            return;
        }
        cairo_save(cr_);
        cairo_translate(cr_, panel.x, panel.y);
        cairo_scale(cr_, zoom_, zoom_);
        cairo_set_source_surface(cr_, image.get(), 0.0, 0.0);
        cairo_pattern_set_filter(cairo_get_source(cr_), CAIRO_FILTER_NEAREST);
        cairo_rectangle(cr_, 0.0, 0.0, slice_.width, slice_.height);
        cairo_fill(cr_);
        cairo_restore(cr_);
    }

    [[nodiscard]] Color sampleColor(const FieldSample& sample, bool distance) const {
        switch (kindOf(sample)) {
            case SampleKind::kAbstained:
                return kAbstainedColor;
            case SampleKind::kFar:
                return distance ? kFarColor : kOutsideColor;
            case SampleKind::kDistance:
                break;
        }
        if (!distance) {
            return sample.inside() ? kInsideColor : kOutsideColor;
        }
        return distanceColor(sample.distance / range_);
    }

    void strokeContour(const Rect& panel, double level, double line_width, double alpha) {
        cairo_new_path(cr_);
        Contour(slice_, level, 4.0 * slice_.spacing).trace([&](double x0, double y0, double x1, double y1) {
            addLine(panel.x + (x0 + 0.5) * zoom_, panel.y + panel.height - (y0 + 0.5) * zoom_,
                    panel.x + (x1 + 0.5) * zoom_, panel.y + panel.height - (y1 + 0.5) * zoom_);
        });
        cairo_set_line_cap(cr_, CAIRO_LINE_CAP_ROUND);
        stroke(em(line_width), kInk, alpha);
    }

    void drawAxes(const Rect& panel) {
        const double line = thinLine();
        cairo_rectangle(cr_, panel.x - 0.5 * line, panel.y - 0.5 * line, panel.width + line,
                        panel.height + line);
        stroke(line, kInk);

        const double per_pixel = slice_.spacing / zoom_;
        const double step = niceAbove(std::max(panel.width, panel.height) * per_pixel / 6.0);
        forTicks(slice_.corner.x, panel.width * per_pixel, step, [&](double value) {
            const double x = std::round(panel.x + (value - slice_.corner.x) / per_pixel);
            tick(x, panel.y + panel.height + line, 0.0, em(0.35));
            text(x, panel.y + panel.height + em(1.5), tickText(value, step), 0.9, 0.5);
        });
        forTicks(slice_.corner.y, panel.height * per_pixel, step, [&](double value) {
            const double y = std::round(panel.y + panel.height - (value - slice_.corner.y) / per_pixel);
            tick(panel.x - line, y, -em(0.35), 0.0);
            text(panel.x - em(0.6), y + em(0.32), tickText(value, step), 0.9, 1.0);
        });
        const std::string unit = " / " + withUnit();
        text(panel.x + 0.5 * panel.width, panel.y + panel.height + em(2.9), axisName(slice_.right) + unit,
             0.95, 0.5);
        cairo_save(cr_);
        cairo_translate(cr_, panel.x - em(3.4), panel.y + 0.5 * panel.height);
        cairo_rotate(cr_, -1.57079632679489661923);
        text(0.0, 0.0, axisName(slice_.up) + unit, 0.95, 0.5);
        cairo_restore(cr_);
    }

    template <class Visit>
    static void forTicks(double from, double length, double step, const Visit& visit) {
        const double first = std::ceil(from / step - 1e-9);
        // Bounded, for huge coordinates with a tiny step.
        for (int i = 0; i < 40; ++i) {
            const double value = (first + i) * step;
            if (!(value <= from + length)) {
                return;
            }
            visit(value);
        }
    }

    void tick(double x, double y, double dx, double dy) {
        addLine(x, y, x + dx, y + dy);
        stroke(thinLine(), kInk);
    }

    void drawColorBar() {
        // The pointed ends stand for all distances beyond.
        const double point = std::floor(em(0.95));
        const Rect bar{color_bar_.x, color_bar_.y + point, color_bar_.width, color_bar_.height - 2.0 * point};
        fillColorBar(bar, point);
        strokeColorBar(bar, point);
        text(bar.x, color_bar_.y - em(0.7), "outside, " + withUnit(), 0.9, 0.0, false, kFaintInk);
        text(bar.x, color_bar_.y + color_bar_.height + em(1.5), "inside", 0.9, 0.0, false, kFaintInk);
    }

    void fillColorBar(const Rect& bar, double point) {
        for (int y = 0; y < static_cast<int>(bar.height); ++y) {
            cairo_rectangle(cr_, bar.x, bar.y + y, bar.width, 1.0);
            fill(distanceColor(1.0 - 2.0 * (y + 0.5) / bar.height));
        }
        const double bottom = bar.y + bar.height;
        const auto triangle = [&](double base, double tip) {
            cairo_move_to(cr_, bar.x, base);
            cairo_line_to(cr_, bar.x + 0.5 * bar.width, tip);
            cairo_line_to(cr_, bar.x + bar.width, base);
            cairo_close_path(cr_);
        };
        triangle(bar.y, bar.y - point);
        fill(distanceColor(1.0));
        triangle(bottom, bottom + point);
        fill(distanceColor(-1.0));
    }

    /// The outline, and a line and a number per level.
    void strokeColorBar(const Rect& bar, double point) {
        const double bottom = bar.y + bar.height;
        const double line = thinLine();
        cairo_move_to(cr_, bar.x, bar.y);
        cairo_line_to(cr_, bar.x + 0.5 * bar.width, bar.y - point);
        cairo_line_to(cr_, bar.x + bar.width, bar.y);
        cairo_line_to(cr_, bar.x + bar.width, bottom);
        cairo_line_to(cr_, bar.x + 0.5 * bar.width, bottom + point);
        cairo_line_to(cr_, bar.x, bottom);
        cairo_close_path(cr_);
        stroke(line, kInk);
        forTicks(-range_, 2.0 * range_, level_step_, [&](double value) {
            const double y = std::round(bar.y + 0.5 * bar.height * (1.0 - value / range_));
            const bool zero = std::abs(value) < 0.5 * level_step_;
            addLine(bar.x, y, bar.x + bar.width, y);
            stroke(em(zero ? 0.13 : 0.06), kInk, zero ? 1.0 : 0.32);
            tick(bar.x + bar.width + line, y, em(0.3), 0.0);
            text(bar.x + bar.width + em(0.6), y + em(0.32), tickText(value, level_step_), 0.9, 0.0);
        });
    }

    void drawLegend() {
        struct Entry {
            Color color;
            std::string words;
        };
        std::vector<Entry> entries = {{kInsideColor, "inside"}, {kOutsideColor, "outside"}};
        const auto has = [&](SampleKind kind) {
            return std::ranges::find(slice_.samples, kind, kindOf) != slice_.samples.end();
        };
        if (has(SampleKind::kFar)) {
            entries.push_back({kFarColor, "outside, no distance known"});
        }
        if (has(SampleKind::kAbstained)) {
            entries.push_back({kAbstainedColor, "no map votes"});
        }
        double x = inside_panel_.x;
        const double y = canvas_height_ - em(1.1);
        for (const Entry& entry : entries) {
            cairo_rectangle(cr_, x, y - em(0.85), em(1.4), em(1.0));
            setColor(entry.color);
            cairo_fill_preserve(cr_);
            stroke(thinLine(), kFaintInk);
            text(x + em(1.9), y, entry.words, 0.9, 0.0);
            x += em(1.9) + textWidth(entry.words) + em(1.8);
        }
        addLine(x, y - em(0.35), x + em(1.4), y - em(0.35));
        stroke(em(0.13), kInk);
        text(x + em(1.9), y, "surface, f = 0", 0.9, 0.0);
    }

    const Slice& slice_;
    const SliceFigureOptions& options_;
    double zoom_ = 1.0;  // panel pixels for one sample
    double unit_ = 1.0;  // size of text and lines: 1 for panels of 480 pixels
    double range_ = 1.0;
    double level_step_ = 1.0;
    Rect inside_panel_{};
    Rect distance_panel_{};
    Rect color_bar_{};
    int canvas_width_ = 0;
    int canvas_height_ = 0;
    Surface surface_;
    Context context_;
    cairo_t* cr_ = nullptr;  // context_
};

}  // namespace

Result<std::vector<std::byte>> drawSlice(const Slice& slice, const SliceFigureOptions& options) {
    return Figure(slice, options).draw();
}

}  // namespace relief

// SPDX-License-Identifier: Apache-2.0
#include "bake/images/canvas.h"

#include <cstring>

namespace relief {

Canvas::Canvas(double width, double height, double em)
    : surface_(
          cairo_image_surface_create(CAIRO_FORMAT_RGB24, static_cast<int>(width), static_cast<int>(height)),
          &cairo_surface_destroy),
      context_(cairo_create(surface_.get()), &cairo_destroy) {
    cairo_t* const cr = context_.get();
    // Grey antialiasing without hinting: identical glyphs on every machine.
    cairo_font_options_t* font = cairo_font_options_create();
    cairo_font_options_set_antialias(font, CAIRO_ANTIALIAS_GRAY);
    cairo_font_options_set_hint_style(font, CAIRO_HINT_STYLE_NONE);
    cairo_font_options_set_hint_metrics(font, CAIRO_HINT_METRICS_OFF);
    cairo_set_font_options(cr, font);
    cairo_font_options_destroy(font);
    cairo_select_font_face(cr, "sans-serif", CAIRO_FONT_SLANT_NORMAL, CAIRO_FONT_WEIGHT_NORMAL);
    cairo_set_font_size(cr, em);
    cairo_set_source_rgb(cr, 1.0, 1.0, 1.0);
    cairo_paint(cr);
}

void Canvas::fill(double x, double y, double width, double height, const Color& color) {
    cairo_set_source_rgb(context_.get(), color.r, color.g, color.b);
    cairo_rectangle(context_.get(), x, y, width, height);
    cairo_fill(context_.get());
}

void Canvas::text(double x, double y, const std::string& words) {
    cairo_set_source_rgb(context_.get(), kInk.r, kInk.g, kInk.b);
    cairo_move_to(context_.get(), x, y);
    cairo_show_text(context_.get(), words.c_str());
}

double Canvas::textWidth(const std::string& words) const {
    cairo_text_extents_t extents;
    cairo_text_extents(context_.get(), words.c_str(), &extents);
    return extents.x_advance;
}

void Canvas::circle(double x, double y, double radius, double line, const Color& color) {
    cairo_set_source_rgb(context_.get(), color.r, color.g, color.b);
    cairo_set_line_width(context_.get(), line);
    cairo_new_sub_path(context_.get());
    cairo_arc(context_.get(), x, y, radius, 0.0, 6.283185307179586);
    cairo_stroke(context_.get());
}

void Canvas::image(double x, double y, std::uint32_t width, std::uint32_t height, double zoom,
                   const std::function<Color(std::uint32_t, std::uint32_t)>& color) {
    const std::unique_ptr<cairo_surface_t, decltype(&cairo_surface_destroy)> pixels(
        cairo_image_surface_create(CAIRO_FORMAT_RGB24, static_cast<int>(width), static_cast<int>(height)),
        &cairo_surface_destroy);
    if (cairo_surface_status(pixels.get()) != CAIRO_STATUS_SUCCESS) {
        return;
    }
    unsigned char* to = cairo_image_surface_get_data(pixels.get());
    const auto stride = static_cast<std::size_t>(cairo_image_surface_get_stride(pixels.get()));
    for (std::uint32_t row = 0; row < height; ++row) {
        for (std::uint32_t column = 0; column < width; ++column) {
            const glm::uvec3 byte(glm::dvec3(0.5) + 255.0 * color(column, row));
            const std::uint32_t pixel = byte.r << 16 | byte.g << 8 | byte.b;
            std::memcpy(to + row * stride + column * sizeof(pixel), &pixel, sizeof(pixel));
        }
    }
    cairo_surface_mark_dirty(pixels.get());
    cairo_t* const cr = context_.get();
    cairo_save(cr);
    cairo_translate(cr, x, y);
    cairo_scale(cr, zoom, zoom);
    cairo_set_source_surface(cr, pixels.get(), 0.0, 0.0);
    cairo_pattern_set_filter(cairo_get_source(cr), CAIRO_FILTER_NEAREST);
    cairo_paint(cr);
    cairo_restore(cr);
}

Result<std::vector<std::byte>> Canvas::png() {
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
        return fail(ErrorCode::kFailure, std::string("cannot draw the image: ") +
                                             cairo_status_to_string(status) + "; lower --size");
    }
    return png;
}

}  // namespace relief

#include "bake/picture/color.h"

#include <algorithm>
#include <cmath>

#include "formats/base/portable_math.h"

namespace relief {
namespace {

double toSrgb(double linear) {
    const double c = std::clamp(linear, 0.0, 1.0);
    return c <= 0.0031308 ? 12.92 * c : 1.055 * portable::pow(c, 1.0 / 2.4) - 0.055;
}

}  // namespace

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

Color distanceColor(double u) {
    const double amount = std::min(std::abs(u), 1.0);
    const double lightness = 0.97 - 0.56 * amount;
    const double chroma = 0.135 * std::sqrt(amount) * (1.0 - 0.25 * amount);
    return u < 0.0 ? fromOklch(lightness, chroma, 255.0) : fromOklch(lightness, chroma, 60.0 - 12.0 * amount);
}

std::uint32_t toPixel(const Color& c) {
    const auto byte = [](double v) { return static_cast<std::uint32_t>(std::lround(v * 255.0)); };
    return byte(c.r) << 16 | byte(c.g) << 8 | byte(c.b);
}

}  // namespace relief

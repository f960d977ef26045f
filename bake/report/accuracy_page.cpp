#include "bake/report/accuracy_page.h"

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <glm/geometric.hpp>
#include <span>
#include <utility>
#include <vector>

#include "bake/picture/close_up.h"
#include "bake/picture/color.h"
#include "bake/picture/heat_map.h"
#include "bake/picture/map_image.h"
#include "bake/picture/slice.h"
#include "bake/picture/slice_image.h"
#include "bake/report/accuracy_report.h"
#include "bake/report/base64.h"
#include "bake/report/parts_report.h"
#include "bake/report/report.h"

namespace relief {
namespace {

constexpr std::uint32_t kMapPictureMax = 252;  // pixels along a side
constexpr std::size_t kMapsShownMax = 64;
constexpr std::uint32_t kHeatMapSize = 440;
constexpr std::uint32_t kSliceSize = 360;
constexpr std::uint32_t kCloseUpSize = 280;

constexpr const char* kStyle = R"css(
:root { color-scheme: light }
body { margin: 0; background: #f4f5f7; color: #21242a; font: 15px/1.5 system-ui, "DejaVu Sans", sans-serif }
main { max-width: 1120px; margin: 0 auto; padding: 28px 24px 48px }
h1 { font-size: 26px; line-height: 1.25; margin: 0 0 4px; overflow-wrap: anywhere }
h2 { font-size: 18px; margin: 36px 0 4px }
p { margin: 4px 0 12px; color: #6b7078; max-width: 76ch }
.tiles { display: grid; grid-template-columns: repeat(4, 1fr); gap: 12px; margin: 20px 0 12px }
.tile, .card { background: #fff; border: 1px solid #e1e3e8; border-radius: 8px }
.tile { padding: 12px 16px }
.tile b { display: block; font-size: 25px; font-weight: 600; font-variant-numeric: tabular-nums }
.tile span { color: #6b7078; font-size: 13px }
.card { padding: 14px 16px; overflow-x: auto }
table { border-collapse: collapse; width: 100%; font-variant-numeric: tabular-nums }
td, th { text-align: left; padding: 5px 14px 5px 0; border-bottom: 1px solid #eceef1; font-weight: 400 }
tr:last-child td { border-bottom: 0 }
th { color: #6b7078; font-size: 13px }
td.n, th.n { text-align: right; padding-right: 0; padding-left: 14px; white-space: nowrap }
.tables { display: grid; gap: 12px; margin-bottom: 10px }
.views { display: grid; grid-template-columns: repeat(auto-fit, minmax(400px, 1fr)); gap: 4px }
.slices { display: grid; gap: 12px }
img { display: block; max-width: 100%; height: auto; margin: 0 auto }
.legend { display: flex; flex-wrap: wrap; align-items: center; gap: 6px 22px; margin-top: 10px; font-size: 13px }
.bar { width: 300px }
.bar i { display: block; height: 14px; border: 1px solid #c9ccd2 }
.bar span { display: flex; justify-content: space-between; color: #6b7078 }
.key i { display: inline-block; width: 22px; height: 13px; margin-right: 7px; vertical-align: -1px; border: 1px solid #c9ccd2 }
.map { margin-top: 12px }
.map h3 { font-size: 15px; margin: 0 0 8px; font-weight: 600 }
.map h3 small { font-weight: 400; color: #6b7078; font-size: 13px }
.pictures { display: flex; flex-wrap: wrap; gap: 10px }
figure { margin: 0 }
.pictures img { border: 1px solid #e1e3e8; image-rendering: pixelated }
figcaption { color: #6b7078; font-size: 12px; margin-top: 3px }
.verdict { font-size: 19px; color: #21242a; margin: 14px 0 0 }
.verdict b { border-radius: 6px; padding: 1px 10px; margin-left: 6px; font-weight: 600 }
.good { background: #d9ead6 } .fair { background: #fbeccb } .poor { background: #f6d3cd }
.place { display: grid; grid-template-columns: 1fr auto auto; gap: 8px 18px; margin-bottom: 12px }
.place h3 { font-size: 15px; margin: 0 0 6px; font-weight: 600 }
.place p { margin: 0 0 8px }
.place figure { position: relative; width: 280px }
.ring { position: absolute; border: 2px solid #fff; outline: 2px solid #21242a; border-radius: 50%; box-sizing: border-box; transform: translate(-50%, -50%) }
.pin { display: inline-block; background: #21242a; color: #fff; border: 2px solid #fff; border-radius: 50%; width: 22px; height: 22px; line-height: 22px; text-align: center; font-size: 13px; font-weight: 600; box-sizing: content-box }
.seen { position: relative; width: fit-content; margin: 0 auto }
.seen .pin { position: absolute; transform: translate(-50%, -50%) }
.seen .ghost { background: #fff; color: #21242a; border: 2px dashed #21242a; opacity: 0.75 }
pre { background: #f4f5f7; border: 1px solid #e1e3e8; border-radius: 6px; padding: 8px 12px; margin: 0 0 4px; white-space: pre-wrap; overflow-wrap: anywhere; font-size: 13px }
@media (max-width: 900px) { .place { grid-template-columns: auto auto } .place > div { grid-column: 1 / -1 } }
@media (max-width: 720px) { .tiles { grid-template-columns: repeat(2, 1fr) } }
)css";

std::string escaped(const std::string& text) {
    std::string out;
    for (const char c : text) {
        switch (c) {
            case '&':
                out += "&amp;";
                break;
            case '<':
                out += "&lt;";
                break;
            case '>':
                out += "&gt;";
                break;
            case '"':
                out += "&quot;";
                break;
            default:
                out += c;
        }
    }
    return out;
}

std::string cssColor(const Color& color) {
    char text[8];
    std::snprintf(text, sizeof(text), "#%06x", toPixel(color));
    return text;
}

std::string imageTag(std::span<const std::byte> png, const std::string& alt) {
    return "<img alt=\"" + escaped(alt) + "\" src=\"data:image/png;base64," + base64(png) + "\">";
}

std::string percentText(double value) {
    return shortNumber(value) + "&#8239;%";
}

/// Cells of one row; those after the first are numbers.
std::string row(const std::vector<std::string>& cells, bool head = false) {
    std::string html = "<tr>";
    for (std::size_t i = 0; i < cells.size(); ++i) {
        const char* tag = head ? "th" : "td";
        html.append("<").append(tag).append(i > 0 ? " class=n>" : ">").append(cells[i]);
        html.append("</").append(tag).append(">");
    }
    return html + "</tr>\n";
}

class Page {
  public:
    explicit Page(const AccuracyPageInput& input)
        : input_(input),
          unit_(input.collider.unit.empty() ? "units" : escaped(input.collider.unit)),
          field_(fieldOf(input.collider)) {}

    Result<std::string> build() {
        const std::string name = escaped(input_.file_name);
        html_ = "<!doctype html>\n<html lang=en><meta charset=utf-8>\n<title>" + name +
                " measured</title>\n<meta name=viewport content=\"width=device-width\">\n<style>" + kStyle +
                "</style>\n<main>\n";
        addHead();
        addParts();
        // In braces, which have an order.
        for (const Result<void>& added : {addPlaces(), addNumbers(), addHeatMaps(), addSlices(), addMaps()}) {
            if (!added) {
                return forward(added);
            }
        }
        html_ += "</main>\n</html>\n";
        return std::move(html_);
    }

  private:
    [[nodiscard]] std::string length(double value) const { return shortNumber(value) + " " + unit_; }
    [[nodiscard]] std::string ofSide(double value) const {
        return percentText(100.0 * value / input_.samples.longest_side);
    }

    [[nodiscard]] std::string verdict() const {
        const double wrong = input_.accuracy.field.near.total();
        const std::string text = verdictText(wrong, input_.part_accuracy);
        const std::string grade = gradeOf(wrong, input_.part_accuracy);
        return text.substr(0, text.size() - grade.size()) + "<b class=" + grade + ">" + grade + "</b>";
    }

    void addHead() {
        const Provenance& from = input_.collider.provenance;
        const FieldAccuracy& field = input_.accuracy.field;
        html_ += "<h1>" + escaped(input_.file_name) + "</h1>\n<p>measured against " +
                 escaped(input_.query.mesh().name) + ", " +
                 std::to_string(input_.query.mesh().sourceTriangles()) + " triangles; baked by " +
                 escaped(from.tool_version) + "</p>\n<p class=verdict>" + verdict() +
                 "</p>\n<div class=tiles>\n";
        const auto tile = [&](const std::string& number, const char* words) {
            html_ += "<div class=tile><b>" + number + "</b><span>" + words + "</span></div>\n";
        };
        tile(percentText(field.near.total()), "of the points near the surface on the wrong side");
        tile(ofSide(field.distance_mean), "of the longest side: mean error of the distance");
        tile(shortNumber(field.normal_mean) + "&deg;", "mean error of the normal");
        tile(bytesText(input_.accuracy.gpu_bytes), "on the GPU");
        html_ += "</div>\n";
    }

    /// The parts that are lost or coarse by their own size.
    void addParts() {
        const std::string text = partsText(input_.part_accuracy, input_.parts, input_.collider);
        if (!text.empty()) {
            html_ +=
                "<h2>Parts</h2>\n<p>Each part of the mesh is measured by itself, at points 0.5&#8239;% of "
                "its own "
                "longest side off its surface.</p>\n<pre>" +
                escaped(text) + "</pre>\n";
        }
    }

    /// Pictures round each of the worst places, and what to do about them.
    Result<void> addPlaces() {
        if (input_.places.empty()) {
            return {};
        }
        html_ +=
            "<h2>The worst places</h2>\n<p>Each on a plane through it: the solid as the mesh has it, and as "
            "the "
            "collider has it. The ring is as wide as the place.</p>\n";
        for (std::size_t i = 0; i < input_.places.size(); ++i) {
            RELIEF_TRY(addPlace(input_.places[i], i + 1));
        }
        html_ += "<div class=legend>";
        const auto key = [&](const Color& color, const char* words) {
            html_ += "<div class=key><i style=\"background:" + cssColor(color) + "\"></i>" + words + "</div>";
        };
        key(kInsideColor, "inside");
        key(kOutsideColor, "outside");
        key(kFalseInsideColor, "outside, but called inside");
        key(kFalseOutsideColor, "inside, but called outside");
        html_ += "</div>\n";
        addAdvice();
        return {};
    }

    Result<void> addPlace(const WorstPlace& place, std::size_t number) {
        const glm::vec3& p = place.position;
        const glm::dvec3 closest = input_.query.closest(p).point;
        CloseUpOptions options;
        options.center = p;
        options.axis = axisAlong(glm::dvec3(p) - closest);
        const double side = input_.samples.longest_side;
        options.half = std::clamp(std::max(0.8 * place.size(), 3.0 * place.texel), 0.02 * side, 0.6 * side);
        options.size = kCloseUpSize;
        const CloseUp picture = drawCloseUp(input_.query, input_.collider, options);
        const std::vector<std::byte> truth = RELIEF_TRY(encodePng(picture.truth));
        const std::vector<std::byte> collider = RELIEF_TRY(encodePng(picture.collider));
        const std::string n = std::to_string(number);
        html_ += "<div class=\"card place\"><div><h3><span class=pin>" + n + "</span> " + positionText(p) +
                 "</h3>\n<p>" + escaped(placeText(place, input_.collider.unit)) + "</p>\n<p>" +
                 escaped(causeText(place, input_.collider)) + "</p>\n<p>Plane " + axisName(options.axis) +
                 " = " + shortNumber(double{p[options.axis]}) + ", " + length(2.0 * options.half) +
                 " wide; " + (options.axis == 0 ? "z" : "x") + " to the right, " +
                 (options.axis == 1 ? "z" : "y") + " upwards</p></div>\n";
        const std::string ring =
            "<span class=ring style=\"left:50%;top:140px;width:" + ringWidth(place, options) +
            "px;height:" + ringWidth(place, options) + "px\"></span>";
        html_ += "<figure>" + imageTag(truth, "the mesh at place " + n) + ring +
                 "<figcaption>the mesh</figcaption></figure>\n";
        html_ += "<figure>" + imageTag(collider, "the collider at place " + n) + ring +
                 "<figcaption>the collider</figcaption></figure></div>\n";
        return {};
    }

    static std::string ringWidth(const WorstPlace& place, const CloseUpOptions& options) {
        const double share = std::clamp(place.size() / (2.0 * options.half), 0.06, 0.98);
        return std::to_string(std::lround(share * kCloseUpSize));
    }

    void addAdvice() {
        if (input_.advice.empty()) {
            return;
        }
        html_ += "<h2>What to do</h2>\n<div class=card>\n";
        const double wrong = input_.accuracy.field.near.total();
        for (const Advice& advice : input_.advice) {
            const std::string left = advice.wrong_percent ? percentText(*advice.wrong_percent) : "";
            if (advice.wrong_percent && !advice.helps) {
                html_ += "<p>Tried, and of no help: " + escaped(advice.about) + " (" + left + ")</p>\n";
                continue;
            }
            html_ += "<pre>" + escaped(advice.command) + "</pre>\n<p>" + escaped(advice.about) + "; " +
                     (advice.wrong_percent ? "tried: " + left + " wrong instead of " + percentText(wrong)
                                           : "not tried: " + escaped(advice.untried)) +
                     "</p>\n";
        }
        html_ += "</div>\n";
    }

    Result<void> addNumbers() {
        const FieldAccuracy& field = input_.accuracy.field;
        const TruthSamples& samples = input_.samples;
        html_ += "<h2>Numbers</h2>\n<div class=tables><div class=card><table>\n";
        html_ += row({"points on the wrong side", "all", "false inside", "false outside"}, true);
        const auto wrong = [&](const char* where, const WrongShare& share) {
            html_ += row({where, percentText(share.total()), percentText(share.false_inside),
                          percentText(share.false_outside)});
        };
        wrong("near the surface", field.near);
        wrong("anywhere in the box", field.uniform);
        html_ += "</table></div>\n<div class=card><table>\n";
        html_ += row({"error", "mean", "99 % stay below"}, true);
        html_ += row({"signed distance near the surface",
                      length(field.distance_mean) + " (" + ofSide(field.distance_mean) + ")",
                      length(field.distance_p99) + " (" + ofSide(field.distance_p99) + ")"});
        html_ += row({"normal at the surface", shortNumber(field.normal_mean) + "&deg;",
                      shortNumber(field.normal_p99) + "&deg;"});
        html_ += "</table></div>\n<div class=card><table>\n";
        html_ += row({"surface that no map sees", percentText(input_.accuracy.unseen_percent)});
        html_ += row(
            {"points near the surface that are outside without a distance", percentText(field.far_percent)});
        html_ += row({"points near the surface for which no map votes", percentText(field.unknown_percent)});
        html_ += row({"points on the surface without a normal", percentText(field.no_normal_percent)});
        html_ += "</table></div></div>\n<p>" + std::to_string(samples.options.samples) +
                 " points of each kind, seed " + std::to_string(samples.options.seed) +
                 ". Those near the surface are drawn evenly from its area and moved by a normal deviate of " +
                 percentText(100.0 * samples.options.sigma_share) + " of the longest side, which is " +
                 length(samples.longest_side) +
                 ". Truth is the parity of rays through the mesh, by majority.</p>\n";
        return {};
    }

    Result<void> addHeatMaps() {
        const double range = input_.samples.options.sigma_share * input_.samples.longest_side;
        html_ +=
            "<h2>Error on the surface</h2>\n<p>The collider's signed distance at points of the mesh's "
            "surface, where it should be 0. Blue: the collider reaches beyond the mesh. Orange: it stays "
            "behind the mesh. The numbers are the worst places; those with a dashed rim lie behind what the "
            "picture "
            "shows.</p>\n<div class=card><div class=views>\n";
        constexpr std::pair<glm::vec3, const char*> kViews[] = {
            {{-1.0F, -0.6F, -1.0F}, "from +x, +y and +z"},
            {{1.0F, -0.6F, 1.0F}, "from -x, +y and -z"},
            {{1.0F, 0.9F, -1.0F}, "from below, -x and +z"},
            {{-1.0F, 0.9F, 1.0F}, "from below, +x and -z"}};
        for (const auto& [direction, words] : kViews) {
            const HeatMapOptions options{direction, kHeatMapSize, range};
            const RgbImage image = drawHeatMap(input_.query, field_, options);
            const std::vector<std::byte> png = RELIEF_TRY(encodePng(image));
            html_ += "<figure class=seen>" +
                     imageTag(png, std::string("error of the surface seen ") + words) + pins(options) +
                     "</figure>\n";
        }
        html_ += "</div>\n<div class=legend><div class=bar><i style=\"background:linear-gradient(90deg";
        for (int i = -10; i <= 10; ++i) {
            html_ += "," + cssColor(distanceColor(0.1 * i));
        }
        html_ += ")\"></i><span><span>&minus;" + length(range) + "</span><span>0</span><span>+" +
                 length(range) +
                 "</span></span></div>\n<div class=key><i style=\"background:" + cssColor(kHeatFarColor) +
                 "\"></i>outside, no distance known</div><div class=key><i "
                 "style=\"background:" +
                 cssColor(kHeatUnknownColor) + "\"></i>no map votes</div></div></div>\n";
        return {};
    }

    /// The worst places on a heat map.
    [[nodiscard]] std::string pins(const HeatMapOptions& options) const {
        std::string html;
        // The worst on top.
        for (std::size_t i = input_.places.size(); i-- > 0;) {
            const HeatMapPlace at = placeOnHeatMap(input_.query, options, input_.places[i].position);
            const auto share = [](double pixels) { return shortNumber(100.0 * pixels / kHeatMapSize) + "%"; };
            html += std::string("<span class=\"pin") + (at.hidden ? " ghost" : "") +
                    "\" style=\"left:" + share(at.x) + ";top:" + share(at.y) + "\">" + std::to_string(i + 1) +
                    "</span>";
        }
        return html;
    }

    Result<void> addSlices() {
        html_ +=
            "<h2>Slices</h2>\n<p>The collider's field on the three planes through the middle of its "
            "bounds.</p>\n<p>White stripes away from the surface are no surface. A texel holds a plane; at a "
            "silhouette, and where a wall runs along the line of sight, the plane stands along that line, "
            "and all "
            "along it the distance to the plane is near 0. The side is right there, so that nothing collides "
            "with a "
            "stripe; the errors of distances above are those of the nearest surface, which is searched for "
            "and has "
            "no stripes.</p>\n<div class=slices>\n";
        for (int axis = 0; axis < 3; ++axis) {
            SliceOptions options;
            options.axis = axis;
            options.size = kSliceSize;
            const Result<Slice> slice = evaluateSlice(input_.collider, options);
            const std::vector<std::byte> png = RELIEF_TRY(
                slice ? drawSlice(*slice, {input_.file_name, input_.collider.unit}) : forward(slice));
            html_ += "<div class=card>" + imageTag(png, std::string("slice across ") + axisName(axis)) +
                     "</div>\n";
        }
        html_ += "</div>\n";
        return {};
    }

    Result<void> addMaps() {
        const std::vector<DepthMap>& maps = input_.collider.maps;
        html_ +=
            "<h2>Maps</h2>\n<p>Depth from light, near, to dark, far, between the least and the largest of "
            "each picture; normals with x, y, z as red, green, blue. White: no surface.</p>\n";
        for (std::size_t i = 0; i < std::min(maps.size(), kMapsShownMax); ++i) {
            const DepthMap& map = maps[i];
            html_ += "<div class=\"card map\"><h3>Map " + std::to_string(i) + " <small>" +
                     mapFormatName(map.format) + ", keeps " + compareName(map.compare) + ", " +
                     std::to_string(map.width) + "&times;" + std::to_string(map.height) +
                     (map.faceCount() > 1 ? " &times; 6 faces" : "") + ", " + bytesText(map.texelBytes()) +
                     "</small></h3>\n<div class=pictures>\n";
            for (std::uint32_t face = 0; face < map.faceCount(); ++face) {
                RELIEF_TRY(addMapPictures(map, face));
            }
            html_ += "</div></div>\n";
        }
        if (maps.size() > kMapsShownMax) {
            html_ += "<p>" + std::to_string(maps.size() - kMapsShownMax) + " more maps are not shown.</p>\n";
        }
        return {};
    }

    Result<void> addMapPictures(const DepthMap& map, std::uint32_t face) {
        constexpr const char* kFaces[6] = {"+x ", "&minus;x ", "+y ", "&minus;y ", "+z ", "&minus;z "};
        const FloatImage image = mapImage(map, face, input_.collider.unit);
        const bool cube = map.faceCount() > 1;
        for (std::size_t first = 0; first + 3 < image.channels.size(); first += 4) {
            const std::string end = cube                        ? kFaces[face]
                                    : image.channels.size() > 4 ? (first == 0 ? "front " : "back ")
                                                                : "";
            const std::uint32_t most = cube ? kMapPictureMax * 2 / 3 : kMapPictureMax;
            for (const bool normals : {false, true}) {
                const std::vector<std::byte> png =
                    RELIEF_TRY(encodePng(picture(image, first, normals, most)));
                const std::string words = end + (normals ? "normals" : "depth");
                html_ +=
                    "<figure>" + imageTag(png, words) + "<figcaption>" + words + "</figcaption></figure>\n";
            }
        }
        return {};
    }

    /// \param first  channel of the depth; the normal's follow.
    /// \param most  pixels along a side: larger maps are thinned out, texels of smaller ones get larger.
    static RgbImage picture(const FloatImage& image, std::size_t first, bool normals, std::uint32_t most) {
        const std::vector<float>& depths = image.channels[first].values;
        float low = std::numeric_limits<float>::max();
        float high = -low;
        for (const float depth : depths) {
            if (std::isfinite(depth)) {
                low = std::min(low, depth);
                high = std::max(high, depth);
            }
        }
        const double scale = static_cast<double>(most) / std::max(image.width, image.height);
        const auto side = [&](std::uint32_t texels) {
            return std::max(1U, static_cast<std::uint32_t>(std::lround(scale * texels)));
        };
        RgbImage out{side(image.width), side(image.height), {}};
        out.pixels.reserve(std::size_t{out.width} * out.height);
        for (std::uint32_t y = 0; y < out.height; ++y) {
            for (std::uint32_t x = 0; x < out.width; ++x) {
                const std::size_t texel = std::uint64_t{y} * image.height / out.height * image.width +
                                          std::uint64_t{x} * image.width / out.width;
                Color color{1.0, 1.0, 1.0};
                if (std::isfinite(depths[texel])) {
                    if (normals) {
                        const auto channel = [&](std::size_t i) {
                            return std::clamp(0.5 + 0.5 * double{image.channels[first + 1 + i].values[texel]},
                                              0.0, 1.0);
                        };
                        color = {channel(0), channel(1), channel(2)};
                    } else {
                        const double t = high > low ? double{depths[texel] - low} / double{high - low} : 0.0;
                        color = fromOklch(0.93 - 0.68 * t, 0.035, 255.0);
                    }
                }
                out.pixels.push_back(toPixel(color));
            }
        }
        return out;
    }

    const AccuracyPageInput& input_;
    std::string unit_;
    Field field_;
    std::string html_;
};

}  // namespace

Result<std::string> accuracyPage(const AccuracyPageInput& input) {
    return Page(input).build();
}

}  // namespace relief

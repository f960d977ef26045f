// SPDX-License-Identifier: Apache-2.0
#include "bake/report/ground_report.h"

#include <algorithm>
#include <vector>

#include "bake/verdict/report_text.h"

namespace relief {
namespace {

/// Returns nullopt if all squares are steep.
std::optional<double> bound(double error_max) {
    return error_max > 0.0 ? std::optional(error_max) : std::nullopt;
}

/// Returns "12.3 mm".
std::string millimetres(double metres) {
    return shortNumber(1000.0 * metres) + " mm";
}

std::vector<std::string> nearRow(const std::string& kind, const GroundNear& near) {
    return {kind,
            std::to_string(near.points),
            percentText(near.wrong.total()),
            percentText(near.wrong.false_inside),
            percentText(near.wrong.false_outside),
            millimetres(near.mean),
            millimetres(near.mean_abs),
            millimetres(near.p99),
            millimetres(near.most),
            std::to_string(near.missing)};
}

/// Adds the fields that reports of a bake and of a check share.
void sourceFields(FieldVisitor& visit, const std::string& heights, std::uint32_t columns,
                  std::uint32_t rows) {
    visit("heights", heights, {"Effective settings, in the syntax of --heights"});
    visit("unit", std::string("m"), {.help = "Unit of lengths", .words = kWords<"m">});
    visit("columns", columns, {"Samples per row, along +x", {}, {2.0}});
    visit("rows", rows, {"Rows of samples, along +z", {}, {2.0}});
}

}  // namespace

std::string groundText(const GroundResult& result, const std::string& output, double ms) {
    const std::string tiles = result.container.empty() ? " in " + countText(result.tiles.size(), "tile") : "";
    const bool steep =
        std::ranges::any_of(result.tiles, [](const GroundTile& tile) { return tile.steep > 0; });
    const std::string error = millimetres(result.errorMax()) + " along y";
    return output + ": ground of " + std::to_string(result.columns) + "x" + std::to_string(result.rows) +
           " samples" + tiles + ", " +
           (!steep                    ? "height error at most " + error
            : result.errorMax() > 0.0 ? "height error at most " + error + " except at steep squares"
                                      : "steep everywhere") +
           "; " + bytesText(result.gpuBytes()) + "; " + shortNumber(ms / 1000.0) + " s\n";
}

void fields(FieldVisitor& visit, const GroundTile& tile) {
    visit("file", tile.file, {"Container in the folder of the world; empty without --world"});
    visit("hash", tile.hash, {.help = "XXH3-128 of the container", .pattern = kHashPattern});
    visit("bytes", tile.bytes, {"Size of the container", "bytes"});
    visit("gpu_bytes", tile.gpu_bytes, {"GPU memory", "bytes"});
    visit("coarse", tile.coarse,
          {"Coarse container that is used while this one is not on the GPU; null if it would save little"});
    visit("squares", tile.squares, {"Squares with ground", {}, kFromOne});
    visit("steep_squares", tile.steep, {"Of these, squares that rise by more than 2.9 times their side"});
    visit("error_max", bound(tile.error_max),
          {"Largest height error along y, except at steep squares; null if all are steep", "m", kFromZero});
    fields(visit, tile.box);
}

void fields(FieldVisitor& visit, const GroundJson& report) {
    const GroundResult& r = report.result;
    toolField(visit);
    visit("output", report.output, {"--output or --world as given"});
    sourceFields(visit, report.heights, r.columns, r.rows);
    visit("gpu_bytes", r.gpuBytes(), {"GPU memory of all tiles", "bytes"});
    visit("error_max", bound(r.errorMax()), {"The largest error_max of the tiles", "m", kFromZero});
    visit("tiles", r.tiles,
          {.help = "Tiles with ground, row by row; a single one without --world", .items = kFromOne});
    folderFields(visit, r.removed, report.ms, r.inputs, r.warnings);
}

std::string groundCheckText(const GroundAccuracy& accuracy, const std::string& name) {
    std::string text =
        name + ": ground of " + accuracy.height_map + ", " + std::to_string(accuracy.columns) + "x" +
        std::to_string(accuracy.rows) + " samples; " + countText(accuracy.squares, "square") +
        " with ground, " + std::to_string(accuracy.steep) + " of them steep, " +
        std::to_string(accuracy.holes) + " without\n" + percentText(accuracy.near.wrong.total()) +
        " of the points within " + lengthText(accuracy.within, "m") +
        " of the surface are on the wrong side; the error along y is " + millimetres(accuracy.near.mean_abs) +
        " on average, at most " + millimetres(accuracy.near.most) + "\n\n";
    std::vector<std::vector<std::string>> rows = {
        {"points", "number>", "wrong>", "false inside>", "false outside>", "mean error>", "absolute>",
         "99 %>", "largest>", "no surface>"},
        nearRow("near the surface", accuracy.near)};
    if (accuracy.seams) {
        rows.push_back(nearRow("near seams", *accuracy.seams));
    }
    rows.push_back({"anywhere", std::to_string(accuracy.uniform_points),
                    percentText(accuracy.uniform.total()), percentText(accuracy.uniform.false_inside),
                    percentText(accuracy.uniform.false_outside), "", "", "", "", ""});
    text += table(rows) + "\n";
    rows = {{"worst place", "tile", "error>", "rise / side of its square>"}};
    for (const GroundWorstPlace& place : accuracy.worst) {
        rows.push_back({positionText(place.position), place.node.empty() ? "-" : place.node,
                        place.error ? millimetres(*place.error) : "no surface", shortNumber(place.rise)});
    }
    return text + table(rows);
}

void fields(FieldVisitor& visit, const GroundNear& near) {
    visit("points", near.points, {"Points, the same number in each square with ground"});
    fields(visit, near.wrong);
    const auto distances = [&](FieldVisitor& inner) {
        inner("mean", near.mean, {"Mean, positive upwards", "m"});
        inner("mean_abs", near.mean_abs, {"Mean of the absolute values", "m", kFromZero});
        inner("p99", near.p99, {"99th percentile of the absolute values", "m", kFromZero});
        inner("max", near.most, {"Largest absolute value", "m", kFromZero});
    };
    visit("error", group(distances), {"Distances along y from the height map's surface to the collider's"});
    visit("missing", near.missing, {"Points without a collider surface within range; not counted in error"});
}

void fields(FieldVisitor& visit, const GroundWorstPlace& place) {
    visit("position", place.position, {"On the surface of the height map", "[x, y, z]"});
    visit("node", place.node, {"Tile at the place; empty for a single collider"});
    visit("error", place.error,
          {"Distance along y to the collider's surface; null if none is within range", "m"});
    visit("rise", place.rise, {"Rise of the square, relative to its side", {}, kFromZero});
}

void fields(FieldVisitor& visit, const GroundCheckJson& report) {
    const GroundAccuracy& a = report.accuracy;
    toolField(visit);
    visit("file", report.file, {"File of the collider or the world"});
    visit("height_map", a.height_map, {"File of the height map"});
    visit("hash", a.hash, {.help = "XXH3-128 of the height map's file", .pattern = kHashPattern});
    sourceFields(visit, report.heights, a.columns, a.rows);
    visit("squares", a.squares, {"Squares with ground", {}, kFromOne});
    visit("steep_squares", a.steep, {"Of these, squares that rise by more than 2.9 times their side"});
    visit("holes", a.holes, {"Squares without ground"});
    visit("within", a.within, {"Maximum distance of points near the surface, along y", "m", kFromZero});
    visit("near", a.near, {"Points near the surface"});
    visit("seams", a.seams,
          {"Of these, points within a leaf (four squares) of a seam between tiles; null if there are no "
           "seams"});
    const auto uniform = [&](FieldVisitor& inner) {
        inner("points", a.uniform_points, {"Points"});
        fields(inner, a.uniform);
    };
    visit("uniform", group(uniform),
          {"Points in the height map's box and one square around it, down to the required solid depth, "
           "including holes and edges"});
    visit("worst", a.worst, {"At most ten places, worst first"});
    visit("max_error_percent", report.max_error, {"--max-error; null without it", "%", kPercentRange});
    visit("warnings", a.warnings, {"Warnings, one line each"});
    visit("seconds", a.seconds, {"Time of the measurement", "s", kFromZero});
}

}  // namespace relief

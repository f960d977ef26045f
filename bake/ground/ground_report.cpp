// SPDX-License-Identifier: Apache-2.0
#include "bake/ground/ground_report.h"

#include <algorithm>

#include "bake/report/report_text.h"

namespace relief {
namespace {

/// There is none where all is steep.
std::optional<double> bound(double error_max) {
    return error_max > 0.0 ? std::optional(error_max) : std::nullopt;
}

}  // namespace

std::string groundText(const GroundResult& result, const std::string& output, double ms) {
    const std::string tiles = result.container.empty() ? " in " + countText(result.tiles.size(), "tile") : "";
    const bool steep = std::any_of(result.tiles.begin(), result.tiles.end(),
                                   [](const GroundTile& tile) { return tile.steep > 0; });
    const std::string error = shortNumber(1000.0 * result.errorMax()) + " mm along y";
    return output + ": ground of " + std::to_string(result.columns) + "x" + std::to_string(result.rows) +
           " samples" + tiles + ", " +
           (!steep                    ? "nowhere off by more than " + error
            : result.errorMax() > 0.0 ? "off by at most " + error + " except at steep squares"
                                      : "steep everywhere") +
           "; " + bytesText(result.gpuBytes()) + "; " + shortNumber(ms / 1000.0) + " s\n";
}

void fields(FieldVisitor& visit, const GroundTile& tile) {
    visit("file", tile.file, {"Its container, in the folder of the world; empty without --world"});
    visit("hash", tile.hash, {.help = "XXH3-128 of the container", .pattern = kHashPattern});
    visit("bytes", tile.bytes, {"Size of the container", "bytes"});
    visit("gpu_bytes", tile.gpu_bytes, {"Bytes that it takes on the GPU", "bytes"});
    visit("coarse", tile.coarse,
          {"Container that stands in for it while it is not on the GPU; null where that would save little"});
    visit("squares", tile.squares, {"Squares with ground", {}, kFromOne});
    visit("steep_squares", tile.steep, {"Those of them that rise by more than 2.9 of their side"});
    visit("error_max", bound(tile.error_max),
          {"Largest distance of the surface from its place, along y, except at steep squares; null where all "
           "are "
           "steep",
           "m", kFromZero});
    fields(visit, tile.box);
}

void fields(FieldVisitor& visit, const GroundJson& report) {
    const GroundResult& r = report.result;
    visit("tool", std::string("relief ") + RELIEF_VERSION, {"Name and version of the program"});
    visit("output", report.output, {"--output or --world as given"});
    visit("heights", report.heights, {"Effective settings, as --heights takes them"});
    visit("unit", std::string("m"), {.help = "Unit of lengths", .words = kWords<"m">});
    visit("columns", r.columns, {"Samples in a row, along +x", {}, {2.0}});
    visit("rows", r.rows, {"Rows of samples, along +z", {}, {2.0}});
    visit("gpu_bytes", r.gpuBytes(), {"Bytes that all tiles take on the GPU", "bytes"});
    visit("error_max", bound(r.errorMax()), {"The largest error_max of the tiles", "m", kFromZero});
    visit("tiles", r.tiles,
          {.help = "Tiles with ground, row by row; without --world the only one", .items = kFromOne});
    visit("removed", r.removed, {"Containers that only the world from before named, and that are gone now"});
    visit("ms", report.ms, {"Time of the whole run", "ms", kFromZero});
    visit("inputs", r.inputs, {.help = "All files that it was made from", .items = kFromOne});
    visit("warnings", r.warnings, {"Warnings, one line each"});
}

}  // namespace relief

#include "bake/ground/ground_report.h"

#include <algorithm>

#include "bake/report/report_text.h"

namespace relief {

std::string groundText(const GroundResult& result, const std::string& output, double ms) {
    const std::string tiles = result.container.empty() ? " in " + countText(result.tiles.size(), "tile") : "";
    const bool steep = std::any_of(result.tiles.begin(), result.tiles.end(),
                                   [](const GroundTile& tile) { return tile.steep > 0; });
    return output + ": ground of " + std::to_string(result.columns) + "x" + std::to_string(result.rows) +
           " samples" + tiles + ", " + (steep ? "off by at most " : "nowhere off by more than ") +
           shortNumber(1000.0 * result.errorMax()) + " mm along y" +
           (steep ? " but where it is steep; " : "; ") + bytesText(result.gpuBytes()) + "; " +
           shortNumber(ms / 1000.0) + " s\n";
}

}  // namespace relief

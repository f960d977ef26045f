#include "bake/ground/ground_report.h"

#include "bake/report/report_text.h"

namespace relief {

std::string groundText(const GroundResult& result, const std::string& output, double ms) {
    const std::string tiles = result.container.empty() ? " in " + countText(result.tiles.size(), "tile") : "";
    return output + ": ground of " + std::to_string(result.columns) + "x" + std::to_string(result.rows) +
           " samples" + tiles + ", nowhere off by more than " + shortNumber(1000.0 * result.errorMax()) +
           " mm along y; " + bytesText(result.gpuBytes()) + "; " + shortNumber(ms / 1000.0) + " s\n";
}

}  // namespace relief

#include "bake/world/world_report.h"

#include "bake/report/report_text.h"

namespace relief {
namespace {

std::string wrongText(const WorldColliderResult& collider) {
    return collider.wrong ? percentText(collider.wrong->total()) : "-";
}

}  // namespace

std::string worldBakeText(const WorldBakeResult& result, const std::string& folder, double ms, bool verbose) {
    std::vector<std::vector<std::string>> rows = {
        {"collider", "bodies>", "area>", "scale>", "share>", "taken>", "wrong>", "state"}};
    for (const WorldColliderResult& c : result.colliders) {
        rows.push_back({c.mesh + (c.tile.empty() ? "" : " " + c.tile), std::to_string(c.bodies),
                        shortNumber(c.area), shortNumber(c.largest_scale),
                        c.budget ? bytesText(*c.budget) : "-", bytesText(c.gpu_bytes), wrongText(c),
                        std::string(wordOf(c.state))});
    }
    const std::size_t baked = result.countOf(WorldColliderState::kBaked);
    const std::size_t kept = result.countOf(WorldColliderState::kUpToDate);
    std::string text = verbose ? table(rows) : "";
    text += folder + ": " + countText(result.world.bodies.size(), "body", "bodies") + " of " +
            countText(result.colliders.size(), "collider") + ": " + std::to_string(baked) + " baked, " +
            std::to_string(kept) + " up to date; " + bytesText(result.gpuBytes()) +
            (result.budget ? " of " + bytesText(*result.budget) : "") + "; " + shortNumber(ms / 1000.0) +
            " s\n";
    if (!result.removed.empty()) {
        text += "removed " + countText(result.removed.size(), "container") +
                " that only the world from before named\n";
    }
    return text;
}

}  // namespace relief

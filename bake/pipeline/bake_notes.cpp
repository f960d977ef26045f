// SPDX-License-Identifier: Apache-2.0
#include <algorithm>

#include "bake/pipeline/stages.h"
#include "bake/verdict/parts_report.h"
#include "bake/verdict/report_text.h"
#include "formats/base/text.h"

namespace relief {
namespace {

/// A source with at least this many nodes may be a level.
constexpr std::size_t kLevelNodes = 100;

/// Returns options that may help if a bake is wrong in many places.
std::string cureOf(const BakeRequest& request, const ShapeReport& shape) {
    const std::uint64_t budget = request.budget.value_or(kBudgetDefault);
    const std::string more = request.texel && !request.budget
                                 ? "--texel " + shortest(0.5F * *request.texel)
                                 : "--budget " + std::to_string(4 * budget / 1000) + "kB";
    if (shape.sheets > 0 && shape.as == ShapeAs::kAuto) {
        return "try " + more + ", or a larger --thickness for its sheets (now " +
               shortNumber(shape.thickness) + ")";
    }
    return "try " + more;
}

}  // namespace

std::vector<std::string> warningsOf(const BakeRequest& request, const SolidMesh& solid, const Baked& baked,
                                    const SelfCheck* check) {
    const TriangleMesh& mesh = *solid.mesh.mesh;
    std::vector<std::string> warnings = mesh.warnings;
    const auto warn = [&](const std::string& warning) { warnings.push_back(mesh.name + ": " + warning); };
    std::vector<std::string> parts = partWarnings(solid.parts, mesh.unit);
    std::for_each(parts.rbegin(), parts.rend(), warn);
    const auto forgotten = mesh.unit.empty() ? forgottenUnit(baked.collider.bounds) : std::nullopt;
    // A terrain of hundreds of metres is normal.
    if (forgotten && solid.shape.terrains == 0) {
        warn(*forgotten);
    }
    for (auto named = solid.shape.named.rbegin(); named != solid.shape.named.rend(); ++named) {
        if (named->triangles == 0) {
            warn("--as " + named->shape.name + "=" + std::string(wordOf(named->shape.as)) +
                 " has no effect: a later --as also selects all its triangles, or they have no area; give it "
                 "last");
        }
    }
    warnings.insert(warnings.end(), baked.report.warnings.begin(), baked.report.warnings.end());
    const double wrong = check != nullptr ? check->wrong.total() : 0.0;
    if (wrong > kGoodPercent) {
        warn(shortNumber(wrong) + " % wrong near the surface; " +
             (floatsLimit(mesh, wrong) ? "move it to the origin" : cureOf(request, solid.shape)));
    }
    if (check != nullptr && check->parts) {
        if (const auto lost = lostPartsWarning(*check->parts, solid.parts, baked.collider)) {
            warn(*lost);
        }
    }
    return warnings;
}

std::vector<std::string> noticesOf(const SolidMesh& solid, std::size_t nodes) {
    const TriangleMesh& mesh = *solid.mesh.mesh;
    std::vector<std::string> notices;
    if (mesh.closed_holes > 0) {
        notices.push_back("closed " + countText(mesh.closed_holes, "hole") +
                          " for baking: the mesh is nearly closed");
    }
    if (nodes >= kLevelNodes && !solid.animated) {
        notices.push_back(std::to_string(nodes) +
                          " nodes become one collider; if it is a level, bake it with --world DIR: each mesh "
                          "once, with more detail for the same bytes");
    }
    if (const std::uint64_t shells = solid.shape.unjoined_shells; shells > 0) {
        notices.push_back(countText(shells, "open shell") +
                          " inside another one, with rims too far apart to join: the space inside is solid; "
                          "to make it hollow, close the gap between the rims in the mesh");
    }
    if (const std::uint64_t walls = solid.shape.ambiguous_walls; walls > 0) {
        notices.push_back(
            countText(walls, "wall") +
            " made of two open shells; their winding does not distinguish a lining from a body: the "
            "space inside is free; bake clothed bodies with --as solid");
    }
    if (const std::uint64_t sheets = solid.shape.closable_sheets; sheets > 0) {
        notices.push_back(countText(sheets, "sheet") +
                          " would be solid with closed holes; bake with --as solid unless a vessel must stay "
                          "open");
    }
    for (std::string& notice : notices) {
        notice.insert(0, mesh.name + ": ");
    }
    return notices;
}

}  // namespace relief

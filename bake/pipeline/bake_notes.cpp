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

/// Returns options that may help if a bake is wrong in many places. \param coarser  the budget enlarged the texel
std::string fixFor(const BakeRequest& request, const ShapeReport& shape, bool coarser) {
    const std::uint64_t budget = request.budget.value_or(kBudgetDefault);
    const std::string more = request.texel && !(request.budget && coarser)
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
    const auto forgotten = mesh.unit.empty() ? missingUnitText(baked.collider.bounds) : std::nullopt;
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
    const bool floats = floatsLimit(mesh, wrong);
    // With --max-error the budget is only an upper limit, so a larger one would not change the bake.
    if (wrong > kGoodPercent && (floats || !request.max_error)) {
        warn(shortNumber(wrong) + " % wrong near the surface; " +
             (floats ? "move it to the origin"
                     : fixFor(request, solid.shape, baked.report.maps.front().coarser)));
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
    const auto note = [&](const std::string& text) { notices.push_back(mesh.name + ": " + text); };
    const auto noteParts = [&](std::uint64_t count, const char* what, const char* text) {
        if (count > 0) {
            note(countText(count, what) + text);
        }
    };
    if (mesh.closed_holes > 0) {
        note("closed " + countText(mesh.closed_holes, "hole") + " for baking: the mesh is nearly closed");
    }
    if (nodes >= kLevelNodes && !solid.animated) {
        note(std::to_string(nodes) +
             " nodes become one collider; if it is a level, bake it with --world DIR: each mesh once, with "
             "more detail for the same bytes");
    }
    noteParts(solid.shape.unjoined_shells, "open shell",
              " inside another one, with rims too far apart to join: the space inside is solid; to make it "
              "hollow, close the gap between the rims in the mesh");
    noteParts(solid.shape.ambiguous_walls, "wall",
              " made of two open shells; their winding does not distinguish a lining from a body: the space "
              "inside is free; bake clothed bodies with --as solid");
    noteParts(solid.shape.closable_sheets, "sheet",
              " would be solid with closed holes; bake with --as solid unless a vessel must stay open");
    return notices;
}

}  // namespace relief

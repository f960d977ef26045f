// SPDX-License-Identifier: Apache-2.0
#include "bake/repair/repair.h"

#include <string_view>
#include <utility>

#include "bake/repair/winding.h"
#include "formats/base/text.h"

namespace relief {

Result<double> wrapAlpha(const std::string& method) {
    constexpr std::string_view kWrap = "wrap=";
    const std::string text = method == "wrap" ? "wrap=0.01" : method;
    const std::optional<float> alpha =
        text.starts_with(kWrap) ? parseFloat(std::string_view(text).substr(kWrap.size())) : std::nullopt;
    if (!method.empty() && !(alpha && *alpha >= float(kWrapAlphaMin) && *alpha <= float(kWrapAlphaMax))) {
        return fail(ErrorCode::kUsage, "--repair is '" + cleanUtf8(method) +
                                           "' but must be wrap or wrap=ALPHA, where ALPHA is a number from " +
                                           shortest(float(kWrapAlphaMin)) + " to " +
                                           shortest(float(kWrapAlphaMax)) +
                                           ", in units of the mesh's longest side");
    }
    return double{alpha.value_or(0.0F)};
}

Result<RepairedMesh> repairMesh(PreparedMesh mesh, const RepairOptions& options) {
    const double alpha = RELIEF_TRY(wrapAlpha(options.method));
    const bool wraps = alpha > 0.0;
    RepairReport report;
    if (options.examine || options.strict || wraps) {
        report.health = inspectMesh(mesh);
    }
    if (options.strict && !wraps) {
        RELIEF_TRY(requireSolid(*report.health, mesh->name));
    }
    if (wraps) {
        report.repair = "wrap=" + shortest(static_cast<float>(alpha));
        mesh.freeEdges();
        mesh = RELIEF_TRY(wrapMesh(*mesh, alpha));
    }
    Winding winding = RELIEF_TRY(windOutwards(std::move(mesh)));
    mesh = std::move(winding.mesh);
    report.turned = winding.turned;
    if (wraps) {
        if (mesh.orientation() < 0.0) {
            mesh = std::move(mesh).woundOutwards(std::vector<bool>(mesh->triangles.size(), true));
        }
        report.repaired = inspectMesh(mesh);
        mesh.freeEdges();
        if (!report.repaired->isSolid()) {
            return fail(ErrorCode::kFailure,
                        mesh->name + ": wrapping it left " + faultsText(*report.repaired) +
                            "; move the mesh to the origin, or try another --repair wrap=ALPHA");
        }
    }
    return RepairedMesh{std::move(mesh), std::move(report)};
}

void fields(FieldVisitor& visit, RepairOptions& options) {
    visit("strict", options.strict,
          {.help = "Reject a mesh that is not a closed solid with outward winding (exit code 3)",
           .details = "With --repair, the repaired mesh must be a closed solid, even without --strict."});
    visit("repair", options.method,
          {.help = "Bake a closed surface wrapped around the mesh, which spans gaps of up to ALPHA times "
                   "the longest side of the mesh (default: 0.01)",
           .value = "wrap[=ALPHA]",
           .recorded = true});
}

}  // namespace relief

#include "bake/repair/repair.h"

#include <array>
#include <string_view>
#include <utility>

#include "bake/repair/mesh_repair.h"
#include "bake/repair/winding.h"
#include "formats/base/text.h"

namespace relief {
namespace {

constexpr std::array<std::string_view, 3> kMethods = {"wrap", "orient", "holes"};

enum class Method : std::uint8_t { kWrap, kOrient, kHoles };

struct Repair {
    Method method = Method::kWrap;
    float alpha = 0.01F;

    [[nodiscard]] std::string text() const {
        const std::string name(kMethods[static_cast<std::size_t>(method)]);
        return method == Method::kWrap ? name + "=" + shortest(alpha) : name;
    }
};

/// nullopt: none.
Result<std::optional<Repair>> parseRepair(const std::string& text) {
    if (text.empty()) {
        return std::nullopt;
    }
    const std::size_t equals = text.find('=');
    const std::string word = text.substr(0, equals);
    const auto found = std::find(kMethods.begin(), kMethods.end(), word);
    if (found == kMethods.end()) {
        return fail(ErrorCode::kUsage, "--repair is '" + cleanUtf8(text) + "' but must be one of " +
                                           listed(kMethods) + didYouMean(word, kMethods));
    }
    Repair repair;
    repair.method = static_cast<Method>(found - kMethods.begin());
    if (equals == std::string::npos) {
        return repair;
    }
    const std::optional<float> alpha = parseFloat(std::string_view(text).substr(equals + 1));
    if (repair.method != Method::kWrap) {
        return fail(ErrorCode::kUsage, "--repair " + word + " takes no value; leave out '" +
                                           cleanUtf8(text.substr(equals)) + "'");
    }
    if (!alpha || !(*alpha >= float(kWrapAlphaMin) && *alpha <= float(kWrapAlphaMax))) {
        return fail(ErrorCode::kUsage,
                    "--repair is '" + cleanUtf8(text) + "' but alpha must be a number from " +
                        shortest(float(kWrapAlphaMin)) + " to " + shortest(float(kWrapAlphaMax)) +
                        ", in units of the mesh's longest side");
    }
    repair.alpha = *alpha;
    return repair;
}

Result<TriangleMesh> repaired(const TriangleMesh& mesh, const Repair& repair, RepairReport& report) {
    switch (repair.method) {
        case Method::kWrap:
            return wrapMesh(mesh, double{repair.alpha});
        case Method::kOrient:
            return orientMesh(mesh);
        case Method::kHoles: {
            HoleFill fill = RELIEF_TRY(fillHoles(mesh));
            report.filled_holes = fill.filled;
            report.holes_left = fill.left;
            return std::move(fill.mesh);
        }
    }
    return mesh;
}

/// Examines the repaired mesh, and fails where the repair left faults.
Result<void> checkRepaired(const PreparedMesh& mesh, const Repair& repair, const RepairOptions& options,
                           RepairReport& report) {
    report.repaired = RELIEF_TRY(inspectMesh(mesh, options.check_intersections));
    mesh.freeEdges();
    if (repair.method == Method::kWrap && !report.repaired->isSolid()) {
        return fail(ErrorCode::kFailure,
                    mesh->name + ": wrapping it left " + faultsText(*report.repaired) +
                        "; move the mesh to the origin, or try another --repair wrap=ALPHA");
    }
    return options.strict ? requireSolid(*report.repaired, mesh->name) : Result<void>();
}

}  // namespace

Result<void> checkRepair(const std::string& method) {
    const Result<std::optional<Repair>> repair = parseRepair(method);
    return repair ? Result<void>() : forward(repair);
}

double wrapAlpha(const std::string& method) {
    const Result<std::optional<Repair>> repair = parseRepair(method);
    return repair && *repair && (*repair)->method == Method::kWrap ? double{(*repair)->alpha} : 0.0;
}

Result<RepairedMesh> repairMesh(PreparedMesh mesh, const RepairOptions& options) {
    const std::optional<Repair> repair = RELIEF_TRY(parseRepair(options.method));
    RepairReport report;
    if (options.examine || options.strict || options.check_intersections || repair) {
        report.health = RELIEF_TRY(inspectMesh(mesh, options.check_intersections));
    }
    if (options.strict && !repair) {
        RELIEF_TRY(requireSolid(*report.health, mesh->name));
    }
    if (repair) {
        report.repair = repair->text();
        mesh.freeEdges();
        mesh = RELIEF_TRY(repaired(*mesh, *repair, report));
    }
    Winding winding = RELIEF_TRY(windOutwards(std::move(mesh)));
    mesh = std::move(winding.mesh);
    report.turned = winding.turned;
    if (repair) {
        if (mesh.orientation() < 0.0) {
            mesh = std::move(mesh).woundOutwards(std::vector<bool>(mesh->triangles.size(), true));
        }
        RELIEF_TRY(checkRepaired(mesh, *repair, options, report));
    }
    return RepairedMesh{std::move(mesh), std::move(report)};
}

}  // namespace relief

#include "bake/repair/mesh_care.h"

#include <array>
#include <string_view>
#include <utility>

#include "bake/repair/mesh_repair.h"
#include "bake/repair/winding.h"
#include "formats/base/text.h"

namespace relief {
namespace {

constexpr std::array<std::string_view, 3> kMethods = {"wrap", "orient", "holes"};
constexpr std::string_view kWrapOption = "--repair wrap=";

enum class Method : std::uint8_t { kWrap, kOrient, kHoles };

struct Repair {
    Method method = Method::kWrap;
    float alpha = 0.01F;

    [[nodiscard]] std::string text() const {
        const std::string name(kMethods[static_cast<std::size_t>(method)]);
        return method == Method::kWrap ? name + "=" + shortest(alpha) : name;
    }
};

/// nullopt: none is asked for.
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

Result<TriangleMesh> repaired(const TriangleMesh& mesh, const Repair& repair, MeshCare& care) {
    switch (repair.method) {
        case Method::kWrap:
            return wrapMesh(mesh, double{repair.alpha});
        case Method::kOrient:
            return orientMesh(mesh);
        case Method::kHoles: {
            HoleFill fill = RELIEF_TRY(fillHoles(mesh));
            care.filled_holes = fill.filled;
            care.holes_left = fill.left;
            return std::move(fill.mesh);
        }
    }
    return mesh;
}

/// Looks at the mesh again, and at whether it became what was asked for.
Result<void> checkRepaired(const PreparedMesh& mesh, const Repair& repair, const MeshCareOptions& options,
                           MeshCare& care) {
    care.repaired = RELIEF_TRY(inspectMesh(mesh, options.check_intersections));
    mesh.freeEdges();
    if (repair.method == Method::kWrap && !care.repaired->isSolid()) {
        return fail(ErrorCode::kFailure,
                    mesh->name + ": wrapping it left " + faultsText(*care.repaired) +
                        "; move the mesh to the origin, or try another --repair wrap=ALPHA");
    }
    return options.strict ? requireSolid(*care.repaired, mesh->name) : Result<void>();
}

}  // namespace

Result<void> checkMeshCare(const MeshCareOptions& options) {
    const Result<std::optional<Repair>> repair = parseRepair(options.repair);
    return repair ? Result<void>() : forward(repair);
}

Result<CaredMesh> careFor(PreparedMesh mesh, const MeshCareOptions& options) {
    const std::optional<Repair> repair = RELIEF_TRY(parseRepair(options.repair));
    MeshCare care;
    if (options.report || options.strict || options.check_intersections || repair) {
        care.health = RELIEF_TRY(inspectMesh(mesh, options.check_intersections));
    }
    if (options.strict && !repair) {
        RELIEF_TRY(requireSolid(*care.health, mesh->name));
    }
    if (repair) {
        care.repair = repair->text();
        mesh.freeEdges();
        mesh = RELIEF_TRY(repaired(*mesh, *repair, care));
    }
    Winding winding = RELIEF_TRY(windOutwards(std::move(mesh)));
    mesh = std::move(winding.mesh);
    care.turned = winding.turned;
    if (repair) {
        if (mesh.orientation() < 0.0) {
            mesh = std::move(mesh).woundOutwards(std::vector<bool>(mesh->triangles.size(), true));
        }
        RELIEF_TRY(checkRepaired(mesh, *repair, options, care));
    }
    return CaredMesh{std::move(mesh), std::move(care)};
}

std::string careOptionsText(const MeshCare& care) {
    return care.repair.empty() ? "" : " --repair " + care.repair;
}

double repairReach(const std::string& container_options) {
    const std::size_t at = container_options.find(kWrapOption);
    if (at == std::string::npos) {
        return 0.0;
    }
    std::string_view alpha = std::string_view(container_options).substr(at + kWrapOption.size());
    alpha = alpha.substr(0, alpha.find(' '));
    // Any container may say anything here.
    const std::optional<float> value = parseFloat(alpha);
    return value && *value > 0.0F && *value <= float(kWrapAlphaMax) ? double{*value} / 30.0 : 0.0;
}

}  // namespace relief

#include "bake/mesh_care.h"

#include <array>
#include <string_view>
#include <utility>

#include "bake/mesh_repair.h"
#include "bake/report.h"
#include "bake/text.h"
#include "bake/triangle_plane.h"
#include "bake/winding.h"

namespace relief {
namespace {

using Json = nlohmann::ordered_json;

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
            return wrapMesh(mesh, {double{repair.alpha}});
        case Method::kOrient:
            return orientMesh(mesh);
        case Method::kHoles: {
            Result<HoleFill> fill = fillHoles(mesh);
            if (!fill) {
                return forward(fill);
            }
            care.filled_holes = fill->filled;
            care.holes_left = fill->left;
            return std::move(fill->mesh);
        }
    }
    return mesh;
}

void turnInsideOut(TriangleMesh& mesh) {
    for (glm::uvec3& t : mesh.triangles) {
        std::swap(t.y, t.z);
    }
}

Json jsonHealth(const std::optional<MeshHealth>& health) {
    if (!health) {
        return nullptr;
    }
    Json json = {{"solid", health->isSolid()},
                 {"closed", health->closed},
                 {"inside_out", health->inside_out},
                 {"triangles", health->triangles},
                 {"degenerate_triangles", health->degenerate_triangles},
                 {"duplicate_triangles", health->duplicate_triangles},
                 {"boundary_edges", health->boundary_edges},
                 {"nonmanifold_edges", health->nonmanifold_edges},
                 {"nonmanifold_vertices", health->nonmanifold_vertices},
                 {"inconsistent_edges", health->inconsistent_edges},
                 {"components", health->components},
                 {"closed_components", health->closed_components},
                 {"self_intersections",
                  health->self_intersections ? Json(*health->self_intersections) : Json(nullptr)},
                 {"first_fault", nullptr}};
    if (const std::optional<MeshFault>& fault = health->first_fault) {
        json["first_fault"] = {
            {"what", fault->what},
            {"at", {jsonNumber(fault->at.x), jsonNumber(fault->at.y), jsonNumber(fault->at.z)}}};
    }
    return json;
}

std::string healthLine(const MeshHealth& health) {
    std::string text = health.isSolid() ? "a closed solid" : faultsText(health);
    text +=
        "; " + std::to_string(health.components) + (health.components == 1 ? " component" : " components");
    if (health.closed_components != health.components) {
        text += ", " + std::to_string(health.closed_components) + " closed";
    }
    return text;
}

std::string detailLines(const MeshHealth& health) {
    const auto line = [](const char* what, const std::string& value) {
        return std::string("  ") + what + ": " + value + "\n";
    };
    const auto count = [&](const char* what, std::uint64_t value) {
        return line(what, std::to_string(value));
    };
    std::string text =
        count("boundary edges", health.boundary_edges) +
        count("non-manifold edges", health.nonmanifold_edges) +
        count("non-manifold vertices", health.nonmanifold_vertices) +
        count("edges wound inconsistently", health.inconsistent_edges) +
        count("duplicate triangles", health.duplicate_triangles) +
        count("triangles without area, left out", health.degenerate_triangles) +
        line("closed", health.closed ? "yes" : "no") + line("inside out", health.inside_out ? "yes" : "no") +
        line("pairs of triangles that intersect", health.self_intersections
                                                      ? std::to_string(*health.self_intersections)
                                                      : "not counted, see --check-intersections");
    if (const std::optional<MeshFault>& fault = health.first_fault) {
        text += line("first fault", fault->what + " at " + shortest(fault->at));
    }
    return text;
}

}  // namespace

void addMeshCareOptions(CLI::App& verb, MeshCareOptions& options) {
    verb.add_flag(
        "--strict", options.strict,
        "Refuse a mesh that is not a closed solid wound outwards, with exit code 3; with --repair,\n"
        "what is left after it");
    verb.add_flag("--check-intersections", options.check_intersections,
                  "Also count the pairs of triangles that intersect, for the report and --strict");
    verb.add_option(
            "--repair", options.repair,
            "Bake another surface: wrap[=ALPHA] (a closed one shrunk round the mesh, spanning gaps of\n"
            "ALPHA longest sides, 0.01 by default), orient (taken apart where it is not manifold, and\n"
            "wound outwards) or holes (the same with every hole filled)")
        ->option_text("WORD");
}

Result<void> checkMeshCare(const MeshCareOptions& options) {
    const Result<std::optional<Repair>> repair = parseRepair(options.repair);
    return repair ? Result<void>() : forward(repair);
}

Result<CaredMesh> careFor(TriangleMesh mesh, const MeshCareOptions& options) {
    const Result<std::optional<Repair>> repair = parseRepair(options.repair);
    if (!repair) {
        return forward(repair);
    }
    CaredMesh cared;
    MeshCare& care = cared.care;
    MeshEdges edges = edgesOf(mesh);
    if (options.report || options.strict || options.check_intersections || *repair) {
        Result<MeshHealth> health = inspectMesh(mesh, edges, {options.check_intersections});
        if (!health) {
            return forward(health);
        }
        care.health = std::move(*health);
    }
    if (options.strict && !*repair) {
        if (const Result<void> solid = requireSolid(*care.health, mesh.name); !solid) {
            return forward(solid);
        }
    }
    if (*repair) {
        care.repair = (*repair)->text();
        edges = {};
        Result<TriangleMesh> other = repaired(mesh, **repair, care);
        if (!other) {
            return forward(other);
        }
        mesh = std::move(*other);
        edges = edgesOf(mesh);
    }
    Result<Winding> winding = windOutwards(std::move(mesh), std::move(edges));
    if (!winding) {
        return forward(winding);
    }
    cared.mesh = std::move(winding->mesh);
    care.turned = winding->turned;
    if (!*repair) {
        return cared;
    }
    if (orientation(cared.mesh) < 0.0) {
        turnInsideOut(cared.mesh);
    }
    Result<MeshHealth> after = inspectMesh(cared.mesh, {options.check_intersections});
    if (!after) {
        return forward(after);
    }
    care.repaired = std::move(*after);
    if ((*repair)->method == Method::kWrap && !care.repaired->isSolid()) {
        return fail(ErrorCode::kFailure,
                    cared.mesh.name + ": wrapping it left " + faultsText(*care.repaired) +
                        "; move the mesh to the origin, or try another --repair wrap=ALPHA");
    }
    if (options.strict) {
        if (const Result<void> solid = requireSolid(*care.repaired, cared.mesh.name); !solid) {
            return forward(solid);
        }
    }
    return cared;
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

std::string careText(const MeshCare& care, bool verbose) {
    if (!care.health) {
        return "";
    }
    std::string text =
        "mesh: " + (care.repaired ? std::to_string(care.health->triangles) + " triangles as it came; " : "") +
        healthLine(*care.health) + "\n";
    text += verbose ? detailLines(*care.health) : "";
    if (care.repaired) {
        text += "after --repair " + care.repair + ": " + std::to_string(care.repaired->triangles) +
                " triangles; " + healthLine(*care.repaired);
        if (care.filled_holes + care.holes_left > 0) {
            text += "; " + std::to_string(care.filled_holes) + " holes filled, " +
                    std::to_string(care.holes_left) + " left";
        }
        text += "\n" + (verbose ? detailLines(*care.repaired) : "");
    } else if (care.turned > 0) {
        text += "turned " + std::to_string(care.turned) + (care.turned == 1 ? " triangle" : " triangles") +
                " to look outwards\n";
    }
    return text;
}

void addCareJson(const MeshCare& care, Json& json) {
    json["mesh_health"] = jsonHealth(care.health);
    json["repair"] = nullptr;
    if (!care.repair.empty()) {
        json["repair"] = {{"method", care.repair},
                          {"mesh_health", jsonHealth(care.repaired)},
                          {"filled_holes", care.filled_holes},
                          {"holes_left", care.holes_left}};
    }
    json["turned_triangles"] = care.turned;
}

}  // namespace relief

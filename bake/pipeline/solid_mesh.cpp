// SPDX-License-Identifier: Apache-2.0
#include <vector>

#include "bake/import/animated_import.h"
#include "bake/import/mesh_import.h"
#include "bake/mesh/triangle_plane.h"
#include "bake/pipeline/stages.h"
#include "formats/animation/mesh_pose.h"
#include "formats/base/text.h"

namespace relief {
namespace {

/// Reverses the triangles of an animated mesh that were reversed in its rest pose.
/// \param before, wound  the pose's triangles with an area, as imported and after winding.
void copyWinding(const std::vector<glm::uvec3>& before, const std::vector<glm::uvec3>& wound,
                 AnimatedMesh& mesh) {
    const std::vector<glm::vec3> rest = posed(mesh, restPose(mesh));
    std::size_t next = 0;
    for (glm::uvec3& t : mesh.triangles) {
        if (!hasArea(planeOf(rest, t))) {
            continue;  // finishMesh has dropped it
        }
        if (next < before.size() && next < wound.size() && before[next] != wound[next]) {
            t = {t.x, t.z, t.y};
        }
        ++next;
    }
}

/// \param mesh  its triangles are those of the source. \return empty if no materials are kept.
Result<MaterialSource> materialsOf(const BakeRequest& request, const TriangleMesh& mesh) {
    if (request.materials == MaterialMode::kDrop || request.animated) {
        return MaterialSource();
    }
    return materialSource(mesh, request.materials.has_value());
}

Result<void> checkThickness(const BakeRequest& request, const TriangleMesh& mesh) {
    const std::optional<Thickness>& thickness = request.thickness;
    const float longest = mesh.bounds.longestSide();
    if (request.holes == Holes::kKeep || !thickness || thickness->by_part ||
        thickness->length <= kThicknessMax * double{longest}) {
        return {};
    }
    return fail(ErrorCode::kUsage, "--thickness is " + shortest(static_cast<float>(thickness->length)) +
                                       " but " + mesh.name + " is " + shortest(longest) +
                                       " long; give at most " + shortest(float(kThicknessMax)) +
                                       " times its length");
}

}  // namespace

Result<SourceMesh> importSource(const BakeRequest& request, const BakeSettings& settings) {
    if (request.animated) {
        AnimatedImport animated = RELIEF_TRY(
            importAnimatedInWorker(request.mesh, request.clips, request.import, request.import_limits));
        return SourceMesh{std::move(animated.rest), std::move(animated.mesh)};
    }
    ImportOptions import = request.import;
    import.names = settings.shape.names();
    return SourceMesh{RELIEF_TRY(importMeshInWorker(request.mesh, import, request.import_limits))};
}

Result<SolidMesh> solidOf(const BakeRequest& request, SourceMesh source, const BakeWatcher& watcher) {
    const bool repairs = !request.repair.method.empty();
    SolidMesh solid;
    solid.unused_vertices = source.mesh.unused_vertices;
    solid.animated = std::move(source.animated);
    if (request.max_error && repairs) {
        solid.imported = source.mesh;
    }
    notify(watcher.begin, repairs ? "repairing the mesh" : "examining the mesh");
    const std::vector<glm::uvec3> before = solid.animated ? source.mesh.triangles : std::vector<glm::uvec3>();
    MaterialSource materials = repairs ? RELIEF_TRY(materialsOf(request, source.mesh)) : MaterialSource();
    solid.mesh = RELIEF_TRY(repairMesh(std::move(source.mesh), request.repair));
    if (!repairs) {
        materials = RELIEF_TRY(materialsOf(request, *solid.mesh.mesh));  // wound outwards
    }
    if (solid.animated && solid.mesh.report.turned > 0) {
        copyWinding(before, solid.mesh.mesh->triangles, *solid.animated);
    }
    RELIEF_TRY(checkThickness(request, *solid.mesh.mesh));
    if (request.holes == Holes::kClose) {
        notify(watcher.begin, "making a solid of the mesh");
    }
    ShapedMesh shaped = RELIEF_TRY(makeSolid(request, solid.mesh.mesh));
    solid.mesh.mesh = std::move(shaped.mesh);
    solid.shape = std::move(shaped.report);
    solid.parts = std::move(shaped.parts);
    if (!materials.empty()) {
        materials.sides = request.holes == Holes::kClose && !repairs && solid.shape.sheets == 0 &&
                          solid.shape.terrains == 0;
        solid.materials = std::make_shared<MaterialSource>(std::move(materials));
    }
    if (request.holes == Holes::kKeep) {
        solid.mesh.mesh.freeEdges();
    }
    return solid;
}

Result<ShapedMesh> makeSolid(const BakeRequest& request, const PreparedMesh& mesh) {
    if (request.holes == Holes::kKeep || request.animated) {
        return ShapedMesh{mesh, {}, surfacePartsOf(mesh)};
    }
    ShapeOptions options = RELIEF_TRY(shapeOptionsOf(request));
    options.thickness =
        request.thickness ? request.thickness->length
        : request.texel
            ? thicknessOfTexel(mesh->bounds, double{*request.texel})
            : defaultThickness(mesh->bounds,
                               request.max_error ? kBudgetDefault : request.budget.value_or(kBudgetDefault));
    return shapeMesh(mesh, options);
}

}  // namespace relief

// SPDX-License-Identifier: Apache-2.0
#include "bake/world/level_mesh_bake.h"

#include <algorithm>
#include <utility>

#include "bake/measure/self_check.h"
#include "bake/pipeline/bake.h"
#include "bake/verdict/report_text.h"
#include "bake/world/coarse_collider.h"
#include "formats/base/file_io.h"
#include "formats/base/hash.h"
#include "formats/container.h"

namespace relief {
namespace {

Result<void> writeCoarse(const WorldRequest& world, const Collider& coarse, WorldColliderResult& of) {
    const auto bytes = RELIEF_TRY(writeContainer(coarse, {static_cast<int>(world.compress)}));
    of.coarse = WorldFile{coarseFile(of.file), xxh3_128Hex(bytes), coarse.texelBytes()};
    of.coarse_bytes = bytes.size();
    return writeFile(world.folder / of.coarse->file, bytes);
}

}  // namespace

Result<std::vector<WorldColliderResult>> bakeLevelMesh(const LevelMeshBake& of,
                                                       WorldColliderResult& collider) {
    const SolidMesh& solid = of.solid;
    BakeResult result = RELIEF_TRY(bake(of.request, solid));
    PartsAccuracy accuracy;
    if (!of.world.bake.no_check) {
        SelfCheck check = RELIEF_TRY(
            selfCheck(result.mesh.mesh, solid.parts, result.baked.collider, collider.largest_scale));
        collider.wrong = check.wrong;
        accuracy = std::move(check.parts).value_or(PartsAccuracy());
        collider.verdict = verdictOf(collider.wrong->total(), accuracy, of.unit);
        collider.ignored.add(accuracy.ignored, collider.largest_scale);
    }
    collider.warnings = result.baked.report.warnings;
    if (const auto lost = lostPartsWarning(accuracy, solid.parts, result.baked.collider)) {
        collider.warnings.push_back(collider.mesh + ": " + *lost);
    }
    if (collider.wrong && collider.wrong->total() > kGoodPercent) {
        const bool floats = floatsLimit(*result.mesh.mesh, collider.wrong->total());
        collider.warnings.push_back(
            collider.mesh + ": " + shortNumber(collider.wrong->total()) + " % wrong near the surface" +
            (floats ? "; move it to the origin"
             : collider.budget
                 ? " with its share of " + bytesText(*collider.budget) + "; give the level a larger --budget"
                 : " with its texel; give the level a smaller --texel"));
    }
    PatchTileOptions options = of.tiles;
    options.total = collider.budget.value_or(options.total);
    const FineCollider whole = FineCollider::of(result.baked.collider);
    std::vector<ColliderTile> tiles = cutCollider(std::move(result.baked.collider), options);
    for (ColliderTile& tile : tiles) {
        if (tiles.size() > 1) {
            tile.collider.materials = materialsFor(tile.collider, solid.materials.get());
        }
    }
    std::vector<WorldColliderResult> parts;
    for (const ColliderTile& tile : tiles) {
        const auto bytes = RELIEF_TRY(writeContainer(tile.collider, {static_cast<int>(of.world.compress)}));
        WorldColliderResult part = collider;
        part.state = WorldColliderState::kBaked;
        part.tile = tile.name;
        part.file = of.names.fileOf(tile.name);
        RELIEF_TRY(writeFile(of.world.folder / part.file, bytes));
        copyContainerInfo(tile.collider, bytes, part);
        if (!parts.empty()) {
            part.warnings.clear();
            part.ignored = {};
        }
        parts.push_back(std::move(part));
    }
    TriangleMesh mesh = std::move(of.mesh);
    if (std::ranges::any_of(parts, &WorldColliderResult::has_coarse)) {
        const auto by = [&](const BakeRequest& request) {
            return solid.isBudgetIndependent() ? bake(request, solid) : bake(request, {}, std::move(mesh));
        };
        const Collider coarse = RELIEF_TRY(bakeCoarse(of.request, whole, by));
        for (std::size_t k = 0; k < parts.size(); ++k) {
            if (parts[k].has_coarse) {
                Collider part =
                    tiles.size() == 1 ? coarse : coarseTile(coarse, FineCollider::of(tiles[k].collider));
                part.materials =
                    tiles[k].collider.materials;  // a program keeps them when it replaces the maps
                RELIEF_TRY(writeCoarse(of.world, part, parts[k]));
            }
        }
    }
    return parts;
}

}  // namespace relief

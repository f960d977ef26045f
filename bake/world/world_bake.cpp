// SPDX-License-Identifier: Apache-2.0
#include "bake/world/world_bake.h"

#include <tbb/global_control.h>
#include <tbb/parallel_for_each.h>
#include <tbb/task_arena.h>

#include <algorithm>
#include <atomic>
#include <cmath>
#include <mutex>
#include <set>

#include "bake/import/level.h"
#include "bake/pipeline/bake.h"
#include "bake/pipeline/stages.h"
#include "bake/recipe/bake_cache.h"
#include "bake/shape/shape_options.h"
#include "bake/world/budget_share.h"
#include "bake/world/error_curves.h"
#include "bake/world/level_mesh_bake.h"
#include "bake/world/world_cache.h"
#include "bake/world/world_files.h"
#include "formats/base/hash.h"
#include "formats/base/stopwatch.h"

namespace relief {
namespace {

static_assert(kLevelMeshesMax == kWorldCollidersMax && kLevelBodiesMax == kWorldBodiesMax);

/// Approximate limit on the triangles of solids kept between planning and baking; other solids are prepared twice.
constexpr std::uint64_t kTrianglesKept = 4'000'000;

double areaOf(const TriangleMesh& mesh) {
    double twice = 0.0;
    for (const glm::uvec3& t : mesh.triangles) {
        const glm::dvec3 normal = planeOf(mesh.positions, t).normal;
        twice += std::sqrt(normal.x * normal.x + normal.y * normal.y + normal.z * normal.z);
    }
    return 0.5 * twice;
}

/// Resets the import options, which have already been applied to the mesh.
BakeRequest withoutImport(BakeRequest request) {
    request.import = {};
    request.import_limits = {};
    request.threads.reset();
    request.no_check = true;
    return request;
}

/// The weight of misclassified volume in object space: 1 / area^(3/4). Shares by volume would give nearly all bytes to
/// large meshes; shares by area would give too many to small meshes.
double errorWeight(double area) {
    return area > 0.0 ? 1.0 / (std::sqrt(area) * std::sqrt(std::sqrt(area))) : 0.0;
}

/// Converts a body; does not set its collider.
WorldBody bodyOf(const LevelBody& from) {
    WorldBody body;
    body.node = from.node;
    for (int i = 0; i < 3; ++i) {
        body.position[i] = static_cast<float>(from.position[static_cast<std::size_t>(i)]);
    }
    for (std::size_t i = 0; i < 4; ++i) {
        body.rotation[i] = static_cast<float>(from.rotation[i]);
    }
    body.scale = static_cast<float>(from.scale);
    return body;
}

class WorldBaker {
  public:
    WorldBaker(const WorldRequest& request, const WorldWatcher& watcher)
        : request_(request), watcher_(watcher) {}

    Result<WorldBakeResult> run() {
        RELIEF_TRY(checkWorldRequest(request_.bake));
        std::optional<tbb::global_control> control;
        if (request_.bake.threads) {
            control.emplace(tbb::global_control::max_allowed_parallelism, *request_.bake.threads);
        }
        RELIEF_TRY(readLevel());
        RELIEF_TRY(describeMeshes());
        RELIEF_TRY(share());
        RELIEF_TRY(findUpToDate());
        RELIEF_TRY(bakeStale());
        RELIEF_TRY(writeWorld());
        return std::move(result_);
    }

  private:
    Result<void> readLevel() {
        notify(watcher_.begin, "reading the level");
        names_ = RELIEF_TRY(parseShapeOptions(request_.bake.as)).names();
        ImportOptions options = request_.bake.import;
        options.names = names_;
        options.materials = request_.bake.materials != MaterialMode::kDrop;
        level_ = RELIEF_TRY(importLevel(request_.bake.mesh, options, request_.bake.import_limits));
        for (std::size_t i = 0; i < level_.dependencies.size(); ++i) {
            if (watcher_.files != nullptr) {
                RELIEF_TRY(watcher_.files->reads(level_.dependencies[i]));
            }
            result_.inputs.push_back({level_.dependencies[i], level_.dependency_hashes[i]});
        }
        result_.warnings = level_.warnings;
        return {};
    }

    Result<void> describeMeshes() {
        tool_ = RELIEF_TRY(toolIdentity());
        meshes_.resize(level_.meshes.size());
        parts_.resize(level_.meshes.size());
        solids_.resize(level_.meshes.size());
        tiles_.bytes = request_.tile_bytes;
        tiles_.most = maxTiles(level_.meshes.size(), level_.bodies.size());
        for (const LevelBody& body : level_.bodies) {
            WorldColliderResult& collider = meshes_[body.mesh];
            ++collider.bodies;
            collider.largest_scale = std::max(collider.largest_scale, body.scale);
        }
        // If the level has several materials, each collider keeps even a single one: together they are one surface.
        const bool several = !request_.bake.materials && hasSeveralMaterials(level_.meshes);
        for (std::size_t i = 0; i < level_.meshes.size(); ++i) {
            TriangleMesh& mesh = level_.meshes[i];
            meshes_[i].mesh = mesh.name;
            meshes_[i].area = areaOf(mesh);
            requests_.push_back(requestOf(request_.bake, names_, mesh));
            if (several) {
                requests_.back().materials = MaterialMode::kKeep;
            }
            inputs_.push_back({{mesh.name, mesh.content_hash},
                               {"marks", xxh3_128Hex(std::as_bytes(std::span(mesh.marks)))}});
            if (several || request_.bake.materials == MaterialMode::kKeep) {
                inputs_.back().push_back({"materials", materialHash(mesh)});
            }
        }
        return {};
    }

    Result<void> share() {
        if (request_.bake.texel && !request_.bake.budget) {
            return {};
        }
        result_.budget = request_.bake.budget.value_or(kWorldBudgetDefault);
        std::vector<BudgetShare> shares;
        if (!request_.bake.texel) {
            notify(watcher_.begin, "distributing the budget");
            shares.resize(meshes_.size());
            for (const LevelBody& body : level_.bodies) {
                // Volume / area^(3/4), in world space.
                shares[body.mesh].weight +=
                    errorWeight(meshes_[body.mesh].area) * body.scale * std::sqrt(body.scale);
            }
            RELIEF_TRY(shareByCurves(shares));
        } else {
            for (const WorldColliderResult& collider : meshes_) {
                shares.push_back({collider.area * collider.largest_scale * collider.largest_scale});
            }
            RELIEF_TRY(shareByArea(*result_.budget, shares));
        }
        for (std::size_t i = 0; i < shares.size(); ++i) {
            meshes_[i].budget = shares[i].bytes;
        }
        return {};
    }

    /// Distributes the budget by error curves, which are saved for the next run.
    Result<void> shareByCurves(std::span<BudgetShare> shares) {
        Result<ErrorCurves> known = loadErrorCurves(request_.folder);
        if (!known) {
            result_.warnings.push_back(known.error().message + "; planning all shares of the budget again");
            known = ErrorCurves{};
        }
        ErrorCurves used;
        std::mutex mutex;
        const auto plan = [&](std::size_t i, std::uint64_t bytes) -> Result<ErrorCurve> {
            BakeRequest request = requests_[i];
            request.budget = bytes;
            const std::string key = assetKey(tool_, cacheOptions(request, 0), inputs_[i]);
            const auto found = known->find(key);
            ErrorCurve curve = found != known->end() ? found->second : RELIEF_TRY(planMesh(i, bytes));
            const std::lock_guard lock(mutex);
            return used.insert_or_assign(key, std::move(curve)).first->second;
        };
        RELIEF_TRY(shareByErrors(*result_.budget, shares, plan));
        return *known == used ? Result<void>() : saveErrorCurves(request_.folder, used);
    }

    /// Returns the error curve of a mesh. Keeps its solid for the bake, within kTrianglesKept.
    [[nodiscard]] Result<ErrorCurve> planMesh(std::size_t mesh, std::uint64_t bytes) {
        BakeRequest request = withoutImport(requests_[mesh]);
        request.budget = kSharePerPlan * bytes;  // shells have the thickness for this budget
        SolidMesh solid = RELIEF_TRY(solidFor(request, mesh));
        Result<ErrorCurve> curve = planErrors(request, solid, bytes);
        if (!solids_[mesh] && solid.isBudgetIndependent() && kept_triangles_ < kTrianglesKept) {
            kept_triangles_ += solid.mesh.mesh->triangles.size();
            solids_[mesh] = std::move(solid);
        }
        return curve;
    }

    [[nodiscard]] Result<SolidMesh> solidFor(const BakeRequest& request, std::size_t mesh) const {
        return solids_[mesh] ? *solids_[mesh] : prepareSolid(request, level_.meshes[mesh]);
    }

    /// Names the containers, and validates the existing ones.
    Result<void> findUpToDate() {
        notify(watcher_.begin, "comparing with the cache");
        Result<BakeCacheEntries> cache = loadBakeCache(request_.folder);
        if (!cache) {
            result_.warnings.push_back(cache.error().message + "; baking everything again");
            cache = BakeCacheEntries{};
        }
        for (std::size_t i = 0; i < level_.meshes.size(); ++i) {
            WorldColliderResult& collider = meshes_[i];
            BakeRequest& request = requests_[i];
            if (collider.budget) {
                request.budget = bytesBeforeCut(*collider.budget, tiles_);
            }
            if (request.texel) {
                request.texel = static_cast<float>(double{*request.texel} / collider.largest_scale);
            }
            BakeCacheEntry entry{tool_, cacheOptions(request, request_.compress), inputs_[i], "", 0};
            request = withoutImport(request);
            if (!collider.budget || *collider.budget > tiles_.bytes) {
                entry.options.push_back("--tile-bytes=" + std::to_string(tiles_.bytes));
                if (tiles_.most < PatchTileOptions().most) {
                    entry.options.push_back("--tiles-most=" + std::to_string(tiles_.most));
                }
            }
            file_names_.push_back(ContainerNames::of(collider.mesh, entry));
            collider.file = file_names_[i].fileOf("");
            parts_[i] = upToDate(request_.folder, collider, file_names_[i], entry, *cache);
            if (parts_[i].empty()) {
                collider.state = WorldColliderState::kFailed;  // until it is baked
                stale_.push_back(i);
            }
            entries_.push_back(std::move(entry));
        }
        return {};
    }

    /// Bakes the largest meshes first, so that the last one to finish is small.
    Result<void> bakeStale() {
        notify(watcher_.begin, "baking colliders");
        std::ranges::stable_sort(stale_, std::greater<>(), [this](std::size_t i) {
            const WorldColliderResult& collider = meshes_[i];
            return collider.budget ? static_cast<double>(*collider.budget)
                                   : collider.area * collider.largest_scale * collider.largest_scale;
        });
        std::size_t done = level_.meshes.size() - stale_.size();
        std::mutex mutex;
        tbb::parallel_for_each(stale_.begin(), stale_.end(), [&](std::size_t i) {
            // Isolate, because a thread that waits in one bake could otherwise start another inside it.
            tbb::this_task_arena::isolate([&] { bakeOne(i); });
            const std::lock_guard lock(mutex);
            ++done;
            cacheResult(i);
            if (watcher_.ended) {
                watcher_.ended(done, level_.meshes.size());
            }
        });
        return fresh_.empty() ? Result<void>() : updateBakeCache(request_.folder, fresh_);
    }

    void bakeOne(std::size_t i) {
        WorldColliderResult& collider = meshes_[i];
        const Stopwatch watch;
        Result<std::vector<WorldColliderResult>> baked = tryBake(i, collider);
        if (!baked) {
            collider.error = baked.error();
            collider.ms = watch.ms();
            return;
        }
        collider.state = WorldColliderState::kBaked;
        parts_[i] = std::move(*baked);
        parts_[i].front().ms = watch.ms();
    }

    /// Bakes and writes the colliders of a mesh. \return these colliders.
    Result<std::vector<WorldColliderResult>> tryBake(std::size_t i, WorldColliderResult& collider) {
        const SolidMesh solid = RELIEF_TRY(solidFor(requests_[i], i));
        solids_[i].reset();
        return bakeLevelMesh(
            {request_, requests_[i], solid, level_.meshes[i], level_.unit, tiles_, file_names_[i]}, collider);
    }

    /// \pre No other thread is in this function.
    void cacheResult(std::size_t i) {
        BakeCacheEntry entry = entries_[i];
        if (parts_[i].size() > 1) {
            std::vector<std::string> tiles;
            for (const WorldColliderResult& part : parts_[i]) {
                tiles.push_back(part.tile);
            }
            entry.options.push_back(tilesOption(tiles));
        }
        for (const WorldColliderResult& part : parts_[i]) {
            entry.output_hash = part.hash;
            entry.output_bytes = part.bytes;
            fresh_[part.file] = entry;
            if (part.coarse) {
                entry.output_hash = part.coarse->hash;
                entry.output_bytes = part.coarse_bytes;
                fresh_[part.coarse->file] = entry;
            }
        }
        // Write every two seconds, because a killed run loses the results since the last write. Errors are reported by
        // the final write.
        if (since_cached_.seconds() > 2.0 && updateBakeCache(request_.folder, fresh_)) {
            fresh_.clear();
            since_cached_ = Stopwatch();
        }
    }

    Result<void> writeWorld() {
        World& world = result_.world;
        world.unit = level_.unit;
        std::vector<std::uint32_t> first;  // index of the first collider of each mesh
        for (std::size_t i = 0; i < meshes_.size(); ++i) {
            first.push_back(static_cast<std::uint32_t>(result_.colliders.size()));
            if (parts_[i].empty()) {
                parts_[i].push_back(meshes_[i]);  // the failed mesh
            }
            std::ranges::move(parts_[i], std::back_inserter(result_.colliders));
        }
        for (const WorldColliderResult& collider : result_.colliders) {
            world.colliders.push_back({{collider.file, collider.hash, collider.gpu_bytes},
                                       collider.mesh,
                                       collider.box,
                                       collider.coarse});
        }
        for (const LevelBody& from : level_.bodies) {
            WorldBody body = bodyOf(from);
            body.collider = first[from.mesh];
            for (std::size_t tile = 0; tile < parts_[from.mesh].size(); ++tile, ++body.collider) {
                world.bodies.push_back(body);
            }
        }
        if (result_.countOf(WorldColliderState::kFailed) > 0) {
            return {};
        }
        std::set<std::string> materials;
        for (const WorldColliderResult& collider : result_.colliders) {
            materials.insert(collider.materials.begin(), collider.materials.end());
        }
        ReplacedWorld replaced = RELIEF_TRY(replaceWorld(request_.folder, world, materials, level_.name));
        result_.removed = std::move(replaced.removed);
        std::ranges::move(replaced.warnings, std::back_inserter(result_.warnings));
        result_.written = true;
        return {};
    }

    const WorldRequest& request_;
    const WorldWatcher& watcher_;
    WorldBakeResult result_;
    std::vector<std::string> names_;  // from --as
    Level level_;                     // the meshes of stale entries are moved from
    std::string tool_;
    PatchTileOptions tiles_;
    std::vector<WorldColliderResult> meshes_;              // by mesh; copied to its colliders
    std::vector<std::vector<WorldColliderResult>> parts_;  // colliders of each mesh; empty while stale
    std::vector<ContainerNames> file_names_;               // by mesh
    std::vector<BakeRequest> requests_;                    // by mesh
    std::vector<std::vector<InputFile>> inputs_;
    std::vector<std::optional<SolidMesh>> solids_;  // by mesh; kept from planning
    std::atomic<std::uint64_t> kept_triangles_ = 0;
    std::vector<BakeCacheEntry> entries_;  // by mesh, without outputs
    std::vector<std::size_t> stale_;       // meshes
    BakeCacheEntries fresh_;               // not yet in the cache file
    Stopwatch since_cached_;
};

}  // namespace

std::size_t WorldBakeResult::countOf(WorldColliderState state) const {
    return static_cast<std::size_t>(std::ranges::count(colliders, state, &WorldColliderResult::state));
}

std::uint64_t WorldBakeResult::gpuBytes() const {
    std::uint64_t bytes = 0;
    for (const WorldColliderResult& collider : colliders) {
        bytes += collider.gpu_bytes;
    }
    return bytes;
}

Result<WorldBakeResult> bakeWorld(const WorldRequest& request, const WorldWatcher& watcher) {
    return WorldBaker(request, watcher).run();
}

}  // namespace relief

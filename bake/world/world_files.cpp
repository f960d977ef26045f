#include "bake/world/world_files.h"

#include <algorithm>
#include <map>
#include <set>
#include <span>
#include <system_error>
#include <utility>

#include "bake/recipe/bake_cache.h"
#include "bake/recipe/recipe_jobs.h"
#include "formats/animation/mesh_parts.h"
#include "formats/base/file_io.h"

namespace relief {
namespace {

namespace fs = std::filesystem;

constexpr std::size_t kStemMax = 64;

std::vector<WorldFile> filesOf(const std::vector<WorldCollider>& colliders) {
    std::vector<WorldFile> files;
    for (const WorldCollider& collider : colliders) {
        files.push_back(collider);
        if (collider.coarse) {
            files.push_back(*collider.coarse);
        }
    }
    return files;
}

void keepMaterials(World& world, const World& before, const std::set<std::string>& materials,
                   std::vector<std::string>& warnings) {
    std::vector<std::string> gone;
    for (const MaterialResponse& response : before.materials) {
        if (materials.contains(response.name)) {
            world.materials.push_back(response);
        } else {
            gone.push_back(response.name);
        }
    }
    if (!gone.empty()) {
        warnings.push_back(std::string(kWorldFileName) + ": no collider has a material " + listedNames(gone) +
                           " any more; the response by that name is left out");
    }
}

/// The numbers of the bodies of each node. Nodes may share a name, and tiles of a mesh do.
std::map<std::string, std::vector<std::size_t>> bodiesByNode(const World& world) {
    std::map<std::string, std::vector<std::size_t>> bodies;
    for (std::size_t i = 0; i < world.bodies.size(); ++i) {
        bodies[world.bodies[i].node].push_back(i);
    }
    return bodies;
}

void keepBodies(World& world, const World& before, std::vector<std::string>& warnings) {
    const auto response = [](const WorldBody& body) { return std::pair(body.restitution, body.friction); };
    const std::pair<float, float> untouched = response(WorldBody());
    const std::map<std::string, std::vector<std::size_t>> now = bodiesByNode(world);
    std::vector<std::string> gone;
    for (const auto& [node, old] : bodiesByNode(before)) {
        const auto all = [&, &known = old](const std::pair<float, float>& same) {
            return std::all_of(known.begin(), known.end(),
                               [&](std::size_t i) { return response(before.bodies[i]) == same; });
        };
        const bool alike = all(response(before.bodies[old.front()]));
        const auto found = now.find(node);
        if (found == now.end() || (!alike && found->second.size() != old.size())) {
            if (!all(untouched)) {
                gone.push_back(node);
            }
            continue;
        }
        for (std::size_t k = 0; k < found->second.size(); ++k) {
            const WorldBody& from = before.bodies[alike ? old.front() : old[k]];
            world.bodies[found->second[k]].restitution = from.restitution;
            world.bodies[found->second[k]].friction = from.friction;
        }
    }
    if (!gone.empty()) {
        warnings.push_back(std::string(kWorldFileName) + ": the bodies of " + listedNames(gone) +
                           " are gone or others; their restitution and friction are left out");
    }
}

std::vector<std::string> removeUnnamed(const fs::path& folder, const std::vector<WorldFile>& before,
                                       const World& world) {
    std::set<std::string> named;
    for (const WorldFile& file : filesOf(world.colliders)) {
        named.insert(file.file);
    }
    std::vector<std::string> removed;
    for (const WorldFile& old : before) {
        const fs::path path = folder / old.file;
        std::error_code error;
        const bool own = old.file.ends_with(kColliderExtension) && !fs::path(old.file).has_parent_path() &&
                         !named.contains(old.file) && hashOfFile(path) == old.hash;
        if (own && fs::remove(path, error)) {
            removed.push_back(old.file);
        }
    }
    return removed;
}

}  // namespace

std::string fileStem(std::string_view name) {
    std::string stem;
    for (const char c : name.substr(0, kStemMax)) {
        const bool plain = (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z') || (c >= '0' && c <= '9') ||
                           c == '-' || c == '.' || c == '_';
        stem += plain ? c : '_';
    }
    return stem.empty() || stem.front() == '.' || stem.front() == '-' ? "_" + stem : stem;
}

Result<ReplacedWorld> replaceWorld(const fs::path& folder, World& world,
                                   const std::set<std::string>& materials, const std::string& name) {
    ReplacedWorld replaced;
    const fs::path path = folder / kWorldFileName;
    const Result<World> before = loadWorldFile(path);
    std::error_code error;
    if (before) {
        keepMaterials(world, *before, materials, replaced.warnings);
        keepBodies(world, *before, replaced.warnings);
    } else if (fs::exists(path, error)) {
        replaced.warnings.push_back(before.error().message +
                                    "; it is replaced, without what was written into it by hand");
    }
    const std::string text = worldText(world);
    // A world that no reader would take must not be written: scales or places that floats do not hold.
    static_cast<void>(RELIEF_TRY(inFront(name, parseWorld(text))));
    RELIEF_TRY(writeFile(path, std::as_bytes(std::span(text))));
    if (before) {
        replaced.removed = removeUnnamed(folder, filesOf(before->colliders), world);
    }
    return replaced;
}

}  // namespace relief

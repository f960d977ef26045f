// SPDX-License-Identifier: Apache-2.0
#include "bake/world/world_files.h"

#include <algorithm>
#include <array>
#include <map>
#include <set>
#include <span>
#include <system_error>
#include <tuple>
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
        warnings.push_back(std::string(kWorldFileName) + ": no collider has the material " +
                           listedNames(gone) + " any more; its response is dropped");
    }
}

/// A placed node: its body, or the bodies of the tiles of its mesh.
struct Placed {
    std::span<const WorldBody> bodies;
    std::string node;
    std::array<float, 8> pose;
    std::vector<std::array<float, 6>> boxes;  ///< of the colliders, which identify the mesh
    std::size_t first = 0;                    ///< index into the bodies of the world
    bool matched = false;

    [[nodiscard]] std::array<float, 6> box() const {
        std::array<float, 6> all = boxes.front();
        for (const auto& one : boxes) {
            for (std::size_t i = 0; i < 3; ++i) {
                all[i] = std::min(all[i], one[i]);
                all[i + 3] = std::max(all[i + 3], one[i + 3]);
            }
        }
        return all;
    }
};

std::array<float, 8> poseKeyOf(const WorldBody& body) {
    const auto& [x, y, z, w] = body.rotation;
    return {body.position.x, body.position.y, body.position.z, x, y, z, w, body.scale};
}

std::vector<Placed> placedOf(const World& world) {
    std::vector<Placed> all;
    for (std::size_t i = 0; i < world.bodies.size(); ++i) {
        const WorldBody& body = world.bodies[i];
        const auto [low, high] = world.colliders[body.collider].box;
        const bool tile = !all.empty() && all.back().node == body.node &&
                          all.back().pose == poseKeyOf(body) &&
                          world.bodies[i - 1].collider + 1 == body.collider;
        if (!tile) {
            all.push_back({{}, body.node, poseKeyOf(body), {}, i});
        }
        all.back().boxes.push_back({low.x, low.y, low.z, high.x, high.y, high.z});
        all.back().bodies = std::span(world.bodies).subspan(all.back().first, i + 1 - all.back().first);
    }
    return all;
}

bool sameResponse(const WorldBody& a, const WorldBody& b) {
    return a.restitution == b.restitution && a.friction == b.friction;
}

/// Copies the responses of a node. \return false if its bodies differ and `to` has other tiles.
bool keepResponses(const Placed& from, const Placed& to, World& world) {
    const WorldBody& first = from.bodies.front();
    const bool alike =
        std::ranges::all_of(from.bodies, [&](const WorldBody& body) { return sameResponse(body, first); });
    for (std::size_t k = 0; (alike || from.boxes == to.boxes) && k < to.bodies.size(); ++k) {
        const WorldBody& body = alike ? first : from.bodies[k];
        world.bodies[to.first + k].restitution = body.restitution;
        world.bodies[to.first + k].friction = body.friction;
    }
    return alike || from.boxes == to.boxes;
}

using Nodes = std::vector<Placed*>;

/// Matches the nodes of one key if the match is unambiguous: one each, or several with equal responses.
/// \param exact  the key consists of name, box and pose; if equally many nodes match, they are paired in order.
void matchNodes(const Nodes& before, const Nodes& now, bool exact, World& world) {
    if (before.empty() || now.empty()) {
        return;
    }
    const bool pairs = before.size() == now.size() && (exact || now.size() == 1);
    const bool alike = before.size() > 1 && std::ranges::all_of(before, [&](const Placed* node) {
                           return std::ranges::all_of(node->bodies, [&](const WorldBody& body) {
                               return sameResponse(body, before.front()->bodies.front());
                           });
                       });
    for (std::size_t k = 0; pairs && k < now.size(); ++k) {
        if (!before[k]->matched && !now[k]->matched && keepResponses(*before[k], *now[k], world)) {
            before[k]->matched = now[k]->matched = true;
        }
    }
    for (Placed* to : alike && !pairs ? now : Nodes()) {
        to->matched = to->matched || keepResponses(*before.front(), *to, world);
    }
    for (Placed* from : before) {
        from->matched = from->matched || alike;
    }
}

/// \param read  `world` after a round trip through a reader, so that its poses compare with those of `before`.
void keepBodies(World& world, const World& read, const World& before, std::vector<std::string>& warnings) {
    std::vector<Placed> old = placedOf(before);
    std::vector<Placed> now = placedOf(read);
    struct Key {
        bool node, mesh, pose;
    };
    for (const Key key :
         {Key{true, true, true}, Key{true, true, false}, Key{false, true, true}, Key{true, false, false}}) {
        const auto of = [&](const Placed& placed) {
            return std::tuple(key.node ? placed.node : std::string(),
                              key.pose ? placed.pose : std::array<float, 8>(),
                              key.mesh ? placed.box() : std::array<float, 6>());
        };
        std::map<decltype(of(old[0])), std::pair<Nodes, Nodes>> nodes;
        for (Placed& placed : old) {
            nodes[of(placed)].first.push_back(&placed);
        }
        for (Placed& placed : now) {
            nodes[of(placed)].second.push_back(&placed);
        }
        for (const auto& [value, same] : nodes) {
            matchNodes(same.first, same.second, key.node && key.mesh && key.pose, world);
        }
    }
    std::vector<std::string> gone;
    for (const Placed& placed : old) {
        if (!placed.matched && !std::ranges::all_of(placed.bodies, [](const WorldBody& body) {
                return sameResponse(body, WorldBody());
            })) {
            gone.push_back(placed.node.empty() ? "(without a name)" : placed.node);
        }
    }
    if (!gone.empty()) {
        warnings.push_back(std::string(kWorldFileName) + ": the bodies of " + listedNames(gone) +
                           " are missing or ambiguous; their restitution and friction are dropped");
    }
}

std::vector<std::string> removeUnreferenced(const fs::path& folder, const std::vector<WorldFile>& before,
                                            const World& world) {
    std::set<std::string> referenced;
    for (const WorldFile& file : filesOf(world.colliders)) {
        referenced.insert(file.file);
    }
    std::vector<std::string> removed;
    for (const WorldFile& old : before) {
        const fs::path path = folder / old.file;
        std::error_code error;
        const bool own = old.file.ends_with(kColliderExtension) && !fs::path(old.file).has_parent_path() &&
                         !referenced.contains(old.file) && hashOfFile(path) == old.hash;
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
    } else if (fs::exists(path, error)) {
        replaced.warnings.push_back(before.error().message +
                                    "; it is replaced, and settings written by hand are lost");
    }
    // Never write a world that no reader accepts, such as one with scales or positions out of range of floats.
    const World read = RELIEF_TRY(withPrefix(name, parseWorld(worldText(world))));
    if (before) {
        keepBodies(world, read, *before, replaced.warnings);
    }
    RELIEF_TRY(writeText(path, worldText(world)));
    if (before) {
        replaced.removed = removeUnreferenced(folder, filesOf(before->colliders), world);
    }
    return replaced;
}

}  // namespace relief

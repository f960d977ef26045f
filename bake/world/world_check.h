// SPDX-License-Identifier: Apache-2.0
// A world measured against the level that it was baked from. Truth is the union of the level's meshes where its nodes place
// them, each by Embree in its own space: a point beside one body may be inside another.
#pragma once

#include <cstdint>
#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "bake/measure/part_accuracy.h"
#include "bake/pipeline/mesh_check.h"
#include "bake/world/world_places.h"
#include "formats/base/result.h"
#include "formats/container_limits.h"
#include "formats/world/world_field.h"

namespace relief {

struct WorldCheckRequest {
    CheckRequest check;  ///< of which `mesh` is the level; `samples` are shared by its bodies; no detail
    std::optional<float> within;  ///< world units; nullopt: as relief check measures one collider
    bool pictures = false;        ///< slices through the places
};

/// The points near the surface of one body.
struct BodyAccuracy {
    std::string node;
    std::string mesh;
    std::uint64_t points = 0;
    WrongShare wrong;
    std::size_t tiles =
        1;  ///< bodies of the world, in its order: several of a mesh in tiles; 0: the level has others
    glm::vec3 place{0.0F};  ///< world space: a typical point on the wrong side, or the body's position
};

/// Parts of a mesh of the level that its collider loses, each by its own size (measureParts()), wherever bodies stand.
struct LostParts {
    std::string mesh;
    std::uint64_t lost = 0;
    std::string text;  ///< lostPartsWarning()
};

struct WorldAccuracy {
    WrongShare all;                    ///< of the points of all bodies, as many of each
    std::vector<BodyAccuracy> bodies;  ///< in the order of the level
    std::vector<std::size_t> worst;    ///< bodies with points on the wrong side, at most ten, the worst first
    std::vector<WorldPlace> places;    ///< of those, in the same order
    std::vector<LostParts> lost;       ///< meshes that lose parts, in the order of the level
    std::size_t coarse = 0;            ///< other meshes with coarse parts
    IgnoredParts ignored;              ///< of all meshes; sizes in the world
    std::vector<std::string> warnings;
    std::vector<std::string> dependencies;  ///< files that the level's file refers to
    double seconds = 0.0;

    /// \param max_error  percent; nullopt: no limit.
    [[nodiscard]] bool passes(const std::optional<float>& max_error) const {
        return !max_error || (all.total() <= double{*max_error} && lost.empty());
    }
};

/// Errors: kLimit (samples), kInvalidInput (a mesh of the level that no collider was baked from), those of
/// importLevel, of the shapes and of Embree.
[[nodiscard]] Result<WorldAccuracy> checkWorld(const WorldCheckRequest& request, const WorldField& field);

}  // namespace relief

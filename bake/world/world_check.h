// SPDX-License-Identifier: Apache-2.0
// Measures a world against the level from which it was baked. Truth is the union of the level's meshes at the poses of
// its nodes, because a point near one body may be inside another. Embree queries each mesh in its own space.
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "bake/measure/part_accuracy.h"
#include "bake/pipeline/mesh_check.h"
#include "bake/world/world_places.h"
#include "formats/base/result.h"
#include "formats/world/world_field.h"

namespace relief {

struct WorldCheckRequest {
    /// `mesh` is the level; `samples` are distributed among its bodies; `min_part` is unused.
    CheckRequest check;
    /// Maximum distance of points from the surface, world units; nullopt: see AccuracyOptions.
    std::optional<float> within;
    bool pictures = false;  ///< adds slices through the worst places
};

/// The points near the surface of one body.
struct BodyAccuracy {
    std::string node;
    std::string mesh;
    std::uint64_t points = 0;
    WrongPercent wrong;
    std::size_t tiles = 1;     ///< bodies for `node`, one per tile; 0: level and world node counts differ
    glm::vec3 position{0.0F};  ///< world space: a typical misclassified point, or the position of the body
};

/// Parts of one mesh of the level that are missing from its collider, judged relative to their own size
/// (measureParts()), regardless of poses.
struct LostParts {
    std::string mesh;
    std::uint64_t lost = 0;
    std::string text;  ///< lostPartsWarning()
};

struct WorldAccuracy {
    WrongPercent all;                  ///< of all points; each body has the same number of points
    std::vector<BodyAccuracy> bodies;  ///< in the order of the level
    std::vector<std::size_t> worst;    ///< bodies with misclassified points, worst first, at most ten
    std::vector<WorldPlace> places;    ///< of `worst`, in the same order
    std::vector<LostParts> lost;       ///< meshes that lose parts, in the order of the level
    std::size_t coarse = 0;            ///< other meshes with kCoarse parts that lower the grade
    IgnoredParts ignored;              ///< of all meshes; sizes in world space
    std::vector<std::string> warnings;
    std::vector<std::string> dependencies;  ///< files that the level references
    double seconds = 0.0;

    /// \param max_error  percent; nullopt: no limit.
    [[nodiscard]] bool passes(const std::optional<float>& max_error) const {
        return !max_error || (all.total() <= double{*max_error} && lost.empty());
    }
};

/// Measures a world.
/// Errors: kLimit (samples), kInvalidInput (a mesh of the level has no collider), those of importLevel, makeSolid and
/// MeshQuery::build.
[[nodiscard]] Result<WorldAccuracy> checkWorld(const WorldCheckRequest& request, const WorldField& field);

}  // namespace relief

// SPDX-License-Identifier: Apache-2.0
// Measures baked ground against its height map, which may be of any size: the map is read twice, row by row, and only
// squares that contain a point are evaluated. Truth is the bilinear surface between the samples, in closed form.
//
//        y  |        . outside      points near the surface: side, and distance to the
//           |    .  /  \            collider's surface along y
//           |\_____/ .  \___        points anywhere: side, also beyond the edges and at holes;
//           |  . inside     |       over ground, only points above its floor
//        ---+---------------+-- x
#pragma once

#include <cstdint>
#include <filesystem>
#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "bake/ground/ground_samples.h"
#include "bake/height_map/heights_spec.h"
#include "bake/import/import_job.h"
#include "bake/measure/accuracy.h"
#include "formats/base/result.h"
#include "formats/world/world_field.h"

namespace relief {

inline constexpr std::uint64_t kGroundSamplesMax = 10'000'000;

struct GroundCheckRequest {
    std::filesystem::path map;
    HeightsSpec heights;
    /// Number of points of each kind: near the surface, near seams, anywhere.
    std::uint64_t samples = 200'000;
    std::uint64_t seed = 1;
    /// Maximum distance of points near the surface, along y, in metres; nullopt: the sample spacing.
    std::optional<double> within;
    ImportLimits limits{};  ///< for an image
    std::function<void(double)>
        progress{};  ///< called occasionally with the completed fraction; may be empty
};

struct GroundWorstPlace {
    glm::vec3 position{0.0F};  ///< on the surface of the height map, world space
    /// The body at that position; empty for a single collider, or if there is none.
    std::string node;
    std::optional<double> error;  ///< along y, metres; nullopt: no surface within range
    double rise = 0.0;            ///< height range of the square, relative to its side
};

struct GroundAccuracy {
    std::string height_map;  ///< file name, without the folder
    std::string hash;
    std::uint32_t columns = 0;
    std::uint32_t rows = 0;
    std::uint64_t squares = 0;  ///< with ground
    std::uint64_t steep = 0;    ///< steeper than kSteepest
    std::uint64_t holes = 0;    ///< squares without ground
    double within = 0.0;
    GroundNear near;
    std::optional<GroundNear> seams;  ///< at most a leaf's side from a seam of tiles; nullopt: no seams
    std::uint64_t uniform_points = 0;
    WrongPercent uniform;                 ///< also at holes and beyond the edges
    std::vector<GroundWorstPlace> worst;  ///< ten places at least four leaves apart, worst first
    std::vector<std::string> warnings;    ///< one line each
    double seconds = 0.0;
};

/// Returns the settings that ground was baked with. \param name  of the file, for messages.
/// Errors: kUsage (a collider was not baked from a height map, or its settings differ from those of another).
[[nodiscard]] Result<HeightsSpec> recordedHeights(const WorldField& field, const std::string& name);

/// Measures ground. The result does not depend on the number of threads.
/// \param field  of tiles, or of one collider as the only body; bodies must not be rotated or scaled.
/// \param name   of its file, for messages.
/// Errors: those of HeightMap; kLimit (samples); kInvalidInput (no ground in the map, ground of another size or place,
/// or a rotated or scaled body).
[[nodiscard]] Result<GroundAccuracy> checkGround(const GroundCheckRequest& request, const WorldField& field,
                                                 const std::string& name);

}  // namespace relief

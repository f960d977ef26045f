// SPDX-License-Identifier: Apache-2.0
// Baked ground measured against its height map, whatever its size: the map is read twice, row by row, and of each row only the
// squares with a point are looked at. Truth is the bilinear surface between the samples, in closed form.
//
//        y  |        . outside      of each point near the surface: its side, and along y
//           |    .  /  \            how far off the collider's surface is
//           |\_____/ .  \___        anywhere: its side, down to what the ground must be solid to,
//           |  . inside     |       beyond the edges and above holes as well
//        ---+---------------+-- x
#pragma once

#include <cstdint>
#include <filesystem>
#include <functional>
#include <optional>
#include <string>
#include <vector>

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
    std::uint64_t samples = 200'000;  ///< points of each kind
    std::uint64_t seed = 1;
    /// How far from the surface points near it lie, along y, in metres; nullopt: the distance between samples.
    std::optional<double> within;
    ImportLimits limits{};  ///< of an image
    std::function<void(double)>
        progress{};  ///< called now and then with the share of the work done; may be empty
};

/// Points near the surface. Distances are those along y, in metres, from the height map's surface to the collider's.
struct GroundNear {
    std::uint64_t points = 0;
    WrongShare wrong;
    double mean = 0.0;  ///< upwards is positive
    double mean_abs = 0.0;
    double p99 = 0.0;  ///< 99 % of the points are nearer
    double most = 0.0;
    std::uint64_t missing = 0;  ///< points without a surface so near; distances leave them out
};

struct GroundWorstPlace {
    glm::vec3 place{0.0F};        ///< on the surface of the height map, world space
    std::string node;             ///< the body there; empty of a single collider, and where there is none
    std::optional<double> error;  ///< along y, metres; nullopt: no surface within reach
    double rise = 0.0;            ///< of the square there, in its sides
};

struct GroundAccuracy {
    std::string map;  ///< its name, without the folder
    std::string hash;
    std::uint32_t columns = 0;
    std::uint32_t rows = 0;
    std::uint64_t squares = 0;  ///< with ground
    std::uint64_t steep = 0;    ///< of those, steeper than kSteepest
    std::uint64_t holes = 0;    ///< squares without
    double within = 0.0;
    GroundNear near;
    std::optional<GroundNear> seams;  ///< within a leaf of a seam between tiles; nullopt: there is none
    std::uint64_t anywhere_points = 0;
    WrongShare anywhere;                  ///< holes and the sides included
    std::vector<GroundWorstPlace> worst;  ///< ten places at least four leaves apart, the worst first
    std::vector<std::string> warnings;    ///< one line each
    double seconds = 0.0;
};

/// The settings that ground was baked with. \param name  of the file, for messages.
/// Errors: kUsage: not all of it was baked from height maps, or by several settings.
[[nodiscard]] Result<HeightsSpec> recordedHeights(const WorldField& field, const std::string& name);

/// \param field  of tiles, or of one collider as the only body; neither turned nor scaled.
/// \param name   of its file, for messages.
/// The same for any number of threads.
/// Errors: those of HeightMap; kLimit (samples); kInvalidInput: no ground in the map, ground of another size or place, or a
/// body that is turned or scaled.
[[nodiscard]] Result<GroundAccuracy> checkGround(const GroundCheckRequest& request, const WorldField& field,
                                                 const std::string& name);

}  // namespace relief

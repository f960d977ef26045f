// Particle states as points of OpenVDB.
#pragma once

#include <cstddef>
#include <span>
#include <vector>

#include "formats/base/result.h"
#include "runtime/particles/particle_system.h"

namespace relief {

/// An OpenVDB file with one grid of points, "particles", in object units. Its attributes have the names of Houdini: P, v
/// (units a second), age and life (seconds) as floats, id (births before its own) and type as 32-bit integers. Positions
/// keep single precision of their place in a voxel; some eight points share one. The grid's metadata "points" counts
/// them. The same for any order of `particles` and any number of threads.
/// Errors: kUnsupported (a build without OpenVDB), kFailure.
[[nodiscard]] Result<std::vector<std::byte>> encodeVdbPoints(std::span<const ParticleState> particles);

/// Whether this build has OpenVDB. Fails with kUnsupported, and says what to build.
[[nodiscard]] Result<void> checkVdb();

}  // namespace relief

// SPDX-License-Identifier: Apache-2.0
// Writes OpenVDB files. OpenVDB is in a separate module, relief-vdb.so, which is loaded on demand, because its
// dependencies start threads in any program that loads them.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <glm/vec3.hpp>
#include <span>
#include <vector>

#include "formats/base/result.h"

namespace relief {

struct VdbPoint {
    std::uint32_t id = 0;  ///< number of earlier births
    glm::vec3 position{0.0F};
    glm::vec3 velocity{0.0F};  ///< units/s
    float age = 0.0F;          ///< seconds
    float lifetime = 0.0F;     ///< seconds
    std::uint32_t type = 0;
};

/// Signed distances near a surface, on a grid. The centre of voxel (i, j, k) is at voxel × (i, j, k).
struct NarrowBand {
    double voxel = 1.0;           ///< object units
    float background = 0.0F;      ///< half of the band's width; absolute distances are smaller
    std::vector<glm::ivec3> at;   ///< voxels
    std::vector<float> distance;  ///< one per voxel; negative inside
};

/// A mesh whose faces are anticlockwise when seen from outside.
struct GridSurface {
    std::vector<glm::vec3> points;
    std::vector<std::array<std::uint32_t, 3>> triangles;
    std::vector<std::array<std::uint32_t, 4>> quads;
};

class VdbWriter {
  public:
    virtual ~VdbWriter() = default;
    // Equal arguments give equal bytes. Errors: kFailure (of OpenVDB; out of memory).
    /// \param particles  ordered by id, with finite positions.
    [[nodiscard]] virtual Result<std::vector<std::byte>> points(std::span<const VdbPoint> particles) = 0;
    [[nodiscard]] virtual Result<std::vector<std::byte>> levelSet(const NarrowBand& band) = 0;
    [[nodiscard]] virtual Result<GridSurface> surface(const NarrowBand& band) = 0;
};

/// Encodes particles as an OpenVDB file with one point grid, "particles", in object units. The attributes are named as
/// in Houdini: P, v (units/s), age and life (seconds) as floats, id (number of earlier births) and type as 32-bit
/// integers. Positions are stored in single precision relative to their voxel, which holds about eight points. The grid
/// metadata "points" is the number of points. The result does not depend on the order of `particles` or the number of
/// threads.
/// Errors: kUnsupported (a build without OpenVDB), kFailure.
[[nodiscard]] Result<std::vector<std::byte>> encodeVdbPoints(std::span<const VdbPoint> particles);

/// Fails with kUnsupported if this build has no OpenVDB.
[[nodiscard]] Result<void> checkVdb();

/// Loads the module once, from the folder of the program or from ../lib/relief.
/// Errors: kUnsupported (the module or one of its dependencies is missing).
[[nodiscard]] Result<VdbWriter*> vdbWriter();

}  // namespace relief

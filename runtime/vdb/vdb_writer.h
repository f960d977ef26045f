// SPDX-License-Identifier: Apache-2.0
// The writer of OpenVDB files. It lies in a module of its own, relief-vdb.so, which is loaded when it is needed: the library
// brings others along that start threads in whatever program loads them.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <glm/vec3.hpp>
#include <span>
#include <vector>

#include "formats/base/result.h"

namespace relief {

/// A particle.
struct VdbPoint {
    std::uint32_t id = 0;  ///< births before its own
    glm::vec3 position{0.0F};
    glm::vec3 velocity{0.0F};  ///< units a second
    float age = 0.0F;          ///< seconds
    float lifetime = 0.0F;     ///< seconds
    std::uint32_t type = 0;
};

/// Signed distances near a surface, on a grid whose voxel (i, j, k) has its centre at voxel × (i, j, k).
struct NarrowBand {
    double voxel = 1.0;       ///< object units
    float background = 0.0F;  ///< half of the band's width; distances are less
    std::vector<glm::ivec3> at;
    std::vector<float> distance;  ///< as many; negative inside
};

/// Faces anticlockwise seen from outside.
struct GridSurface {
    std::vector<glm::vec3> points;
    std::vector<std::array<std::uint32_t, 3>> triangles;
    std::vector<std::array<std::uint32_t, 4>> quads;
};

class VdbWriter {
  public:
    virtual ~VdbWriter() = default;
    // Equal arguments give equal bytes. Errors: kFailure (OpenVDB's, memory).
    /// \param particles  ordered by id, at finite positions.
    [[nodiscard]] virtual Result<std::vector<std::byte>> points(std::span<const VdbPoint> particles) = 0;
    [[nodiscard]] virtual Result<std::vector<std::byte>> levelSet(const NarrowBand& band) = 0;
    [[nodiscard]] virtual Result<GridSurface> surface(const NarrowBand& band) = 0;
};

/// An OpenVDB file with one grid of points, "particles", in object units. Its attributes have the names of Houdini: P, v
/// (units a second), age and life (seconds) as floats, id (births before its own) and type as 32-bit integers. Positions
/// keep single precision of their place in a voxel; some eight points share one. The grid's metadata "points" counts
/// them. The same for any order of `particles` and any number of threads.
/// Errors: kUnsupported (a build without OpenVDB), kFailure.
[[nodiscard]] Result<std::vector<std::byte>> encodeVdbPoints(std::span<const VdbPoint> particles);

/// Fails with kUnsupported where this build has no OpenVDB, with the cure.
[[nodiscard]] Result<void> checkVdb();

/// Loads the module, once. It lies beside the program, or in ../lib/relief.
/// Errors: kUnsupported: there is none, or what it needs is missing.
[[nodiscard]] Result<VdbWriter*> vdbWriter();

}  // namespace relief

// SPDX-License-Identifier: Apache-2.0
// Which colliders of a world are wanted on the GPU, from the places that matter. Plain arithmetic, no GL.
#pragma once

#include <cstddef>
#include <cstdint>
#include <glm/vec3.hpp>
#include <limits>
#include <span>
#include <vector>

#include "formats/collider.h"
#include "formats/world/pose.h"

namespace relief {

/// A camera, an emitter, a place where particles are: colliders that reach into its ball are wanted.
struct PointOfInterest {
    glm::vec3 position{0.0F};  ///< world units
    float radius = 0.0F;       ///< world units, > 0
    friend bool operator==(const PointOfInterest&, const PointOfInterest&) = default;
};

/// A body that is placed from a collider that comes and goes.
struct StreamBody {
    std::uint32_t collider = 0;
    Bounds box;  ///< of its collider, object space
    Pose pose;
};

class StreamPlan {
  public:
    StreamPlan(std::vector<StreamBody> bodies, std::size_t colliders);

    void setPose(std::size_t body, const Pose& pose) { bodies_[body].pose = pose; }

    /// Measures the distances of some of the bodies. After the last of them wanted() is new, and the next call begins again with the
    /// first, from the points as they are then.
    /// \param pairs  of a body and a point that one call may measure, about.
    /// \return whether wanted() is new.
    bool look(std::span<const PointOfInterest> points, std::size_t pairs);
    /// All bodies at once, from these points.
    void lookAtAll(std::span<const PointOfInterest> points);

    /// Colliders in the order in which they are wanted: by the distance to the nearest of their bodies, in radii of the point.
    [[nodiscard]] std::span<const std::uint32_t> wanted() const { return wanted_; }
    /// That distance of a wanted one, until the next look().
    [[nodiscard]] float nearest(std::uint32_t collider) const { return nearest_[collider]; }

  private:
    void begin(std::span<const PointOfInterest> points);
    bool advance(std::size_t pairs);

    std::vector<StreamBody> bodies_;
    std::vector<PointOfInterest> points_;
    std::size_t next_ = 0;
    std::vector<float> nearest_;  // of each collider so far, in radii
    std::vector<std::uint32_t> wanted_;
};

}  // namespace relief

// SPDX-License-Identifier: Apache-2.0
// Determines which colliders of a world are needed on the GPU, from points of interest. Independent of GL.
#pragma once

#include <cstddef>
#include <cstdint>
#include <glm/vec3.hpp>
#include <span>
#include <vector>

#include "formats/collider.h"
#include "formats/world/pose.h"

namespace relief {

/// A camera, an emitter, or a location of particles. Colliders that intersect its ball are needed.
struct PointOfInterest {
    glm::vec3 position{0.0F};  ///< world units
    float radius = 0.0F;       ///< world units, > 0
    friend bool operator==(const PointOfInterest&, const PointOfInterest&) = default;
};

/// A body whose collider is streamed.
struct StreamBody {
    std::uint32_t collider = 0;
    Bounds box;  ///< of its collider, object space
    Pose pose;
};

class StreamPlan {
  public:
    StreamPlan(std::vector<StreamBody> bodies, std::size_t colliders);

    void setPose(std::size_t body, const Pose& pose) { bodies_[body].pose = pose; }

    /// Measures the distances of some of the bodies. Once all are measured, wanted() is updated, and the next call
    /// starts over with the points passed to it.
    /// \param pairs  approximate number of body-point pairs to measure in this call.
    /// \return whether wanted() was updated.
    bool measureSome(std::span<const PointOfInterest> points, std::size_t pairs);
    /// Measures all bodies at once.
    void measureAll(std::span<const PointOfInterest> points);

    /// Returns the colliders in order of priority: by the distance of their nearest body, in radii of the point of
    /// interest.
    [[nodiscard]] std::span<const std::uint32_t> wanted() const { return wanted_; }
    /// Returns the distance that orders a wanted collider; valid until the next measureSome().
    [[nodiscard]] float nearest(std::uint32_t collider) const { return nearest_[collider]; }

  private:
    void begin(std::span<const PointOfInterest> points);
    bool advance(std::size_t pairs);

    std::vector<StreamBody> bodies_;
    std::vector<PointOfInterest> points_;
    std::size_t next_ = 0;
    std::vector<float> nearest_;  // for each collider: smallest distance measured so far, in radii
    std::vector<std::uint32_t> wanted_;
};

}  // namespace relief

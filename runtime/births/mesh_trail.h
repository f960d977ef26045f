// SPDX-License-Identifier: Apache-2.0
// The last two poses of a deforming mesh; births on its surface are interpolated between them.
#pragma once

#include <functional>
#include <glm/vec3.hpp>
#include <optional>
#include <vector>

#include "runtime/particles/emitter.h"

namespace relief {

class MeshTrail {
  public:
    /// Returns the vertices. Called at most once, when a birth needs them.
    using Vertices = std::function<std::vector<glm::vec3>()>;

    /// Records the current pose.
    /// \param time      seconds. \param vertices  at that time, object space.
    /// \param jumps     do not interpolate from the previous pose; also assumed if the time does not increase.
    void show(double time, Vertices vertices, bool jumps);

    [[nodiscard]] bool empty() const { return !now_; }

    /// Records that the mesh has not moved since the last pose.
    void hold() { before_.reset(); }

    /// Moves an emitter's surface, which must have the same vertices, to the current pose. Call show() first.
    /// \param seconds  duration between the two poses; nullopt: the difference of their times.
    void bend(Emitter& emitter, std::optional<double> seconds = std::nullopt);

  private:
    struct Moment {
        double time = 0.0;
        Vertices make;
        std::vector<glm::vec3> made = {};  // empty until needed

        const std::vector<glm::vec3>& vertices();
    };
    std::optional<Moment> before_;  // nullopt after a jump or hold()
    std::optional<Moment> now_;
};

}  // namespace relief

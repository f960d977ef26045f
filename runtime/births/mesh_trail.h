// SPDX-License-Identifier: Apache-2.0
// A mesh that bends, at the last two moments that were shown: between these fall the births on its surface.
#pragma once

#include <functional>
#include <glm/vec3.hpp>
#include <optional>
#include <vector>

#include "runtime/particles/emitter.h"

namespace relief {

class MeshTrail {
  public:
    /// Called once at most, when something is to be born.
    using Vertices = std::function<std::vector<glm::vec3>()>;

    /// \param time   seconds. \param vertices  as they are then, object space.
    /// \param jumps  from the moment before; as where the time does not rise.
    void show(double time, Vertices vertices, bool jumps);

    [[nodiscard]] bool empty() const { return !now_; }

    /// It has not moved since the last moment.
    void hold() { before_.reset(); }

    /// Moves the surface of an emitter, of the same vertices, to where it is; once show() has been called.
    /// \param seconds  between the two moments, instead of the difference of their times.
    void bend(Emitter& emitter, std::optional<double> seconds = std::nullopt);

  private:
    struct Moment {
        double time = 0.0;
        Vertices make;
        std::vector<glm::vec3> made = {};  // empty: not yet

        const std::vector<glm::vec3>& vertices();
    };
    std::optional<Moment> before_;  // nullopt: it jumped
    std::optional<Moment> now_;
};

}  // namespace relief

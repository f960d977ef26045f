// SPDX-License-Identifier: Apache-2.0
#include "runtime/births/mesh_trail.h"

#include <utility>

namespace relief {

const std::vector<glm::vec3>& MeshTrail::Moment::vertices() {
    if (made.empty()) {
        made = make();
    }
    return made;
}

void MeshTrail::show(double time, Vertices vertices, bool jumps) {
    before_.reset();
    if (now_ && !jumps && now_->time < time) {
        before_ = std::move(now_);
    }
    now_ = Moment{time, std::move(vertices)};
}

void MeshTrail::bend(Emitter& emitter, std::optional<double> seconds) {
    Moment& before = before_ ? *before_ : *now_;
    const double passed = before_ ? seconds.value_or(now_->time - before.time) : 0.0;
    emitter.moveSurface(before.vertices(), now_->vertices(), passed);
}

}  // namespace relief

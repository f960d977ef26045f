// SPDX-License-Identifier: Apache-2.0
#include "bake/mesh/prepared_mesh.h"

#include <algorithm>
#include <utility>

#include "bake/mesh/embree_mesh.h"

namespace relief {

void PreparedMesh::State::computeFromEdges() {
    const MeshEdges own = edges ? MeshEdges{} : edgesOf(mesh);
    const MeshEdges& from = edges ? *edges : own;
    odd_edges = relief::oddEdges(from);
    several_shells = odd_edges->empty() && hasSeveralShells(from);
}

PreparedMesh::PreparedMesh(TriangleMesh mesh) : state_(std::make_shared<State>()) {
    state_->mesh = std::move(mesh);
}

const MeshEdges& PreparedMesh::edges() const {
    return state_->edges ? *state_->edges : state_->edges.emplace(edgesOf(state_->mesh));
}

void PreparedMesh::freeEdges() const {
    if (state_->edges) {
        state_->computeFromEdges();
        state_->edges.reset();
    }
}

const std::vector<OddEdge>& PreparedMesh::oddEdges() const {
    if (!state_->odd_edges) {
        state_->computeFromEdges();
    }
    return *state_->odd_edges;
}

bool PreparedMesh::woundShells() const {
    if (!state_->bodies.empty()) {
        return std::ranges::all_of(state_->bodies, [](std::uint32_t body) { return body == 0; });
    }
    if (!closed() || !state_->wound_outwards) {
        return false;
    }
    if (!state_->several_shells) {
        state_->computeFromEdges();
    }
    return *state_->several_shells;
}

double PreparedMesh::orientation() const {
    if (state_->orientation) {
        return *state_->orientation;
    }
    const TriangleMesh& mesh = state_->mesh;
    const glm::dvec3 center = mesh.bounds.center();
    glm::dvec3 area_vector(0.0);
    double area = 0.0;
    double volume = 0.0;
    for (std::uint32_t i = 0; i < mesh.triangles.size(); ++i) {
        const TrianglePlane plane = planeOf(mesh, i);
        area_vector += plane.normal;
        area += length(plane.normal);
        volume += dot(plane.point - center, plane.normal);
    }
    const bool closed = length(area_vector) <= 1e-5 * area;
    state_->orientation = closed && volume < 0.0 ? -1.0 : 1.0;
    return *state_->orientation;
}

const AreaTable& PreparedMesh::areas() const {
    return state_->areas ? *state_->areas : state_->areas.emplace(state_->mesh);
}

Result<const EmbreeMesh*> PreparedMesh::tree() const {
    if (!state_->tree) {
        state_->tree = std::make_shared<EmbreeMesh>(RELIEF_TRY(EmbreeMesh::build(state_->mesh)));
    }
    return state_->tree.get();
}

PreparedMesh PreparedMesh::woundOutwards(const std::vector<bool>& turn) && {
    PreparedMesh wound = state_.use_count() == 1 ? std::move(*this) : PreparedMesh(TriangleMesh(**this));
    State& state = *wound.state_;
    state.wound_outwards = true;
    if (std::ranges::find(turn, true) == turn.end()) {
        return wound;
    }
    for (std::size_t i = 0; i < turn.size(); ++i) {
        if (turn[i]) {
            std::swap(state.mesh.triangles[i].y, state.mesh.triangles[i].z);
        }
    }
    state.turned = turn;
    state.edges.reset();
    // The direction of odd edges depends on the winding; their absence does not.
    if (state.odd_edges && !state.odd_edges->empty()) {
        state.odd_edges.reset();
    }
    state.several_shells.reset();
    state.orientation.reset();
    state.tree.reset();
    return wound;
}

PreparedMesh PreparedMesh::unionOf(TriangleMesh mesh, std::vector<std::uint32_t> bodies) {
    PreparedMesh whole(std::move(mesh));
    whole.state_->wound_outwards = true;
    whole.state_->orientation = 1.0;
    whole.state_->bodies = std::move(bodies);
    return whole;
}

PreparedMesh PreparedMesh::withVoids(Voids voids) && {
    state_->voids = std::move(voids);
    return std::move(*this);
}

PreparedMesh PreparedMesh::capped(TriangleMesh mesh) const {
    PreparedMesh with_caps(std::move(mesh));
    with_caps.state_->wound_outwards = state_->wound_outwards;
    return with_caps;
}

}  // namespace relief

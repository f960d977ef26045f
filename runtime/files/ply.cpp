// SPDX-License-Identifier: Apache-2.0
#include "runtime/files/ply.h"

#include <algorithm>
#include <string>

#include "formats/polygons/ply_bytes.h"

namespace relief {
namespace {

constexpr std::size_t kVertexSize = 40;

}  // namespace

std::vector<std::byte> encodePly(std::span<const ParticleState> particles) {
    std::string header =
        "ply\n"
        "format binary_little_endian 1.0\n"
        "comment particles of relief-sim; object units, seconds\n"
        "element vertex " +
        std::to_string(particles.size()) + "\n";
    for (const char* name : {"x", "y", "z", "vx", "vy", "vz", "age", "lifetime"}) {
        header += std::string("property float ") + name + "\n";
    }
    header += "property uint id\nproperty uint type\nend_header\n";

    std::vector<const ParticleState*> ordered;
    ordered.reserve(particles.size());
    for (const ParticleState& particle : particles) {
        ordered.push_back(&particle);
    }
    std::sort(ordered.begin(), ordered.end(),
              [](const ParticleState* a, const ParticleState* b) { return a->id < b->id; });

    PlyBytes out;
    out.reserve(header.size() + kVertexSize * particles.size());
    out.text(header);
    for (const ParticleState* p : ordered) {
        for (const float value : {p->position.x, p->position.y, p->position.z, p->velocity.x, p->velocity.y,
                                  p->velocity.z, p->age, p->lifetime}) {
            out.number(value);
        }
        out.word(p->id);
        out.word(p->type);
    }
    return out.take();
}

}  // namespace relief

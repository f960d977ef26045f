#include "runtime/files/ply.h"

#include <algorithm>
#include <cstdint>
#include <string>

#include "formats/base/bits.h"

namespace relief {
namespace {

constexpr std::size_t kVertexSize = 40;

void append(std::vector<std::byte>& out, std::uint32_t word) {
    for (int shift = 0; shift < 32; shift += 8) {
        out.push_back(static_cast<std::byte>(word >> shift & 0xffU));
    }
}

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

    std::vector<std::byte> out;
    out.reserve(header.size() + kVertexSize * particles.size());
    for (const char c : header) {
        out.push_back(static_cast<std::byte>(c));
    }
    for (const ParticleState* p : ordered) {
        for (const float value : {p->position.x, p->position.y, p->position.z, p->velocity.x, p->velocity.y,
                                  p->velocity.z, p->age, p->lifetime}) {
            append(out, bitCast<std::uint32_t>(value));
        }
        append(out, p->id);
        append(out, p->type);
    }
    return out;
}

}  // namespace relief

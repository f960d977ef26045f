#include "runtime/vdb/vdb_points.h"

#include <algorithm>
#include <cmath>
#include <string>

#include "runtime/vdb/vdb_writer.h"

namespace relief {

Result<void> checkVdb() {
    const auto writer = vdbWriter();
    return writer ? Result<void>() : forward(writer);
}

Result<std::vector<std::byte>> encodeVdbPoints(std::span<const ParticleState> particles) {
    VdbWriter* const writer = RELIEF_TRY(vdbWriter());
    for (const ParticleState& p : particles) {
        if (!std::isfinite(p.position.x) || !std::isfinite(p.position.y) || !std::isfinite(p.position.z)) {
            return fail(ErrorCode::kFailure,
                        "particle " + std::to_string(p.id) +
                            " is nowhere: its position is not finite; OpenVDB has no place for it");
        }
    }
    std::vector<ParticleState> ordered(particles.begin(), particles.end());
    std::sort(ordered.begin(), ordered.end(),
              [](const ParticleState& a, const ParticleState& b) { return a.id < b.id; });
    return writer->points(ordered);
}

}  // namespace relief

// SPDX-License-Identifier: Apache-2.0
#include "bake/measure/self_check.h"

#include <cstdint>

#include "bake/measure/truth.h"
#include "bake/mesh/mesh_query.h"

namespace relief {
namespace {

/// Enough to measure a fraction of 1 % with a relative error of one sixth.
constexpr std::uint32_t kPoints = 4000;

}  // namespace

Result<SelfCheck> selfCheck(const PreparedMesh& mesh, const SurfaceParts& parts, const Collider& collider,
                            double scale) {
    const MeshQuery query = RELIEF_TRY(MeshQuery::build(mesh));
    const Field field = fieldOf(collider);
    SelfCheck check{measureNear(sampleNear(query, {.samples = kPoints}), field), {}};
    if (parts.parts.size() > 1) {
        // Few points detect a lost part, because at least a quarter of them are wrong.
        check.parts = measureParts(query, parts, field,
                                   {.points = 64,
                                    .points_min = 16,
                                    .points_all = 16'384,
                                    .parts_max = 1024,
                                    .min_part = {},
                                    .scale = scale});
    }
    return check;
}

}  // namespace relief

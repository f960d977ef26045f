// SPDX-License-Identifier: Apache-2.0
#include "bake/measure/self_check.h"

#include <cstdint>

#include "bake/measure/truth.h"
#include "bake/mesh/mesh_query.h"

namespace relief {
namespace {

/// Enough to measure a fraction of 1 % with a relative error of one sixth.
constexpr std::uint32_t kPoints = 4000;
/// Few points detect a lost part, because at least a quarter of them are wrong.
const PartOptions kParts{
    .points = 64, .points_min = 16, .points_all = 16'384, .parts_max = 1024, .min_part = {}};

}  // namespace

Result<SelfCheck> selfCheck(const PreparedMesh& mesh, const SurfaceParts& parts, const Collider& collider,
                            double scale) {
    const MeshQuery query = RELIEF_TRY(MeshQuery::build(mesh));
    AccuracyOptions options;
    options.samples = kPoints;
    const Field field = fieldOf(collider);
    SelfCheck check{measureNear(sampleNear(query, options), field), {}};
    if (parts.parts.size() > 1) {
        PartOptions by_parts = kParts;
        by_parts.scale = scale;
        check.parts = measureParts(query, parts, field, by_parts);
    }
    return check;
}

}  // namespace relief

// SPDX-License-Identifier: Apache-2.0
// Meshes wound and shaped as in a bake.
#pragma once

#include "bake/repair/winding.h"
#include "bake/shape/shape.h"
#include "tests/bake/meshes.h"

namespace relief::test {

[[nodiscard]] inline ShapedMesh shapedBy(TriangleMesh mesh, const ShapeOptions& options) {
    return required(shapeMesh(required(windOutwards(std::move(mesh))).mesh, options));
}

inline void expectKinds(const ShapeReport& report, std::uint64_t solids, std::uint64_t holed,
                        std::uint64_t sheets, std::uint64_t terrains) {
    EXPECT_EQ(report.solids, solids);
    EXPECT_EQ(report.solids_with_holes, holed);
    EXPECT_EQ(report.sheets, sheets);
    EXPECT_EQ(report.terrains, terrains);
}

}  // namespace relief::test

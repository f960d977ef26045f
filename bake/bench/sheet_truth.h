// SPDX-License-Identifier: Apache-2.0
// The truth about shells, independent of the shells made by bake/shape: a point is inside if it is within half the
// thickness of the imported surface. Only the sheets and their thickness come from bake/shape (ShapedMesh::parts).
#pragma once

#include <glm/vec3.hpp>
#include <optional>
#include <vector>

#include "bake/measure/truth.h"
#include "bake/mesh/mesh_query.h"
#include "bake/shape/shape.h"
#include "formats/base/result.h"

namespace relief {

class SheetTruth {
  public:
    /// Builds the truth. The result is empty() if the mesh has no sheets, has named parts, or lost duplicate parts
    /// (Shaper::runWithout).
    /// \param source  as imported, after windOutwards.
    /// Errors: those of finishMesh and MeshQuery::build.
    [[nodiscard]] static Result<SheetTruth> build(const PreparedMesh& source, const ShapedMesh& shaped);

    [[nodiscard]] bool empty() const { return sheets_.empty(); }

    /// Returns nullopt if the result depends on the ends and mitres of a shell: the nearest point is on an edge and
    /// within the thickness.
    [[nodiscard]] std::optional<bool> inside(const glm::vec3& p) const;

    /// Draws area-weighted points of the sheets, and moves each along the normal by at most the thickness.
    /// TruthPoint::distance is ±1, for the side. Omits points for which inside() is nullopt, and points that are outside
    /// all sheets but inside the solid, if the solid has other parts or voids. The result does not
    /// depend on the number of threads.
    /// \param solid  query of the shaped mesh.
    [[nodiscard]] std::vector<TruthPoint> sample(const MeshQuery& solid,
                                                 const AccuracyOptions& options) const;

  private:
    struct Sheet {
        MeshQuery query;
        double thickness;
        double area;  ///< cumulative, including all previous sheets
    };
    std::vector<Sheet> sheets_;
    bool others_ = false;  ///< the solid has parts other than sheets, or voids
};

}  // namespace relief

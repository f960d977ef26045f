// SPDX-License-Identifier: Apache-2.0
// The truth about shells without the shells that bake/shape makes: a point is inside within half the thickness of the surface
// as it came. Only which parts are sheets, and how thick, is that of the shape's report.
#pragma once

#include <cstdint>
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
    /// Without sheets if the mesh has none, has named parts, or lost copies of parts (Shaper::runWithout).
    /// \param source  as it came, after windOutwards.
    /// Errors: those of finishMesh and MeshQuery::build.
    [[nodiscard]] static Result<SheetTruth> build(const PreparedMesh& source, const ShapedMesh& shaped);

    [[nodiscard]] bool empty() const { return sheets_.empty(); }

    /// nullopt if it depends on the ends and mitres of a shell: the nearest point is at an edge, and within the thickness.
    [[nodiscard]] std::optional<bool> inside(const glm::vec3& p) const;

    /// At normal offsets up to a thickness from area-weighted points of the sheets, with ±1 for distances. Points outside of all
    /// sheets that the solid calls inside are left out if it has other parts than sheets, or voids. The same for any number of
    /// threads.
    /// \param solid  of the shaped mesh.
    [[nodiscard]] std::vector<TruthPoint> sample(const MeshQuery& solid,
                                                 const AccuracyOptions& options) const;

  private:
    struct Sheet {
        MeshQuery query;
        double thickness;
        double area;  ///< of it and all before
    };
    std::vector<Sheet> sheets_;
    bool others_ = false;  ///< than sheets
};

}  // namespace relief

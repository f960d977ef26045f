// SPDX-License-Identifier: Apache-2.0
// Closes parts with holes, and distinguishes bodies cut off at the foot, such as a statue, from vessels.
#pragma once

#include <optional>

#include "bake/mesh/prepared_mesh.h"
#include "formats/base/result.h"

namespace relief {

/// A part with holes, after closing.
struct ClosedPart {
    std::optional<PreparedMesh> mesh;
    bool balanced = true;
    bool is_body = true;  ///< cut off at its foot; not a vessel
};

/// Closes a part. Returns no mesh if the holes cannot be closed, or if the result encloses nothing.
/// \param is_body  already known to be a body.
/// \param z_is_up  +z may be up, too.
[[nodiscard]] Result<ClosedPart> closePart(const TriangleMesh& open, bool is_body, bool z_is_up);

}  // namespace relief

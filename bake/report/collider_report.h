// SPDX-License-Identifier: Apache-2.0
// Reports of a collider, for `relief info` and `relief bake`.
#pragma once

#include <string>
#include <vector>

#include "bake/verdict/report_text.h"
#include "formats/animation/mesh_parts.h"
#include "formats/collider.h"
#include "formats/container.h"
#include "formats/fields/field.h"

namespace relief {

inline constexpr std::string_view kHashPattern = "^([0-9a-f]{32})?$";

void fields(FieldVisitor& visit, const Bounds& bounds);

void fields(FieldVisitor& visit, const Provenance& from);

struct ColliderMapReport {
    std::size_t index = 0;
    const DepthMap& map = kNone<DepthMap>;
    const PayloadInfo& payload = kNone<PayloadInfo>;
};

void fields(FieldVisitor& visit, const ColliderMapReport& report);

void fields(FieldVisitor& visit, const MeshClip& clip);

/// Visits the counts and names of an animated mesh, not its geometry.
void fields(FieldVisitor& visit, const AnimatedMesh& mesh);

void fields(FieldVisitor& visit, const Material& material);

/// Returns a line with the size of the materials in bytes, and a table.
[[nodiscard]] std::string materialsText(const Materials& materials);

/// Returns a line, the groups and materials, and a table of the clips; empty parts are omitted.
[[nodiscard]] std::string animationText(const AnimatedMesh& mesh);

/// \tparam Map  ColliderMapReport or a type with additional fields.
template <class Map>
struct ColliderReport {
    const Collider& collider = kNone<Collider>;
    const ContainerInfo& info = kNone<ContainerInfo>;
    std::vector<Map> maps = {};
    const AnimatedMesh* animated = nullptr;  ///< of the collider; may be null
    std::string file = {};                   ///< file name, if the report is one of several
};

/// \param maps  the reports of the maps
void colliderFields(FieldVisitor& visit, const Collider& collider, const ContainerInfo& info, FieldRef maps,
                    const AnimatedMesh* animated);
void fields(FieldVisitor& visit, const ColliderReport<ColliderMapReport>& report);

/// Makes the report of `relief info`.
/// \param animated  of the collider; may be null.
[[nodiscard]] inline ColliderReport<ColliderMapReport> infoReport(const Collider& collider,
                                                                  const ContainerInfo& info,
                                                                  const AnimatedMesh* animated) {
    ColliderReport<ColliderMapReport> report{collider, info, {}, animated, {}};
    for (std::size_t i = 0; i < collider.maps.size(); ++i) {
        report.maps.push_back({i, collider.maps[i], info.payloads[i]});
    }
    return report;
}

}  // namespace relief

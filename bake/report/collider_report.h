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

/// Returns the tool and the options: one line, or one per option if that line is too long.
[[nodiscard]] std::string originText(const Provenance& from);
/// Returns the number of meshes, then the tools and the common options. \param colliders  at least one
[[nodiscard]] std::string commonOriginText(const std::vector<Provenance>& colliders);

/// Returns a line with the size of the materials in bytes, and a table.
[[nodiscard]] std::string materialsText(const Materials& materials);

/// Returns a line of counts, the groups and materials, and a table of the clips; empty parts are omitted.
[[nodiscard]] std::string animationText(const AnimatedMesh& mesh);

[[nodiscard]] std::vector<ColliderMapReport> mapReports(const Collider& collider, const ContainerInfo& info);

/// Visits the fields that the reports of `relief info` and `relief bake` share.
/// \param maps  the reports of the maps \param animated  of the collider; may be null
void colliderFields(FieldVisitor& visit, const Collider& collider, const ContainerInfo& info, FieldRef maps,
                    const AnimatedMesh* animated);

/// The report of `relief info --json` on a collider.
struct ColliderJson {
    const Collider& collider = kNone<Collider>;
    const ContainerInfo& info = kNone<ContainerInfo>;
    const AnimatedMesh* animated = nullptr;  ///< of the collider; may be null
    std::string file = {};                   ///< file name, if the report is one of several
};

void fields(FieldVisitor& visit, const ColliderJson& report);

}  // namespace relief

// SPDX-License-Identifier: Apache-2.0
// The report of `relief check --mesh --json`.
#pragma once

#include <optional>
#include <string>

#include "bake/pipeline/mesh_check.h"
#include "bake/report/bake_report.h"
#include "bake/verdict/check_report.h"
#include "bake/verdict/parts_report.h"

namespace relief {

struct MeshCheckReport {
    const MeshCheck& run = kNone<MeshCheck>;
    std::string file;                     ///< name of the collider
    std::optional<float> max_error = {};  ///< percent

    /// The verdict. With `max_error`, its text states whether the error against the imported mesh is within the limit.
    [[nodiscard]] Verdict verdict() const;
};

void fields(FieldVisitor& visit, const MeshCheckReport& report);

}  // namespace relief

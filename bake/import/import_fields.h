// SPDX-License-Identifier: Apache-2.0
// Describes import options and limits as fields: options of the verbs that read a mesh, and arguments of relief-import.
#pragma once

#include <string>
#include <string_view>

#include "bake/import/import_job.h"
#include "formats/fields/text.h"

namespace relief {

/// Excludes `names`, which have options of their own.
void fields(FieldVisitor& visit, ImportOptions& options);

void fields(FieldVisitor& visit, ImportLimits& limits);

}  // namespace relief

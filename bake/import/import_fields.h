// SPDX-License-Identifier: Apache-2.0
// The options and limits of an import as fields: of the verbs that read a mesh, and between the importer's two programs.
#pragma once

#include <string>
#include <string_view>

#include "bake/import/import_job.h"
#include "formats/fields/text.h"

namespace relief {

/// Without names, which are options of their own.
void fields(FieldVisitor& visit, ImportOptions& options);

void fields(FieldVisitor& visit, ImportLimits& limits);

}  // namespace relief

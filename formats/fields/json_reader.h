// SPDX-License-Identifier: Apache-2.0
// Reads a JSON document into a struct with fields() (formats/base/field.h): the inverse of jsonOf(). Unknown keys,
// wrong types, numbers out of range and missing required fields are errors, reported as "bodies[3].rotation must be …;
// …".
#pragma once

#include <nlohmann/json_fwd.hpp>

#include "formats/base/field.h"
#include "formats/base/result.h"

namespace relief {

/// Reads `json` into `value`.
/// \param value  each float field must have a range within that of float. On failure, `value` may be partly changed.
/// Errors: kInvalidInput; messages do not include the file name.
[[nodiscard]] Result<void> readJson(const nlohmann::json& json, FieldRef value);

}  // namespace relief

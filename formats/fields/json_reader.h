// SPDX-License-Identifier: Apache-2.0
// Reads a JSON document into a struct with fields() (formats/base/field.h): the counterpart of jsonOf(). Unknown keys, wrong
// types, numbers out of their range and required fields that are missing are errors, each reported as
// "bodies[3].rotation must be …; the cure".
#pragma once

#include <nlohmann/json_fwd.hpp>

#include "formats/base/field.h"
#include "formats/base/result.h"

namespace relief {

/// \param value  whose floats have ranges that floats can hold. Changed also where it fails.
/// Errors: kInvalidInput, kLimit (more elements than a field may have), without the file's name.
[[nodiscard]] Result<void> readJson(const nlohmann::json& json, FieldRef value);

}  // namespace relief

// SPDX-License-Identifier: Apache-2.0
// Reads a TOML table into a struct with fields() (formats/base/field.h). Unknown keys, wrong types, values out of range
// and mutually exclusive keys are errors (toml_value.h).
#pragma once

#include "formats/config/toml_value.h"

namespace relief {

void readValue(const TomlValue& from, FieldRef value, const FieldInfo& info);

/// Reads a table into a struct, applies FieldInfo::rules, then calls the struct's check(), which may also complete the
/// struct:
///     std::optional<FieldFault> check(T& value, const GivenFields& given);
/// Sets the struct's member `place`, if it has one, to the position of the table.
void readToml(const TomlValue& from, FieldRef value);

}  // namespace relief

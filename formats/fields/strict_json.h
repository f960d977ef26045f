// SPDX-License-Identifier: Apache-2.0
// Parses untrusted JSON more strictly than nlohmann's parser.
#pragma once

#include <cstddef>
#include <limits>
#include <nlohmann/json_fwd.hpp>
#include <string_view>

#include "formats/base/result.h"

namespace relief {

struct JsonLimits {
    std::size_t depth = 256;  ///< nesting depth of objects and arrays
    /// Number of values in the text, excluding keys.
    std::size_t values = std::numeric_limits<std::size_t>::max();
};

/// Rejects invalid JSON, duplicate keys in an object, and NUL bytes. Checks the limits before it creates any value.
/// Errors, whose messages include no fix: kInvalidInput, kLimit.
[[nodiscard]] Result<nlohmann::json> parseStrictJson(std::string_view text, const JsonLimits& limits = {});

}  // namespace relief

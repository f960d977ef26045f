// SPDX-License-Identifier: Apache-2.0
// JSON from outside, parsed without what nlohmann's parser lets pass.
#pragma once

#include <cstddef>
#include <limits>
#include <nlohmann/json_fwd.hpp>
#include <string_view>

#include "formats/base/result.h"

namespace relief {

struct JsonLimits {
    std::size_t depth = 256;  ///< of objects and arrays within each other
    std::size_t values = std::numeric_limits<std::size_t>::max();  ///< of the whole text, keys not counted
};

/// Refuses, besides what is no JSON, equal keys in one object and a byte of 0. Nothing is allocated for a text beyond the
/// limits. Errors, without a cure: kInvalidInput, kLimit.
[[nodiscard]] Result<nlohmann::json> parseStrictJson(std::string_view text, const JsonLimits& limits = {});

}  // namespace relief

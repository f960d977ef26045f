// SPDX-License-Identifier: Apache-2.0
#include "formats/base/result.h"

#include <array>

namespace relief {

const char* errorCodeName(ErrorCode code) {
    constexpr std::array<const char*, 8> kNames{"success",        "usage",           "file or I/O",
                                                "invalid input",  "failure",         "unsupported",
                                                "limit exceeded", "difference found"};
    return kNames.at(static_cast<std::size_t>(code));
}

}  // namespace relief

// Bytes of an OpenVDB file that are the same in every run.
#pragma once

#include <openvdb/openvdb.h>

#include <cstddef>
#include <functional>
#include <vector>

#include "formats/base/result.h"

namespace relief {

/// What `make` throws becomes an error. Registers OpenVDB's types first.
/// Errors: kFailure (OpenVDB's exceptions, memory).
[[nodiscard]] Result<std::vector<std::byte>> vdbBytes(const std::function<openvdb::GridPtrVec()>& make);

}  // namespace relief

// `relief check FILE` without --mesh: the container alone.
#pragma once

#include <string>

#include "formats/base/result.h"
#include "formats/container_limits.h"

namespace relief {

/// Prints the report of inspectContainer, also of a damaged file.
/// \param file  "-" for standard input.
/// Errors: kIo, kLimit; kInvalidInput or what Inspection::errorCode says if the file is damaged.
[[nodiscard]] Result<void> checkFile(const std::string& file, bool json, const ContainerLimits& limits);

}  // namespace relief

// SPDX-License-Identifier: Apache-2.0
// Reads points from comma-separated text, and writes field samples. Independent of the locale.
#pragma once

#include <glm/vec3.hpp>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "formats/base/result.h"
#include "formats/collider.h"

namespace relief {

/// Parses one point per line: `x,y,z`, object space. Ignores empty lines, lines that start with '#', spaces around
/// numbers and carriage returns at line ends. The first line may be a header such as `x,y,z`.
/// \param name  of the file, for messages.
/// Errors: kInvalidInput, with `name`:line.
[[nodiscard]] Result<std::vector<glm::vec3>> parsePoints(std::string_view text, const std::string& name);

/// Formats samples as `x,y,z,f,nx,ny,nz,map`: a header, then one line per point. Numbers are the shortest decimals that
/// parse back exactly. f is the distance, "inf" for kFarOutside. f, nx, ny, nz and map are empty where no map votes.
/// \param decides  name of the last column.
[[nodiscard]] std::string formatSamples(std::span<const glm::vec3> points,
                                        std::span<const FieldSample> samples,
                                        std::string_view decides = "map");

}  // namespace relief

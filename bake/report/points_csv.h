// SPDX-License-Identifier: Apache-2.0
// Points in and field samples out, as comma-separated text. No locale.
#pragma once

#include <glm/vec3.hpp>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "formats/base/result.h"
#include "formats/collider.h"

namespace relief {

/// One point a line: `x,y,z`, object space. Empty lines, lines that start with '#', spaces round numbers and
/// a carriage return at the end are let pass, and so is one first line of words, such as `x,y,z`.
/// \param name  of the file, for messages.
/// Errors: kInvalidInput naming `name`:line.
[[nodiscard]] Result<std::vector<glm::vec3>> parsePoints(std::string_view text, const std::string& name);

/// `x,y,z,f,nx,ny,nz,map`, a header line and then one line a point, shortest decimals that read back exactly.
/// f is "inf" for kFarOutside; f, nx, ny, nz and map are empty where no map votes.
/// \param decides  the last column's name.
[[nodiscard]] std::string formatSamples(std::span<const glm::vec3> points,
                                        std::span<const FieldSample> samples,
                                        std::string_view decides = "map");

}  // namespace relief

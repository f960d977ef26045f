// SPDX-License-Identifier: Apache-2.0
// Points of a surface, from a file: places of birth for an emitter.
#pragma once

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <glm/vec3.hpp>
#include <span>
#include <string>
#include <vector>

#include "formats/base/result.h"
#include "runtime/particles/emitter.h"

namespace relief {

inline constexpr std::uint64_t kPointBytesMax = std::uint64_t{256} << 20;

/// Two kinds of files, distinguished by their first line:
///   - PLY (ascii, binary of either byte order) with an element "vertex" that has x, y and z, and perhaps
///     nx, ny and nz, of any type; other properties of it are skipped, and so is what follows it.
///   - Comma-separated text: x,y,z or x,y,z,nx,ny,nz a line. Empty lines, lines that start with '#', spaces
///     round numbers and a carriage return at the end are let pass, and so is one first line of words.
/// \param bytes  may be hostile. \param name  of the file, for messages.
/// Errors: kInvalidInput (not such a file, a number that is none or out of range, a normal of no length, no
/// point at all), kLimit (more than kPointsMax points).
[[nodiscard]] Result<PointList> parsePointList(std::span<const std::byte> bytes, const std::string& name);

/// readFile and parsePointList. Errors: theirs, kLimit above kPointBytesMax.
[[nodiscard]] Result<PointList> loadPointList(const std::filesystem::path& path);

}  // namespace relief

// SPDX-License-Identifier: Apache-2.0
// Reads the points of an emitter from a file.
#pragma once

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <glm/vec3.hpp>
#include <span>
#include <string>

#include "formats/base/result.h"
#include "runtime/particles/emitter.h"

namespace relief {

inline constexpr std::uint64_t kPointBytesMax = std::uint64_t{256} << 20;

/// Parses a point file. The first line determines the format:
///   - PLY (text, or binary of either byte order) whose first element, "vertex", has x, y and z, and optionally nx, ny
///     and nz, of any type. Its other properties and all later elements are skipped.
///   - Comma-separated text with x,y,z or x,y,z,nx,ny,nz in each line. One header line is skipped, as are empty lines,
///     lines that start with '#', spaces around numbers, and trailing carriage returns.
/// \param bytes  untrusted. \param name  of the file, for messages.
/// Errors: kInvalidInput (another format, an invalid number or one out of range, a zero normal, no points), kLimit
/// (more than kPointsMax points).
[[nodiscard]] Result<PointList> parsePointList(std::span<const std::byte> bytes, const std::string& name);

/// Combines readFile and parsePointList. Errors: those of both; kLimit above kPointBytesMax.
[[nodiscard]] Result<PointList> loadPointList(const std::filesystem::path& path);

}  // namespace relief

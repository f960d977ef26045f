// AC3D files, which assimp reads, and takes zeros for what is missing.
#pragma once

#include <cstddef>
#include <span>

namespace relief {

/// Whether an AC3D file holds less than its counts say. Files of other kinds do not.
[[nodiscard]] bool isAcCutOff(std::span<const std::byte> bytes);

}  // namespace relief

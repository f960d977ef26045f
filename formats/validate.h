// SPDX-License-Identifier: Apache-2.0
// The invariants of a collider, as specified in formats/README.md. The container's writer and reader both check them,
// so that everything written can be read back.
#pragma once

#include <cstddef>
#include <string>
#include <string_view>
#include <vector>

#include "formats/base/result.h"
#include "formats/collider.h"
#include "formats/issue.h"

namespace relief {

inline constexpr std::size_t kMeshNameMax = 255;  ///< bytes; likewise the next three
inline constexpr std::size_t kUnitMax = 16;
inline constexpr std::size_t kToolVersionMax = 64;
inline constexpr std::size_t kOptionsMax = std::size_t{1} << 20;
inline constexpr float kUnitLengthTolerance = 1e-3F;    ///< of the normal of a kFloat32 texel
inline constexpr double kFrameCosineMax = 1e-4;         ///< between two rows of object_to_map; absolute value
inline constexpr double kObjectPerMapTolerance = 1e-3;  ///< relative error of object_per_map

// All Results fail with kInvalidInput, or with kLimit for too many texels. Messages name the field and its value.
// Functions for one map do not name the map; callers add it with inMap().

/// Returns the problems of the bounds, unit, provenance and materials; those of the bounds come first.
[[nodiscard]] std::vector<Issue> descriptionIssues(const Collider& collider);

/// Validates a map except its texels, which may be missing.
[[nodiscard]] Result<void> validateFrame(const DepthMap& map);

/// Validates the texels of a map that passes validateFrame().
[[nodiscard]] Result<void> validateTexels(const DepthMap& map);

/// Validates the whole collider, which must have at least one map. Messages name the map ("map 3: …").
[[nodiscard]] Result<void> validate(const Collider& collider);

/// Prefixes an error with the index of its map.
[[nodiscard]] Error inMap(std::size_t index, const Error& error);

/// Returns a mesh's name in containers, which is also its file name in the folder that a scene's render.meshes names:
/// cleanUtf8() with '_' for '/' and '\', because node names may look like paths; truncated to kMeshNameMax bytes.
[[nodiscard]] std::string storedMeshName(std::string name);

/// Returns whether a text is well-formed UTF-8 (no overlong forms, no surrogates) without control characters.
[[nodiscard]] bool isPlainText(std::string_view text);

}  // namespace relief

// SPDX-License-Identifier: Apache-2.0
// How the parts of a mesh are interpreted: --as.
#pragma once

#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

#include "formats/base/result.h"
#include "formats/fields/field.h"

namespace relief {

/// How parts are interpreted.
enum class ShapeAs : std::uint8_t { kAuto, kSolid, kShell, kTerrain };
template <>
inline constexpr std::array<std::string_view, 4> kWordsOf<ShapeAs>{"auto", "solid", "shell", "terrain"};

/// Free space that sheets and solids seal together (sealed_voids.h).
enum class VoidsAs : std::uint8_t { kFull, kHollow };
template <>
inline constexpr std::array<std::string_view, 2> kWordsOf<VoidsAs>{"full", "hollow"};

/// Of shells: "0.01", or "auto=0.01" where it is a default, of which each sheet takes what suits its size.
struct Thickness {
    double length = 0.0;  ///< object units, above 0
    bool by_part = false;
};
[[nodiscard]] bool readForm(std::string_view word, Thickness& thickness);
[[nodiscard]] std::string formText(const Thickness& thickness);

/// How the triangles of a name, found by its mark (TriangleMesh::marks), are interpreted.
struct NamedShape {
    std::string name;  ///< clean UTF-8, 1 to kAskedNameBytesMax bytes
    ShapeAs as = ShapeAs::kAuto;

    friend bool operator==(const NamedShape&, const NamedShape&) = default;
};

struct ShapeOptions {
    /// kSolid: every part is a solid, with or without holes. kShell: every part is a sheet. kTerrain: every open part is
    /// a height field, along its flattest axis if none is better.
    ShapeAs as = ShapeAs::kAuto;
    double thickness = 0.0;  ///< of shells, object units, above 0: see defaultThickness
    /// Override `as`; each name once, at most kAskedNamesMax. Where a triangle has several, the last counts.
    std::vector<NamedShape> named = {};
    /// `thickness` is a default, of which each sheet takes what suits its own size (partThickness).
    bool thickness_by_part = false;
    bool thickness_by_texel = false;  ///< and suits a texel that is wanted of all: no sheet takes more
    VoidsAs voids = VoidsAs::kFull;

    [[nodiscard]] std::vector<std::string> names() const;  ///< of `named`, in that order
};

/// The values of --as: KIND at most once, and NAME=KIND, split at the last "=". Errors: kUsage, kLimit.
[[nodiscard]] Result<ShapeOptions> parseShapeOptions(const std::vector<std::string>& words);

}  // namespace relief

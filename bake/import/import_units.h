// SPDX-License-Identifier: Apache-2.0
// Converts units of length and axes of mesh files to metres and +Y up.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <glm/mat3x3.hpp>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "formats/base/field.h"
#include "formats/base/result.h"

namespace relief {

enum class UpAxis : std::uint8_t { kPlusX, kMinusX, kPlusY, kMinusY, kPlusZ, kMinusZ };

template <>
inline constexpr std::array<std::string_view, 6> kWordsOf<UpAxis>{"+x", "-x", "+y", "-y", "+z", "-z"};

/// The values of --unit.
inline constexpr std::array<std::string_view, 8> kLengthUnits{"m", "cm", "mm", "um", "km", "in", "ft", "yd"};

/// Returns the length of a unit in metres; nullopt if the unit is unknown.
[[nodiscard]] std::optional<double> metresPer(std::string_view unit);

/// Returns the rotation that maps `up` to +Y, exactly (its entries are 0, 1 and −1): a quarter turn about z for ±x, a
/// quarter turn about x for ±z, and a half turn about x for −y.
[[nodiscard]] glm::dmat3 turnUpwards(UpAxis up);

/// Units and axes as a file states them.
struct SourceFrame {
    std::optional<double> metres;  ///< per unit of the file
    std::optional<UpAxis> up;
    /// The file's coordinates are left-handed: its z is negated.
    bool mirrored = false;
    /// An invalid unit or axis in the file, as a clause: "its unit is -1 m". "": none.
    std::string unit_fault{};
    std::string up_fault{};
};

/// Fails if the frame is invalid in a part that the caller does not override.
/// Errors, without the file name: kInvalidInput, naming the option to use.
[[nodiscard]] Result<void> checkFrame(const SourceFrame& source, std::string_view unit,
                                      std::optional<UpAxis> up);

/// The conversion from a frame to metres and +Y up.
struct FrameChange {
    double scale = 1.0;
    glm::dmat3 turn{1.0};
    std::string unit;  ///< "m", or "" if unknown
    /// About overrides by the caller; without the file name.
    std::vector<std::string> warnings;
};

/// Computes the conversion.
/// \param unit  one of kLengthUnits, or "" for the file's unit.
/// \param up    nullopt for the file's axis.
[[nodiscard]] FrameChange changeOf(const SourceFrame& source, std::string_view unit,
                                   std::optional<UpAxis> up);

/// The UnitScaleFactor of an FBX file, binary or text, of any numeric type.
struct FbxUnit {
    std::string text;             ///< as stored in the file
    std::optional<double> value;  ///< nullopt if it is not a finite number
};
/// Reads the unit. \return nullopt if there is none.
[[nodiscard]] std::optional<FbxUnit> fbxUnit(std::span<const std::byte> document);

/// Reads the <asset> element of a COLLADA document in any encoding. Defaults: metres and +Y.
[[nodiscard]] SourceFrame colladaFrame(std::span<const std::byte> document);

}  // namespace relief

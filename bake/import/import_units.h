// SPDX-License-Identifier: Apache-2.0
// Units of length and axes of mesh files, and their conversion to metres and +Y up.
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

/// The words of --unit.
inline constexpr std::array<std::string_view, 8> kLengthUnits{"m", "cm", "mm", "um", "km", "in", "ft", "yd"};

/// \return the metres in one of the unit, or nullopt for another word.
[[nodiscard]] std::optional<double> metresPer(std::string_view unit);

/// The rotation (exact: of 0, 1 and −1) that carries `up` to +Y: a quarter turn about the z axis from ±x and
/// about the x axis from ±z, half a turn about x from −y.
[[nodiscard]] glm::dmat3 turnUpwards(UpAxis up);

/// Lengths and axes of a file, as it states them.
struct SourceFrame {
    std::optional<double> metres;  ///< in one unit of the file
    std::optional<UpAxis> up;
    /// The file's axes are left-handed, and its z is ours turned round.
    bool mirrored = false;
    /// An invalid length or axis of the file, each as a clause: "its unit is -1 m". "": none.
    std::string unit_fault{};
    std::string up_fault{};
};

/// Fails where the frame has a fault for which the caller gives no replacement.
/// Errors: kInvalidInput, without the file's name, with the option that is the cure.
[[nodiscard]] Result<void> checkFrame(const SourceFrame& source, std::string_view unit,
                                      std::optional<UpAxis> up);

/// How to bring positions of that frame into metres and +Y up.
struct FrameChange {
    double scale = 1.0;
    glm::dmat3 turn{1.0};
    std::string unit;  ///< "m", or "" if it is unknown
    /// Of overrides by the caller; each without the file's name.
    std::vector<std::string> warnings;
};

/// \param unit  one of kLengthUnits, or "" for the file's own.
/// \param up    nullopt for the file's own.
[[nodiscard]] FrameChange changeOf(const SourceFrame& source, std::string_view unit,
                                   std::optional<UpAxis> up);

/// The UnitScaleFactor of an FBX file, binary or text, of any type of number.
struct FbxUnit {
    std::string text;             ///< as in the file
    std::optional<double> value;  ///< nullopt: it is no finite number
};
/// \return nullopt: there is none.
[[nodiscard]] std::optional<FbxUnit> fbxUnit(std::span<const std::byte> document);

/// The frame in the <asset> of a COLLADA document of any encoding; metres and +y by default.
[[nodiscard]] SourceFrame colladaFrame(std::span<const std::byte> document);

}  // namespace relief

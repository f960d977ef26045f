// Units of length and axes of mesh files: what the formats say, and how both become metres and +Y up.
#pragma once

#include <cstddef>
#include <cstdint>
#include <glm/mat3x3.hpp>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "formats/base/result.h"

namespace relief {

enum class UpAxis : std::uint8_t { kPlusX, kMinusX, kPlusY, kMinusY, kPlusZ, kMinusZ };

/// "m", "cm", "mm", …: the words of --unit.
[[nodiscard]] std::vector<std::string_view> lengthUnits();

/// \return the metres in one of the unit, or nullopt for another word.
[[nodiscard]] std::optional<double> metresPer(std::string_view unit);

/// "+x" … "-z", of any case. Errors: kUsage.
[[nodiscard]] Result<UpAxis> parseUpAxis(std::string_view text);
[[nodiscard]] std::string_view upAxisName(UpAxis axis);

/// The rotation (exact: of 0, 1 and −1) that carries `up` to +Y: a quarter turn about the z axis from ±x and
/// about the x axis from ±z, half a turn about x from −y.
[[nodiscard]] glm::dmat3 turnUpwards(UpAxis up);

/// Lengths and axes of a file, as it states them.
struct SourceFrame {
    std::optional<double> metres;  ///< in one unit of the file
    std::optional<UpAxis> up;
    /// The file's axes are left-handed, and its z is ours turned round.
    bool mirrored = false;
    /// What the file says instead of a length or an axis, each as a clause: "its unit is -1 m". "" if it says none.
    std::string unit_fault{};
    std::string up_fault{};
};

/// Of a unit by its name, as 3MF has it: micron, millimeter, centimeter, inch, foot or meter.
[[nodiscard]] SourceFrame frameOfUnitName(std::string_view name);

/// Whether the frame can be taken: where it has a fault, the caller's word has to stand in for it.
/// Errors: kInvalidInput, without the file's name, with the option that is the cure.
[[nodiscard]] Result<void> checkFrame(const SourceFrame& source, std::string_view unit,
                                      std::optional<UpAxis> up);

/// How to bring positions of that frame into metres and +Y up.
struct FrameChange {
    double scale = 1.0;
    glm::dmat3 turn{1.0};
    std::string unit;  ///< "m", or "" where nobody says
    /// Where the caller's word counts and the file says something else; each without the file's name.
    std::vector<std::string> warnings;
};

/// \param unit  a word of lengthUnits(), or "" for the file's own.
/// \param up    nullopt for the file's own.
[[nodiscard]] FrameChange changeOf(const SourceFrame& source, std::string_view unit,
                                   std::optional<UpAxis> up);

/// The UnitScaleFactor of an FBX file, binary or text, of any type of number.
struct FbxUnit {
    std::string text;             ///< as it stands there
    std::optional<double> value;  ///< nullopt: it is no finite number
};
/// \return nullopt: there is none.
[[nodiscard]] std::optional<FbxUnit> fbxUnit(std::span<const std::byte> document);

/// Of the <asset> of a COLLADA document, where metres and +y are what it says where it says nothing. Of any encoding.
[[nodiscard]] SourceFrame colladaFrame(std::span<const std::byte> document);

/// The whole of the text, white space at its ends left out, as a finite number.
[[nodiscard]] std::optional<double> finiteNumber(std::string_view text);

/// Of a text that is no finite number: "'10,5' is no number; write a point for the comma".
[[nodiscard]] std::string noFiniteNumber(std::string_view text);

}  // namespace relief

// Units of length and axes of mesh files: what the formats say, and how both become metres and +Y up.
#pragma once

#include <cstdint>
#include <glm/mat3x3.hpp>
#include <optional>
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

/// What a file says of its lengths and axes, and what its importer has already applied.
struct SourceFrame {
    std::optional<double> metres;  ///< in one unit of the file
    std::optional<UpAxis> up;
    bool scaled = false;  ///< lengths are in metres already
    bool turned = false;  ///< up is +Y already
};

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

/// The up axis of a COLLADA document's first <asset>; +y where it says none, as COLLADA does.
[[nodiscard]] UpAxis colladaUp(std::string_view document);

}  // namespace relief

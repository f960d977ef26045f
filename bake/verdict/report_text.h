// SPDX-License-Identifier: Apache-2.0
// Formats numbers, sizes and tables for people.
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "formats/collider.h"

namespace relief {

/// Four significant digits, or "0".
[[nodiscard]] std::string shortNumber(double value);
/// Two significant digits; three from 99.5 on.
[[nodiscard]] std::string roughly(double value);
/// "0.41 %": two digits.
[[nodiscard]] std::string percentText(double percent);
/// "41.3 %" for 0.413.
[[nodiscard]] std::string fractionText(double share);
/// "1 hole", "3 holes". \param plural  such as "vertices"; empty: `what` with an s
[[nodiscard]] std::string countText(std::uint64_t count, std::string_view what, std::string_view plural = {});

/// "m"; "object units" for "".
[[nodiscard]] std::string unitText(const std::string& unit);
/// "0.41 m": two digits. \param unit  "m", or "" for object units, which are omitted
[[nodiscard]] std::string lengthText(double value, const std::string& unit);
/// "(0.1, 0.2, 0.3)": four digits.
[[nodiscard]] std::string positionText(const glm::vec3& p);
/// "12.3 MB", "640 B": powers of 1000.
[[nodiscard]] std::string bytesText(std::uint64_t bytes);
/// Rounds bytes up to two digits, at least kBudgetMin, for --budget.
[[nodiscard]] std::uint64_t roundBudget(std::uint64_t bytes);
/// "orthographic" or "cube"; "per patch" for patches, which each have their own axis.
[[nodiscard]] std::string projectionText(const DepthMap& map);
/// The surface that a map keeps along each ray; "-" for patches, which keep all.
[[nodiscard]] std::string keepsText(const DepthMap& map);
/// "512x256"; "6x64x64" for a cube; "49790 patches" for patches, or "-" without texels.
[[nodiscard]] std::string sizeText(const DepthMap& map);

/// Longest sides above this are rare in metres, and common in centimetres and millimetres.
inline constexpr float kMissingUnitSize = 100.0F;
/// Start of the text of missingUnitText().
inline constexpr std::string_view kNoUnit = "no unit is named";

/// "2 x 4 x 6 m, from (-1, -2, -3) to (1, 2, 3)"; "object units" without a unit.
[[nodiscard]] std::string boxText(const Bounds& bounds, const std::string& unit);
/// Returns the size in centimetres and in millimetres, and the option for each; nullopt if the bounds are smaller than
/// kMissingUnitSize.
/// \param bounds  of a mesh without a unit
[[nodiscard]] std::optional<std::string> missingUnitText(const Bounds& bounds);

/// Formats rows as aligned columns; the first row is the header. Columns whose header ends in '>' are right-aligned;
/// the '>' is not printed.
[[nodiscard]] std::string table(const std::vector<std::vector<std::string>>& rows);

}  // namespace relief

// What a check comes to: a verdict, the places where a collider is wrong most, and the commands that help.
#pragma once

#include <nlohmann/json_fwd.hpp>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "bake/measure/worst_places.h"
#include "formats/collider.h"

namespace relief {

/// Of the points near the surface on the wrong side, percent: at most that is good, at most that is fair.
inline constexpr double kGoodPercent = 1.0;
inline constexpr double kFairPercent = 5.0;

/// "good", "fair" or "poor"
[[nodiscard]] std::string gradeOf(double wrong_percent);
/// "0.4 % wrong near the surface: good"
[[nodiscard]] std::string verdictText(double wrong_percent);

/// Something to try.
struct Advice {
    std::string command;  ///< one line for a shell
    std::string about;    ///< "twice the bytes"
    /// What trying it in memory left on the wrong side, of the points near the surface; nullopt: not tried.
    std::optional<double> wrong_percent;
    std::string untried;  ///< why not; empty if tried
    bool helps = false;   ///< tried, and at most nine tenths are left
};

/// "map 2 (front-back along 0/0/-1)", "no map" for −1.
[[nodiscard]] std::string mapWords(const Collider& collider, int map);
/// "0.41 m across: 4.5 % of the wrong points, 86 % of them called inside"
[[nodiscard]] std::string placeText(const WorstPlace& place, const std::string& unit);
/// "(0.1, 0.2, 0.3)", four digits
[[nodiscard]] std::string positionText(const glm::vec3& p);
/// "below the texel size: map 2 (…) decides, whose texels are 0.02 wide"
[[nodiscard]] std::string causeText(const WorstPlace& place, const Collider& collider);

/// For people: a few lines for each place; "" without places.
[[nodiscard]] std::string placesText(std::span<const WorstPlace> places, const Collider& collider);
/// For people: the commands, the best first, and what did not help in words; "" without advice.
[[nodiscard]] std::string adviceText(std::span<const Advice> advice, double wrong_percent);

/// A list of position, size, points, share_percent, false_inside_percent, map, map_percent, cause, cause_percent,
/// texel, why.
[[nodiscard]] nlohmann::ordered_json jsonPlaces(std::span<const WorstPlace> places, const Collider& collider);
/// A list of command, about, tried, wrong_percent, helps, untried.
[[nodiscard]] nlohmann::ordered_json jsonAdvice(std::span<const Advice> advice);

}  // namespace relief

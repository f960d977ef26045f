// Measured accuracy as JSON, and as words for people.
#pragma once

#include <nlohmann/json_fwd.hpp>
#include <string>

#include "bake/measure/accuracy.h"

namespace relief {

/// Four significant digits, or "0".
[[nodiscard]] std::string shortNumber(double value);
/// Two significant digits, which are enough to choose by; three from 99.5 on.
[[nodiscard]] std::string roughly(double value);
/// A length of that many digits: "0.41 m". \param unit  "m", or "" for object units.
[[nodiscard]] std::string lengthText(double value, const std::string& unit);

/// wrong_percent, false_inside_percent, false_outside_percent.
[[nodiscard]] nlohmann::ordered_json jsonWrong(const WrongShare& share);

/// near and uniform (wrong, false_inside, false_outside), distance_error (mean, p99, and both in percent of
/// the longest side), far, unknown, normal_error and no_normal. All shares in percent, angles in degrees.
/// `seconds` is left out: the rest is the same in every run.
[[nodiscard]] nlohmann::ordered_json jsonFieldAccuracy(const FieldAccuracy& accuracy, double longest_side);

/// jsonFieldAccuracy and unseen_area, buried_area, gpu_bytes.
[[nodiscard]] nlohmann::ordered_json jsonColliderAccuracy(const ColliderAccuracy& accuracy,
                                                          double longest_side);

/// samples, seed, sigma (object units), sigma_percent, step (object units), longest_side.
[[nodiscard]] nlohmann::ordered_json jsonSamples(const TruthSamples& samples);

/// A few lines that say what was measured and what came out.
/// \param unit  of lengths: "m", or "" for object units.
[[nodiscard]] std::string accuracyText(const ColliderAccuracy& accuracy, const TruthSamples& samples,
                                       const std::string& unit);

}  // namespace relief

// SPDX-License-Identifier: Apache-2.0
// Limits of the numbers in a scene: generous, but small enough that no float overflows within a particle's lifetime.
#pragma once

#include <cstdint>

#include "formats/base/field.h"

namespace relief {

inline constexpr double kLengthMax = 1e9;
inline constexpr double kRateMax = 1e9;  ///< births per second
inline constexpr double kSpeedMax = 1e6;
inline constexpr double kAccelerationMax = 1e6;
inline constexpr double kSecondsMax = 1e6;
inline constexpr double kKeySecondsMax = 1e7;
inline constexpr std::uint32_t kStepsMax = 10'000'000;
inline constexpr double kDragMax = 1e6;
inline constexpr double kAngleMax = 1e6;  ///< degrees or radians
inline constexpr double kFactorMax = 1000.0;
inline constexpr std::uint64_t kSeedMax = std::uint64_t{1} << 53;  ///< integers up to it are exact doubles

inline constexpr FieldRange kPointRange = within(kLengthMax);  ///< coordinates
inline constexpr FieldRange kLengthRange{0.0, kLengthMax};
inline constexpr FieldRange kSizeRange{0.0, kLengthMax, false};
inline constexpr FieldRange kSpeedRange{0.0, kSpeedMax};
inline constexpr FieldRange kTimeRange{0.0, kSecondsMax};
inline constexpr FieldRange kLifeRange{0.0, kSecondsMax, false};
inline constexpr FieldRange kFactorRange{0.0, kFactorMax};
inline constexpr FieldRange kFovRange{1.0, 170.0};

}  // namespace relief

// SPDX-License-Identifier: Apache-2.0
// Four floats at a time. Sums use one fixed order, so that results are identical on all compilers and processors.
#pragma once

#include <cstddef>
#include <cstring>

namespace relief {

inline constexpr std::size_t kLanes = 4;
using Lanes = float __attribute__((vector_size(4 * sizeof(float))));
using TwoDoubles = double __attribute__((vector_size(2 * sizeof(double))));

/// \param from  needs only the alignment of Number.
template <class Vector, class Number>
[[nodiscard]] inline Vector loadLanes(const Number* from) {
    Vector vector;
    std::memcpy(&vector, from, sizeof vector);
    return vector;
}
template <class Vector, class Number>
inline void storeLanes(Number* to, const Vector& vector) {
    std::memcpy(to, &vector, sizeof vector);
}

[[nodiscard]] inline Lanes allLanes(float value) {
    return Lanes{value, value, value, value};
}
[[nodiscard]] inline Lanes absLanes(Lanes a) {
    return a < 0.0F ? -a : a;
}
/// \param low  at most `high`.
[[nodiscard]] inline Lanes clampLanes(Lanes a, Lanes low, Lanes high) {
    const Lanes raised = a < low ? low : a;
    return raised > high ? high : raised;
}
[[nodiscard]] inline float sumOfLanes(Lanes a) {
    return (a[0] + a[1]) + (a[2] + a[3]);
}

}  // namespace relief

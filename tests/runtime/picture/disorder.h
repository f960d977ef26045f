// How far a drawing order is from sorted, farthest first, on the CPU.
#pragma once

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <functional>
#include <span>
#include <vector>

namespace relief {

/// Pairs i < j for which belongsFirst(values[j], values[i]); counted by a merge sort, in O(n log n).
template <class T, class Before>
std::uint64_t countInversions(std::vector<T> values, Before before) {
    std::vector<T> merged(values.size());
    std::uint64_t inversions = 0;
    for (std::size_t run = 1; run < values.size(); run *= 2) {
        for (std::size_t low = 0; low < values.size(); low += 2 * run) {
            const std::size_t middle = std::min(low + run, values.size());
            const std::size_t high = std::min(low + 2 * run, values.size());
            std::size_t left = low;
            std::size_t right = middle;
            for (std::size_t out = low; out < high; ++out) {
                if (left == middle || (right < high && before(values[right], values[left]))) {
                    inversions += middle - left;  // it belongs before all that is left of the left run
                    merged[out] = values[right++];
                } else {
                    merged[out] = values[left++];
                }
            }
        }
        values.swap(merged);
    }
    return inversions;
}

struct Disorder {
    double adjacent = 0.0;     ///< share of neighbours out of order; a half for a random order
    double pairs = 0.0;        ///< share of all pairs out of order; a half for a random order
    double depth_error = 0.0;  ///< mean of |distance drawn i-th − distance that belongs i-th|, object units
};

/// \param distances  to the eye, in drawing order; two at least.
inline Disorder disorderOf(std::span<const double> distances) {
    std::vector<double> drawn(distances.begin(), distances.end());
    std::vector<double> sorted = drawn;
    std::sort(sorted.begin(), sorted.end(), std::greater<>());
    const auto n = static_cast<double>(drawn.size());
    Disorder disorder;
    for (std::size_t i = 0; i < drawn.size(); ++i) {
        disorder.adjacent += i > 0 && drawn[i] > drawn[i - 1] ? 1.0 / (n - 1.0) : 0.0;
        disorder.depth_error += std::abs(drawn[i] - sorted[i]) / n;
    }
    disorder.pairs =
        static_cast<double>(countInversions(std::move(drawn), std::greater<>())) / (0.5 * n * (n - 1.0));
    return disorder;
}

}  // namespace relief

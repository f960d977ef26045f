// SPDX-License-Identifier: Apache-2.0
// Deviations of random draws with fixed seeds from their distributions.
#pragma once

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <functional>
#include <vector>

namespace relief::test {

/// Kolmogorov's distance between draws and a distribution function, times √n. By chance it exceeds kKolmogorovMax once
/// in a million runs.
inline double kolmogorov(std::vector<double> draws, const std::function<double(double)>& cdf) {
    std::sort(draws.begin(), draws.end());
    const auto n = static_cast<double>(draws.size());
    double worst = 0.0;
    for (std::size_t i = 0; i < draws.size(); ++i) {
        const double f = cdf(draws[i]);
        const auto k = static_cast<double>(i);
        worst = std::max({worst, f - k / n, (k + 1.0) / n - f});
    }
    return worst * std::sqrt(n);
}
inline constexpr double kKolmogorovMax = 2.7;

/// Pearson's χ² of counts for expected fractions, minus its mean, in standard deviations. By chance it exceeds 6 once
/// in millions of runs.
inline double chiSquare(const std::vector<std::size_t>& counts, const std::vector<double>& fractions) {
    double whole = 0.0;
    double n = 0.0;
    for (std::size_t i = 0; i < counts.size(); ++i) {
        whole += fractions[i];
        n += static_cast<double>(counts[i]);
    }
    double sum = 0.0;
    for (std::size_t i = 0; i < counts.size(); ++i) {
        const double expected = n * fractions[i] / whole;
        sum += (static_cast<double>(counts[i]) - expected) * (static_cast<double>(counts[i]) - expected) /
               expected;
    }
    const double free = static_cast<double>(counts.size()) - 1.0;
    return (sum - free) / std::sqrt(2.0 * free);
}
inline constexpr double kChiSquareMax = 6.0;

}  // namespace relief::test

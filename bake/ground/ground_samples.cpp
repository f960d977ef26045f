// SPDX-License-Identifier: Apache-2.0
#include "bake/ground/ground_samples.h"

#include <algorithm>
#include <cmath>
#include <cstddef>

#include "bake/measure/percent.h"
#include "bake/mesh/surface_sampler.h"

namespace relief {

GroundStrata::GroundStrata(std::uint64_t squares, std::uint64_t samples, std::uint64_t seed,
                           GroundSample kind)
    : squares_(squares), samples_(squares > 0 ? samples : 0), seed_(seed), kind_(kind) {
    draw();
}

void GroundStrata::advance() {
    ++next_;
    draw();
}

void GroundStrata::draw() {
    MersenneRandom random(seed_, 3 * next_ + static_cast<std::uint64_t>(kind_));
    const double at =
        (static_cast<double>(next_) + random.uniform()) *
        (static_cast<double>(squares_) / static_cast<double>(std::max<std::uint64_t>(samples_, 1)));
    square_ = std::min(static_cast<std::uint64_t>(at), std::max<std::uint64_t>(squares_, 1) - 1);
    for (double& share : place_) {
        share = random.uniform();
    }
}

void GroundNearSums::add(const GroundOutcome& outcome) {
    ++near_.points;
    false_inside_ += outcome.inside && !outcome.truth ? 1 : 0;
    false_outside_ += !outcome.inside && outcome.truth ? 1 : 0;
    if (!outcome.error) {
        ++near_.missing;
        return;
    }
    sum_ += *outcome.error;
    sum_abs_ += std::abs(*outcome.error);
    distances_.push_back(static_cast<float>(std::abs(*outcome.error)));
}

GroundNear GroundNearSums::result() {
    near_.wrong = {percent(false_inside_, near_.points), percent(false_outside_, near_.points)};
    if (!distances_.empty()) {
        const auto count = static_cast<double>(distances_.size());
        near_.mean = sum_ / count;
        near_.mean_abs = sum_abs_ / count;
        const auto at = distances_.begin() + static_cast<std::ptrdiff_t>(0.99 * (count - 1.0));
        std::nth_element(distances_.begin(), at, distances_.end());
        near_.p99 = double{*at};
        near_.most = double{*std::max_element(at, distances_.end())};
    }
    return near_;
}

}  // namespace relief

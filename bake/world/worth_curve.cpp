// SPDX-License-Identifier: Apache-2.0
#include "bake/world/worth_curve.h"

#include <algorithm>
#include <cmath>

#include "formats/base/portable_math.h"

namespace relief {
namespace {

/// The power of typical meshes (bake/patches/NOTES.md), and its limits beyond the end of a curve, where steep curves
/// flatten.
constexpr double kPower = 0.73;
constexpr double kPowerLeast = 0.4;
constexpr double kPowerMost = 1.0;
/// The power is fitted over a range of this factor of bytes at the end of the curve.
constexpr double kPowerOver = 8.0;
/// exp() of this exceeds any budget.
constexpr double kLogMost = 60.0;

double slope(const ErrorPoint& a, const ErrorPoint& b) {
    return (a.wrong - b.wrong) / (b.bytes - a.bytes);
}

/// Returns the points of the convex hull, where slopes decrease.
ErrorCurve hullOf(const ErrorCurve& curve) {
    ErrorCurve hull;
    for (const ErrorPoint& point : curve) {
        while (hull.size() > 1 && slope(hull[hull.size() - 2], hull.back()) <= slope(hull.back(), point)) {
            hull.pop_back();
        }
        hull.push_back(point);
    }
    return hull;
}

double powerOf(const ErrorCurve& hull) {
    if (hull.size() < 2) {
        return kPower;
    }
    const ErrorPoint& end = hull.back();
    std::size_t from = 0;
    while (from + 2 < hull.size() && hull[from + 1].bytes * kPowerOver <= end.bytes) {
        ++from;
    }
    return portable::log(hull[from].wrong / end.wrong) / portable::log(end.bytes / hull[from].bytes);
}

}  // namespace

WorthCurve::WorthCurve(const ErrorCurve& curve, double weight) : power_(kPower) {
    const ErrorCurve hull = hullOf(curve);
    for (std::size_t i = 1; i < hull.size(); ++i) {
        add(std::sqrt(hull[i - 1].bytes * hull[i].bytes), weight * slope(hull[i - 1], hull[i]));
    }
    const ErrorPoint& end = hull.back();
    if (!(weight * end.wrong >= std::numeric_limits<double>::min())) {
        most_ = end.bytes;
        return;
    }
    const double power = powerOf(hull);
    const double worth = weight * power * end.wrong / end.bytes;
    add(end.bytes, knots_.empty() ? worth : std::min(worth, portable::exp(knots_.back().worth)));
    power_ = std::clamp(power, kPowerLeast, kPowerMost);
}

double WorthCurve::bytesAt(double log_worth) const {
    if (knots_.empty()) {
        return most_;
    }
    const auto bytes = [this](double log_bytes) {
        return std::min(most_, portable::exp(std::min(log_bytes, kLogMost)));
    };
    if (log_worth >= knots_.front().worth) {
        return bytes(knots_.front().bytes);
    }
    for (std::size_t i = 1; i < knots_.size(); ++i) {
        const Knot& a = knots_[i - 1];
        const Knot& b = knots_[i];
        if (log_worth >= b.worth) {
            return bytes(a.bytes + (a.worth - log_worth) / (a.worth - b.worth) * (b.bytes - a.bytes));
        }
    }
    const Knot& end = knots_.back();
    return bytes(end.bytes + (end.worth - log_worth) / (power_ + 1.0));
}

void WorthCurve::add(double bytes, double worth) {
    if (worth >= std::numeric_limits<double>::min()) {
        knots_.push_back({portable::log(bytes), portable::log(worth)});
    }
}

}  // namespace relief

// SPDX-License-Identifier: Apache-2.0
#include "runtime/particles/emitter.h"

#include <algorithm>
#include <cmath>
#include <glm/glm.hpp>
#include <initializer_list>
#include <string>
#include <utility>

#include "formats/base/finite.h"

namespace relief {
namespace {

// Maximum total births: beyond it a double cannot represent every integer.
constexpr double kCountMax = 9007199254740992.0;  // 2^53

// Keeps 60 steps of 1/60 s from missing the last birth of a second through rounding.
constexpr double kTimeSlack = 1e-12;

std::uint64_t wholeCount(double count) {
    return count > 0.0 ? static_cast<std::uint64_t>(std::min(count, kCountMax)) : 0;  // 0 for NaN
}

/// Returns the first problem that applies, or nullptr.
const char* firstOf(std::initializer_list<std::pair<bool, const char*>> problems) {
    for (const auto& [applies, problem] : problems) {
        if (applies) {
            return problem;
        }
    }
    return nullptr;
}

const char* problemOf(const EmitterSettings& s) {
    static const std::string kCounts = "points must contain 1 to " + std::to_string(kPointsMax) + " points";
    const bool box = s.shape == EmitterShape::kBox || s.shape == EmitterShape::kPoint;
    const bool points = s.shape == EmitterShape::kPoints;
    const bool surface = s.shape == EmitterShape::kSurface;
    const std::size_t count = s.points.positions.size();
    const auto ordered = [](const glm::vec3& low, const glm::vec3& high) {
        return isFinite(low) && isFinite(high) && low.x <= high.x && low.y <= high.y && low.z <= high.z;
    };
    const auto rising = [](float low, float high) {
        return low >= 0.0F && low <= high && std::isfinite(high);
    };
    const EmitterAim aim = s.aim.value_or(EmitterAim{.direction = glm::vec3(1.0F)});
    return firstOf({
        {box && !ordered(s.box_min, s.box_max), "box_min must be finite and not above box_max"},
        {points && (count == 0 || count > kPointsMax), kCounts.c_str()},
        {points && !s.points.normals.empty() && s.points.normals.size() != count,
         "points must have as many normals as positions, or none"},
        {s.shape == EmitterShape::kDisc && unitVector(s.normal) == glm::vec3(0.0F), "normal must not be 0"},
        {surface && !(s.surface && s.surface->area() > 0.0), "surface must have an area"},
        {!box && !points && !surface && !(isFinite(s.center) && rising(s.radius, s.radius)),
         "center and radius must be finite, and radius at least 0"},
        {!(s.start >= 0.0 && s.rate >= 0.0 && s.duration > 0.0 && s.burst_every >= 0.0),
         "start, rate and burst_every must be at least 0, and duration above 0"},
        {!isFinite(s.velocity) || !ordered(glm::vec3(0.0F), s.velocity_spread),
         "velocity must be finite, and velocity_spread at least 0"},
        {!(s.lifetime_min > 0.0F && rising(s.lifetime_min, s.lifetime_max)),
         "lifetime_min must be above 0 and not above lifetime_max, which must be finite"},
        {aim.direction ? unitVector(*aim.direction) == glm::vec3(0.0F) : box,
         "aim.direction is required and must not be 0"},
        {!aim.direction && points && s.points.normals.empty(),
         "aim.direction is required if points have no normals"},
        {!(aim.cone_degrees >= 0.0F && aim.cone_degrees <= 180.0F), "aim.cone_degrees must be 0 to 180"},
        {!rising(aim.speed_min, aim.speed_max) || !rising(aim.speed_deviation, aim.speed_deviation),
         "aim speeds must be finite, at least 0, and speed_min not above speed_max"},
    });
}

}  // namespace

Result<void> Emitter::check(const EmitterSettings& settings) {
    if (const char* problem = problemOf(settings); problem != nullptr) {
        return fail(ErrorCode::kUsage, std::string("an emitter's ") + problem);
    }
    return {};
}

Emitter::Emitter(EmitterSettings settings, std::uint64_t seed, std::uint64_t stream)
    : settings_(std::move(settings)),
      random_(seed, stream),
      basis_(basisAbout(unitVector(settings_.normal))) {
    if (settings_.aim) {
        opening_ = static_cast<float>(oneMinusCosine(static_cast<double>(settings_.aim->cone_degrees)));
        aim_basis_ = basisAbout(unitVector(settings_.aim->direction.value_or(glm::vec3(0.0F, 0.0F, 1.0F))));
    }
}

double Emitter::rateBirths(double active) const {
    const double until = std::min(active, settings_.duration * (1.0 + kTimeSlack));
    return std::min(settings_.rate * until, kCountMax);
}

std::uint64_t Emitter::burstsDue(double active) const {
    if (settings_.burst == 0 || !(active >= 0.0)) {
        return 0;
    }
    const double every = settings_.burst_every;
    if (!(every > 0.0)) {
        return 1;
    }
    // Burst j is due at j · every, always computed as the same product.
    const auto due = [&](double j) { return j * every <= active && j * every < settings_.duration; };
    double last = std::floor(std::min({active / every, settings_.duration / every, kCountMax}));
    while (last > 0.0 && !due(last)) {
        last -= 1.0;
    }
    while (last < kCountMax && due(last + 1.0)) {
        last += 1.0;
    }
    return wholeCount(last) + 1;
}

Emitter::Due Emitter::dueAfter(double dt) const {
    // Kahan summation: a day of small steps ends at the same time as one long step.
    const double more = dt + remainder_;
    const double sum = elapsed_ + more;
    Due due{.elapsed = sum, .remainder = std::isfinite(sum) ? more - (sum - elapsed_) : 0.0};
    const double active = sum - settings_.start + kTimeSlack * sum;
    due.started = active >= 0.0;
    if (due.started) {
        due.steady = wholeCount(rateBirths(active));
        due.bursts = burstsDue(active);
    }
    return due;
}

bool Emitter::isDue(double dt) const {
    const Due due = dueAfter(dt);
    return due.steady > steady_ || due.bursts > bursts_;
}

std::uint64_t Emitter::emit(double dt, std::uint64_t room, std::vector<Birth>& births) {
    const Due due = dueAfter(dt);
    elapsed_ = due.elapsed;
    remainder_ = due.remainder;
    birth_surface_velocities_.clear();
    if (!due.started) {
        return 0;
    }
    const std::uint64_t steady_due = due.steady - std::min(due.steady, steady_);
    const std::uint64_t burst_due =
        wholeCount(static_cast<double>(due.bursts - std::min(due.bursts, bursts_)) *
                   static_cast<double>(settings_.burst));
    const std::uint64_t wanted = steady_due + burst_due;
    const bool no_area = settings_.shape == EmitterShape::kSurface && !(settings_.surface->area() > 0.0);
    const std::uint64_t made = no_area ? 0 : std::min(wanted, room);

    // Output births in order of time. Before burst j, output the births of `rate` up to the time of the burst. Their
    // number does not depend on the step boundaries, and is at most the number due in this step.
    const std::size_t first = births.size();
    if (births.capacity() < first + made) {
        births.reserve(std::max(first + static_cast<std::size_t>(made), 2 * births.capacity()));
    }
    std::uint64_t left = made;
    std::uint64_t steady = steady_;
    for (std::uint64_t burst = bursts_; left > 0; ++burst) {
        const bool last = burst >= due.bursts;
        const std::uint64_t until =
            last ? due.steady : wholeCount(rateBirths(static_cast<double>(burst) * settings_.burst_every));
        const std::uint64_t by_rate = std::min(left, until - std::min(until, steady));
        for (std::uint64_t i = 0; i < by_rate; ++i) {
            const double moment = settings_.start + static_cast<double>(steady + i + 1) / settings_.rate;
            Birth& birth = births.emplace_back();
            birth.age =
                settings_.interpolate ? static_cast<float>(std::clamp(elapsed_ - moment, 0.0, dt)) : 0.0F;
            sample(birth);
        }
        steady += by_rate;
        left -= by_rate;
        if (last) {
            break;
        }
        const std::uint64_t at_once = std::min(left, settings_.burst);
        for (std::uint64_t i = 0; i < at_once; ++i) {
            sample(births.emplace_back());
        }
        left -= at_once;
    }
    steady_ = std::max(steady_, due.steady);
    bursts_ = std::max(bursts_, due.bursts);
    return wanted - made;
}

/// \return the normal at the point; 0 if it has none.
glm::vec3 Emitter::place(Birth& birth) {
    const EmitterSettings& s = settings_;
    switch (s.shape) {
        case EmitterShape::kBox:
        case EmitterShape::kPoint:
            birth.position = random_.between(s.box_min, s.box_max);
            break;
        case EmitterShape::kSphere: {
            const glm::vec3 p = inUnitBall(random_);
            birth.position = s.center + s.radius * p;
            return p;
        }
        case EmitterShape::kShell: {
            const glm::vec3 p = onUnitSphere(random_);
            birth.position = s.center + s.radius * p;
            return p;
        }
        case EmitterShape::kDisc: {
            const glm::vec2 p = inUnitDisc(random_);
            birth.position = s.center + s.radius * (p.x * basis_.x + p.y * basis_.y);
            return basis_.z;
        }
        case EmitterShape::kPoints: {
            const std::uint32_t at = random_.below(static_cast<std::uint32_t>(s.points.positions.size()));
            birth.position = s.points.positions[at];
            return s.points.normals.empty() ? glm::vec3(0.0F) : s.points.normals[at];
        }
        case EmitterShape::kSurface: {
            const BirthSurface::Place at = s.surface->draw(random_, birth.age);
            birth.position = at.position;
            birth_surface_velocities_.push_back(at.velocity);
            return at.normal;
        }
    }
    return glm::vec3(0.0F);
}

// The order of the random draws must not change, because seeded runs depend on it: place, velocity, aim, lifetime.
void Emitter::sample(Birth& birth) {
    const EmitterSettings& s = settings_;
    const glm::vec3 normal = place(birth);
    birth.velocity = s.velocity + random_.between(-s.velocity_spread, s.velocity_spread);
    if (s.aim) {
        birth.velocity += aimed(normal);
    }
    birth.lifetime = random_.between(s.lifetime_min, s.lifetime_max);
    birth.type = s.type;
}

glm::vec3 Emitter::aimed(const glm::vec3& normal) {
    const EmitterAim& aim = *settings_.aim;
    glm::vec3 direction{0.0F, 0.0F, 1.0F};
    if (opening_ > 0.0F) {
        direction = inCone(random_, opening_);
    }
    direction = (aim.direction ? aim_basis_ : basisAbout(unitVector(normal))).toWorld(direction);
    float speed = 0.0F;
    do {
        speed = aim.speed_min < aim.speed_max ? random_.between(aim.speed_min, aim.speed_max) : aim.speed_min;
        if (aim.speed_deviation > 0.0F) {
            speed += aim.speed_deviation * standardNormal(random_);
        }
    } while (speed < 0.0F);
    return speed * direction;
}

}  // namespace relief

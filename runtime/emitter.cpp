#include "runtime/emitter.h"

#include <algorithm>

namespace relief {
namespace {

// Births asked for in all stay below this: beyond it a double no longer counts one by one.
constexpr double kCountMax = 9007199254740992.0;  // 2^53

}  // namespace

Pcg32::Pcg32(std::uint64_t seed, std::uint64_t stream) : increment_(stream << 1 | 1) {
    next();
    state_ += seed;
    next();
}

std::uint32_t Pcg32::next() {
    const std::uint64_t old = state_;
    state_ = old * 6364136223846793005U + increment_;
    const auto shifted = static_cast<std::uint32_t>((old >> 18 ^ old) >> 27);
    const auto turn = static_cast<std::uint32_t>(old >> 59);
    return shifted >> turn | shifted << ((32 - turn) & 31);
}

float Pcg32::uniform() {
    return static_cast<float>(next() >> 8) * 0x1p-24F;
}

float Pcg32::between(float low, float high) {
    const float t = uniform();
    // This form cannot overflow where high − low would, and the clamp keeps rounding inside.
    return std::clamp((1.0F - t) * low + t * high, low, high);
}

Emitter::Emitter(const EmitterSettings& settings, std::uint64_t seed) : settings_(settings), random_(seed) {}

std::uint64_t Emitter::emit(double dt, std::uint64_t room, std::vector<Birth>& births) {
    elapsed_ += dt;
    // The small extra keeps 60 steps of 1/60 s from missing the last birth of a second by rounding.
    const double by_rate =
        std::min(settings_.rate * std::min(elapsed_, settings_.duration) * (1.0 + 1e-12), kCountMax);
    const std::uint64_t target = settings_.burst + static_cast<std::uint64_t>(by_rate);
    const std::uint64_t wanted = target - std::min(target, asked_for_);
    asked_for_ = std::max(asked_for_, target);

    const std::uint64_t made = std::min(wanted, room);
    births.reserve(births.size() + made);
    for (std::uint64_t i = 0; i < made; ++i) {
        Birth birth;
        for (int axis = 0; axis < 3; ++axis) {
            birth.position[axis] = random_.between(settings_.box_min[axis], settings_.box_max[axis]);
        }
        for (int axis = 0; axis < 3; ++axis) {
            const float spread = settings_.velocity_spread[axis];
            birth.velocity[axis] = settings_.velocity[axis] + random_.between(-spread, spread);
        }
        birth.lifetime = random_.between(settings_.lifetime_min, settings_.lifetime_max);
        birth.type = settings_.type;
        births.push_back(birth);
    }
    return wanted - made;
}

}  // namespace relief

// SPDX-License-Identifier: Apache-2.0
#include "runtime/particles/random.h"

#include <cmath>

#include "formats/base/finite.h"
#include "formats/base/portable_math.h"

namespace relief {

std::uint32_t Pcg32::below(std::uint32_t count) {
    std::uint64_t product = std::uint64_t{next()} * count;
    if (static_cast<std::uint32_t>(product) < count) {
        // 2^32 mod count: the number of products to reject for a uniform distribution.
        const std::uint32_t excess = (0U - count) % count;
        while (static_cast<std::uint32_t>(product) < excess) {
            product = std::uint64_t{next()} * count;
        }
    }
    return static_cast<std::uint32_t>(product >> 32);
}

glm::vec2 inUnitDisc(Pcg32& random) {
    glm::vec2 p;
    do {
        p.x = random.signedUniform();
        p.y = random.signedUniform();
    } while (p.x * p.x + p.y * p.y >= 1.0F);
    return p;
}

glm::vec3 inUnitBall(Pcg32& random) {
    glm::vec3 p;
    do {
        p.x = random.signedUniform();
        p.y = random.signedUniform();
        p.z = random.signedUniform();
    } while (p.x * p.x + p.y * p.y + p.z * p.z >= 1.0F);
    return p;
}

glm::vec3 onUnitSphere(Pcg32& random) {
    return inCone(random, 2.0F);
}

float standardNormal(Pcg32& random) {
    const glm::vec2 p = inUnitDisc(random);
    const double x = static_cast<double>(p.x);
    const double y = static_cast<double>(p.y);
    const double square = x * x + y * y;
    return static_cast<float>(x * std::sqrt(-2.0 * portable::log(square) / square));
}

double oneMinusCosine(double degrees) {
    // 2 sin²(a/2), because 1 − cos loses all precision for small angles.
    const double sine = portable::sin(degrees * (3.14159265358979323846 / 360.0));
    return 2.0 * sine * sine;
}

glm::vec3 inCone(Pcg32& random, float opening) {
    // For a uniform point in the disc, the squared radius is uniform and independent of the angle (Marsaglia 1972). The
    // squared radius gives the height, which is uniform over a cone's solid angle (Archimedes); the angle gives the
    // azimuth.
    const glm::vec2 p = inUnitDisc(random);
    const float down = std::min(p.x * p.x + p.y * p.y, 1.0F) * opening;
    const float aside = std::sqrt(opening * (2.0F - down));
    return {aside * p.x, aside * p.y, 1.0F - down};
}

glm::vec3 unitVector(const glm::vec3& v) {
    const float largest = std::max({std::abs(v.x), std::abs(v.y), std::abs(v.z)});
    if (!(largest > 0.0F && isFinite(v))) {
        return glm::vec3(0.0F);
    }
    const glm::vec3 scaled = v / largest;
    return scaled / std::sqrt(scaled.x * scaled.x + scaled.y * scaled.y + scaled.z * scaled.z);
}

Basis basisAbout(const glm::vec3& z) {
    const float sign = std::signbit(z.z) ? -1.0F : 1.0F;
    const float a = -1.0F / (sign + z.z);
    const float b = z.x * z.y * a;
    return {{1.0F + sign * z.x * z.x * a, sign * b, -sign * z.x}, {b, sign + z.y * z.y * a, -z.y}, z};
}

}  // namespace relief

// SPDX-License-Identifier: Apache-2.0
#include "formats/nearest_surface.h"

#include <algorithm>
#include <cmath>

#include "formats/base/finite.h"

namespace relief {
namespace {

float dot(const glm::vec3& a, const glm::vec3& b) {
    return a.x * b.x + (a.y * b.y + a.z * b.z);
}

float length(const glm::vec3& v) {
    return std::sqrt(dot(v, v));
}

glm::vec3 cross(const glm::vec3& a, const glm::vec3& b) {
    return {a.y * b.z - a.z * b.y, a.z * b.x - a.x * b.z, a.x * b.y - a.y * b.x};
}

/// The plane of a vote, oriented so that P is on its positive side: at + normal·y is the distance of P + y.
struct Plane {
    glm::vec3 normal;
    float at;
};

/// Up to three planes; the other side is the region behind all of them.
class Corner {
  public:
    explicit Corner(const Plane& plane) : planes_{plane}, foot_(-plane.at * plane.normal) {}

    /// Returns the point of the other side nearest to P, relative to P.
    [[nodiscard]] const glm::vec3& foot() const { return foot_; }
    /// Returns the normal of the newest plane.
    [[nodiscard]] const glm::vec3& normal() const { return planes_[count_ - 1].normal; }
    [[nodiscard]] bool isCutBy(const Plane& plane) const {
        return plane.at + dot(plane.normal, foot_) > 0.0F;
    }

    /// Adds a plane for which the foot is on P's side; drops the oldest of four. The new foot lies on the added plane.
    void add(const Plane& plane) {
        if (count_ == 3) {
            planes_[0] = planes_[1];
            planes_[1] = planes_[2];
            count_ = 2;
        }
        planes_[count_++] = plane;
        while (!meet()) {
            planes_[0] = planes_[1];
            planes_[1] = planes_[2];
            --count_;
        }
    }

  private:
    /// Makes y the foot if it is behind all planes.
    [[nodiscard]] bool tryFoot(const glm::vec3& y) {
        for (int i = 0; i < count_; ++i) {
            if (!(planes_[i].at + dot(planes_[i].normal, y) <= 1e-4F * planes_[i].at)) {
                return false;
            }
        }
        foot_ = y;
        return true;
    }

    /// Finds the nearest point on the intersection of two planes that P is in front of.
    [[nodiscard]] bool tryEdge(const Plane& a, const Plane& b) {
        const float cosine = dot(a.normal, b.normal);
        const float sine2 = 1.0F - cosine * cosine;
        const float along_a = cosine * b.at - a.at;
        const float along_b = cosine * a.at - b.at;
        return sine2 > 1e-4F && along_a <= 0.0F && along_b <= 0.0F &&
               tryFoot((along_a / sine2) * a.normal + (along_b / sine2) * b.normal);
    }

    /// Sets the foot: on the newest plane, else on its edge with another plane, else at the corner of all three. Returns
    /// false if there is none in float precision.
    [[nodiscard]] bool meet() {
        const Plane& a = planes_[count_ - 1];
        if (tryFoot(-a.at * a.normal) || count_ == 1) {
            return true;
        }
        if (tryEdge(a, planes_[0]) || (count_ == 3 && tryEdge(a, planes_[1]))) {
            return true;
        }
        if (count_ < 3) {
            return false;
        }
        const Plane& b = planes_[0];
        const Plane& c = planes_[1];
        const glm::vec3 bc = cross(b.normal, c.normal);
        const float volume = dot(a.normal, bc);
        if (!(std::abs(volume) > 1e-3F)) {
            return false;
        }
        foot_ = (-1.0F / volume) *
                (a.at * bc + (b.at * cross(c.normal, a.normal) + c.at * cross(a.normal, b.normal)));
        return true;
    }

    Plane planes_[3];
    int count_ = 1;
    glm::vec3 foot_;
};

class Search {
  public:
    Search(const Collider& collider, const glm::vec3& p, const FieldSample& sample)
        : collider_(collider),
          p_(p),
          side_(collider.bounds.longestSide()),
          sign_(sample.distance < 0.0F ? -1.0F : 1.0F) {
        if (sample.distance < kFarOutside) {
            follow({sign_ * sample.normal, sign_ * sample.distance}, nullptr, NearestSearch::kSteps);
        }
        findAny();
        probeAround();
        tilt();
    }

    [[nodiscard]] bool found() const { return best_.distance < kFarOutside; }
    [[nodiscard]] float sign() const { return sign_; }
    [[nodiscard]] const SurfaceSample& best() const { return best_; }  ///< its distance is unsigned

  private:
    // ---- point evaluation

    /// If P is outside, clamps to the bounds: there is no solid beyond them.
    [[nodiscard]] glm::vec3 clamped(const glm::vec3& q) const {
        if (sign_ < 0.0F) {
            return q;
        }
        const auto one = [&](int k) {
            return std::min(std::max(q[k], collider_.bounds.min[k]), collider_.bounds.max[k]);
        };
        return {one(0), one(1), one(2)};
    }

    [[nodiscard]] bool isOther(const FieldSample& sample) const {
        return sample.map >= 0 && (sample.distance < 0.0F) != (sign_ < 0.0F);
    }

    /// Returns the plane of a sample at P + y. `at` is not above 0 if there is no plane, or if P is not in front of it.
    [[nodiscard]] Plane planeOf(const FieldSample& sample, const glm::vec3& y) const {
        if (sample.map < 0 || sample.distance >= kFarOutside) {
            return {glm::vec3(0.0F), 0.0F};
        }
        const glm::vec3 normal = sign_ * sample.normal;
        return {normal, sign_ * sample.distance - dot(normal, y)};
    }

    [[nodiscard]] FieldSample sampleAt(const glm::vec3& q) {
        --left_;
        return evaluate(collider_, q);
    }

    /// Proposes a surface point at P + y. Returns whether it is the nearest so far.
    bool offer(const glm::vec3& y, const FieldSample& sample) {
        const float distance = length(y);
        if (!(distance < best_.distance)) {
            return false;
        }
        const bool far = sample.distance >= kFarOutside;
        best_ = {distance, p_ + y, far ? y / distance : sample.normal, sample.map};
        settled_ = false;
        return true;
    }

    // ---- search steps

    /// Searches from a plane towards the surface.
    /// \param known  a point on the other side, relative to P; null if there is none.
    void follow(const Plane& plane, const glm::vec3* known, int steps) {
        Corner corner(plane);
        bool has_other = known != nullptr;
        glm::vec3 other = has_other ? *known : glm::vec3(0.0F);
        glm::vec3 failed(0.0F);
        bool halving = false;  // bisecting between the other side and a foot without a surface
        for (int step = 0; step < steps && left_ > 0; ++step) {
            glm::vec3 y = 0.5F * (other + failed);
            float to_foot = 1.0F;  // fraction of y
            if (!halving) {
                const glm::vec3& foot = corner.foot();
                const float distance = length(foot);
                if (!(distance < best_.distance)) {
                    return;
                }
                const float beyond =
                    std::max(std::min(NearestSearch::kBeyond * distance, NearestSearch::kBeyondMax * side_),
                             NearestSearch::kBeyondMin * side_);
                y = foot + (distance > NearestSearch::kBeyondMin * side_ ? (beyond / distance) * foot
                                                                         : -beyond * corner.normal());
                to_foot = distance / (distance + beyond);
            }
            const FieldSample sample = sampleAt(p_ + y);
            const Plane new_plane = planeOf(sample, y);
            if (isOther(sample)) {
                // The plane predicts where the surface lies between the foot and y. It is not used before the foot,
                // where it may not hold.
                const float fraction =
                    new_plane.at > 0.0F ? new_plane.at / (new_plane.at - sign_ * sample.distance) : 1.0F;
                const bool nearest = offer(std::max(fraction, to_foot) * y, sample);
                has_other = true;
                other = y;
                if (!halving) {
                    if (!(new_plane.at > 0.0F && new_plane.at < NearestSearch::kNearer * best_.distance)) {
                        settled_ = settled_ || nearest;
                        return;
                    }
                    corner = Corner(new_plane);
                }
            } else if (new_plane.at > 0.0F && corner.isCutBy(new_plane)) {
                corner.add(new_plane);
                halving = false;
            } else if (has_other) {
                failed = y;
                halving = true;
            } else {
                return;
            }
        }
    }

    /// Bisects between P and P + y, which is on the other side, and returns a nearer point on the other side.
    [[nodiscard]] glm::vec3 nearerOther(glm::vec3 y, Plane& plane) {
        glm::vec3 own(0.0F);
        for (int i = 0; i < NearestSearch::kHalvings && left_ > 0; ++i) {
            const glm::vec3 middle = 0.5F * (own + y);
            const FieldSample sample = sampleAt(p_ + middle);
            if (isOther(sample)) {
                offer(middle, sample);
                y = middle;
                plane = planeOf(sample, middle);
            } else {
                own = middle;
            }
        }
        return y;
    }

    /// Tests whether q is on the other side; with `whole`, also follows planes on P's own side.
    void probe(const glm::vec3& q, bool whole) {
        glm::vec3 y = q - p_;
        const float distance = length(y);
        if (left_ == 0 || !(distance > 0.0F && distance < best_.distance)) {
            return;
        }
        if (sign_ > 0.0F && !whole && !evaluateInside(collider_, q).inside) {  // usually costs one vote
            --left_;
            return;
        }
        const FieldSample sample = sampleAt(q);
        Plane new_plane = planeOf(sample, y);
        const bool other = isOther(sample);
        if (other) {
            const bool first = !found();
            offer(y, sample);
            if (first) {
                y = nearerOther(y, new_plane);
            }
        }
        if ((other || whole) && new_plane.at > 0.0F) {
            follow(new_plane, other ? &y : nullptr, NearestSearch::kStepsFromProbe);
        }
    }

    static glm::vec3 axis(int i) {
        glm::vec3 direction(0.0F);
        direction[i >> 1] = (i & 1) != 0 ? 1.0F : -1.0F;
        return direction;
    }

    static glm::vec3 diagonal(int i) {
        constexpr float kUnit = 0.57735027F;
        return {(i & 1) != 0 ? kUnit : -kUnit, (i & 2) != 0 ? kUnit : -kUnit, (i & 4) != 0 ? kUnit : -kUnit};
    }

    /// If the vote at P led to no surface, probes rings around P, or around the nearest point of the bounds, until a
    /// surface is found.
    void findAny() {
        const glm::vec3 center = clamped(p_);
        if (center != p_) {
            probe(center, true);
        }
        for (int k = NearestSearch::kFinestRing; k >= 0 && !found(); --k) {
            const float radius = std::ldexp(side_, -k);
            for (int i = 0; i < 14; ++i) {
                probe(clamped(center + radius * (i < 8 ? diagonal(i) : axis(i - 8))), false);
            }
        }
        for (int k = NearestSearch::kFinestWholeRing; k >= 0 && !found(); --k) {
            for (int i = 0; i < 6; ++i) {
                probe(clamped(center + std::ldexp(side_, -k) * axis(i)), true);
            }
        }
    }

    /// Checks whether another surface is nearer.
    void probeAround() {
        float before = kFarOutside;
        for (int round = 0; round < NearestSearch::kRounds && best_.distance < before; ++round) {
            before = best_.distance;
            for (int i = 0; i < 14; ++i) {
                const glm::vec3 offset =
                    i < 8 ? NearestSearch::kShareNear * diagonal(i) : NearestSearch::kShareFar * axis(i - 8);
                probe(clamped(p_ + best_.distance * offset), false);
            }
        }
    }

    /// If no plane confirmed that the point found is the nearest of its surface, tilts its direction from P to four sides
    /// while this shortens the distance.
    void tilt() {
        float slope = NearestSearch::kTilt;
        for (int k = 0; k < NearestSearch::kTurns && slope >= NearestSearch::kTiltMin && found() && !settled_;
             ++k) {
            const float before = best_.distance;
            const glm::vec3 direction = (best_.point - p_) / before;
            const glm::vec3 across = std::abs(direction.x) < 0.6F ? glm::vec3(1, 0, 0) : glm::vec3(0, 1, 0);
            const glm::vec3 right = across - dot(across, direction) * direction;
            const glm::vec3 side = right / length(right);
            const glm::vec3 up = cross(direction, side);
            for (int i = 0; i < 4 && best_.distance == before; ++i) {
                const glm::vec3 tilted = direction + ((i & 1) != 0 ? -slope : slope) * (i < 2 ? side : up);
                const float radius = before * (1.0F - 0.25F * slope);
                probe(clamped(p_ + (radius / length(tilted)) * tilted), false);
            }
            if (best_.distance == before) {
                slope *= 0.5F;
            }
        }
    }

    const Collider& collider_;
    glm::vec3 p_;
    float side_;
    float sign_;
    int left_ = NearestSearch::kEvaluationsMax - 1;
    SurfaceSample best_;
    bool settled_ = false;  // a plane confirmed that no point of its surface is nearer
};

/// Renormalizes: normals of float maps may deviate slightly from unit length.
glm::vec3 unit(const glm::vec3& normal) {
    const float size = length(normal);
    return size > 0.0F ? normal / size : normal;
}

/// Returns the result that follows from the vote at P.
SurfaceSample fromVote(const glm::vec3& p, const FieldSample& sample) {
    SurfaceSample plane{std::clamp(sample.distance, -kFarOutside, kFarOutside), p, sample.normal, sample.map};
    const glm::vec3 foot = p - plane.distance * unit(plane.normal);
    if (plane.distance < kFarOutside && isFinite(foot)) {
        plane.point = foot;
    }
    return plane;
}

bool canSearch(const Collider& collider, const glm::vec3& p) {
    const auto within = [](const glm::vec3& v) {
        return std::abs(v.x) <= NearestSearch::kReachMax && std::abs(v.y) <= NearestSearch::kReachMax &&
               std::abs(v.z) <= NearestSearch::kReachMax;
    };
    const Bounds& bounds = collider.bounds;
    return within(p) && within(bounds.min) && within(bounds.max) &&
           bounds.longestSide() >= NearestSearch::kReachMin;
}

}  // namespace

Bounds boxToSearch(const Collider& collider, const glm::vec3& p, float distance) {
    const float room = (1.0F + NearestSearch::kBeyond) * distance +
                       2.0F * NearestSearch::kBeyondMin * collider.bounds.longestSide();
    return {p - room, p + room};
}

SurfaceSample nearestSurface(const Collider& collider, const glm::vec3& p) {
    const FieldSample sample = evaluate(collider, p);
    if (sample.map < 0) {
        return {.point = p};
    }
    SurfaceSample nearest = fromVote(p, sample);
    if (canSearch(collider, p)) {
        const Search search(collider, p, sample);
        if (search.found()) {
            nearest = search.best();
            // A distance of 0 has no sign.
            nearest.distance = search.sign() * std::max(nearest.distance, NearestSearch::kDistanceMin);
        }
    }
    nearest.normal = unit(nearest.normal);
    return nearest;
}

}  // namespace relief

// SPDX-License-Identifier: Apache-2.0
// A surface that gives birth, as an emitter sees it: runtime/births/emitter_surface.h.
#pragma once

#include <glm/vec3.hpp>
#include <memory>
#include <span>
#include <utility>

#include "formats/collider.h"
#include "runtime/particles/random.h"

namespace relief {

class BirthSurface {
  public:
    virtual ~BirthSurface() = default;
    [[nodiscard]] virtual std::unique_ptr<BirthSurface> clone() const = 0;

    /// Its vertices now, and `seconds` ago.
    /// \param before, now  object units, a place for each vertex; a place without numbers gives no birth.
    /// \param seconds      > 0; 0: it has jumped there, and `before` does not count.
    virtual void move(std::span<const glm::vec3> before, std::span<const glm::vec3> now, double seconds) = 0;
    /// Σ area · weight, now; 0: it cannot give birth.
    [[nodiscard]] virtual double area() const = 0;
    /// Of all its vertices now.
    [[nodiscard]] virtual Bounds bounds() const = 0;

    struct Place {
        glm::vec3 position{0.0F};
        glm::vec3 normal{0.0F};    ///< of its triangle, outwards, of length 1
        glm::vec3 velocity{0.0F};  ///< its own, object units a second
    };
    /// A place by area and weight. It needs an area(). Draws as many numbers each time.
    /// \param age  seconds ago, ≥ 0; what is beyond `seconds` counts as that.
    [[nodiscard]] virtual Place draw(Pcg32& random, float age) const = 0;
};

/// A surface as a value: its copy moves for itself.
class BirthSurfaceValue {
  public:
    BirthSurfaceValue() = default;
    explicit BirthSurfaceValue(std::unique_ptr<BirthSurface> surface) : surface_(std::move(surface)) {}
    BirthSurfaceValue(const BirthSurfaceValue& other) : surface_(other ? other->clone() : nullptr) {}
    BirthSurfaceValue(BirthSurfaceValue&&) = default;
    BirthSurfaceValue& operator=(BirthSurfaceValue other) {
        surface_ = std::move(other.surface_);
        return *this;
    }
    ~BirthSurfaceValue() = default;

    explicit operator bool() const { return surface_ != nullptr; }
    BirthSurface* operator->() const { return surface_.get(); }

  private:
    std::unique_ptr<BirthSurface> surface_;
};

}  // namespace relief

// SPDX-License-Identifier: Apache-2.0
// The interface of a surface that emits particles; implemented in runtime/births/emitter_surface.h.
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

    /// Sets the positions of the vertices now and `seconds` ago.
    /// \param before, now  object units, one position per vertex; triangles with a non-finite corner do not emit.
    /// \param seconds      ≥ 0; 0 after a jump: `before` is ignored.
    virtual void move(std::span<const glm::vec3> before, std::span<const glm::vec3> now, double seconds) = 0;
    /// Returns the current sum of area · weight (density of births) over the triangles; 0: the surface cannot emit.
    [[nodiscard]] virtual double area() const = 0;
    /// Returns the bounds of all current vertices.
    [[nodiscard]] virtual Bounds bounds() const = 0;

    struct Place {
        glm::vec3 position{0.0F};
        glm::vec3 normal{0.0F};    ///< of the triangle, outwards, unit length
        glm::vec3 velocity{0.0F};  ///< of the surface at this point, object units/s
    };
    /// Samples a point by area and weight. Requires area() > 0. Always consumes the same number of random numbers.
    /// \param age  seconds ago, ≥ 0; clamped to the `seconds` of move().
    [[nodiscard]] virtual Place draw(Pcg32& random, float age) const = 0;
};

/// A surface with value semantics: copies are deep.
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

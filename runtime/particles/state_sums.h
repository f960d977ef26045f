// The sums of Statistics by compute shaders: work groups that each sum 64 × 64 texels into one, two or three dispatches
// in all. The same numbers are added in the same order as by the ladder of fragment passes.
#pragma once

#include <cstdint>

#include "formats/base/result.h"
#include "runtime/gl/gl_object.h"
#include "runtime/particles/particle_system.h"

namespace relief {

class StateSums {
  public:
    static constexpr GLsizeiptr kBytes =
        8 * sizeof(float);  ///< of the result: shaders/reduce.glsl has its parts

    /// For systems of this capacity, where hasCompute(). Errors: kLimit, kFailure.
    [[nodiscard]] static Result<StateSums> create(std::uint32_t capacity);

    /// Sums the particles up into the first kBytes of a buffer, for the CPU to map. Needs extent() > 0. Leaves program and
    /// textures as they fall, storage units as they were.
    void sum(const ParticleSystem& particles, const GlBuffer& result) const;

  private:
    struct Program {
        GlProgram program;
        GLint size = -1, rate = -1, extent = -1;
    };
    [[nodiscard]] static Result<Program> makePart(const char* file);

    Program state_;
    Program sum_;
    GlBuffer parts_[2];  // in turns: a pass reads one and writes the other
};

}  // namespace relief

// SPDX-License-Identifier: Apache-2.0
// The GL state in which Relief's passes run, independent of the caller's state.
#pragma once

#include <memory>

namespace relief {

/// On construction, saves all GL state that Relief's passes change or depend on, and sets the state that they require:
/// draws write their shaders' outputs, and transfers are tightly packed. On destruction, restores everything. This
/// covers: current program and vertex array; array, pack, unpack and uniform buffer; uniform block bindings 0 and 1;
/// draw and read framebuffer; viewport and scissor box; active texture unit and, for the first kUnits units, 2-D
/// texture, 3-D texture and sampler object; blending, depth, cull, scissor and stencil test, dithering,
/// alpha-to-coverage, sample coverage, rasterizer discard, polygon offset and primitive restart (all off in a pass);
/// blend functions and equations, depth function and mask, colour mask, clear colour; pixel store alignments and
/// windows; on desktop GL also polygon mode, logic operation, program point size, point sprite origin, sRGB conversion.
class PassState {
  public:
    static constexpr int kUnits = 11;
    enum class Scope {
        kPass,
        /// Saves the state once and restores it at the end of the sequence, because queries are slow. Sets no state.
        /// Passes of this thread in a sequence set the state that they require, and restore nothing. A pass within a
        /// pass still restores the state of the outer pass.
        kSequence,
    };
    explicit PassState(Scope scope = Scope::kPass);
    ~PassState();
    PassState(const PassState&) = delete;
    PassState& operator=(const PassState&) = delete;

  private:
    struct Saved;
    Scope scope_;
    std::unique_ptr<Saved> saved_;  // null if a sequence restores the state
};

}  // namespace relief

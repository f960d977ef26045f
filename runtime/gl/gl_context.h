// SPDX-License-Identifier: Apache-2.0
// An OpenGL context without a window, through EGL: for the command-line tools and the tests. A program that
// has a context of its own does not need this.
#pragma once

#include <cstddef>
#include <memory>
#include <optional>
#include <string>

#include "formats/base/result.h"
#include "runtime/gl/gl_api.h"

namespace relief {

struct GlContextOptions {
    GlApi api = GlApi::kGl33Core;
    /// Index into EGL's devices: this device alone is tried. nullopt: Mesa's platform without a display server,
    /// EGL's devices and its default display in turn, until one gives a context.
    std::optional<std::size_t> device;
};

class GlContext {
  public:
    /// Creates a context of at least this version and makes it current on this thread: of one with compute shaders where
    /// there is one. Where EGL can, the context reports resets of the GPU (gl_fault.h).
    /// Errors: kUnsupported, with all attempts; also where a float texture cannot be rendered to, and
    /// without EGL's library. kUsage: there is no such device; with their number.
    [[nodiscard]] static Result<std::unique_ptr<GlContext>> create(const GlContextOptions& options);
    [[nodiscard]] static Result<std::unique_ptr<GlContext>> create(GlApi api = GlApi::kGl33Core);
    ~GlContext();
    GlContext(const GlContext&) = delete;
    GlContext& operator=(const GlContext&) = delete;

    /// Makes it current on this thread, where another context may have become so since.
    /// Errors: kUsage: it is current on another thread.
    [[nodiscard]] Result<void> makeCurrent();

    [[nodiscard]] GlApi api() const;
    /// "OpenGL 4.5 (Core Profile) Mesa 22.3.6, llvmpipe (…), surfaceless": for reports.
    [[nodiscard]] const std::string& description() const;
    /// True if the processor draws: slow, but it cannot hang.
    [[nodiscard]] bool software() const;

  private:
    GlContext();
    struct Impl;
    std::unique_ptr<Impl> impl_;
};

}  // namespace relief

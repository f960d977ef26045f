// SPDX-License-Identifier: Apache-2.0
// An OpenGL context without a window, through EGL, for the command-line tools and tests. Programs with their own
// context do not need it.
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
    /// Index into EGL's devices; only this device is tried. nullopt: tries Mesa's surfaceless platform, EGL's devices
    /// and its default display in turn until one provides a context.
    std::optional<std::size_t> device;
};

class GlContext {
  public:
    /// Creates a context of at least the version of `api` and makes it current on this thread. Prefers a version with
    /// compute shaders. If EGL supports it, the context reports GPU resets (gl_fault.h).
    /// Errors: kUnsupported, listing all attempts; also if float textures are not renderable or EGL's library is
    /// missing. kUsage if the device does not exist; the message contains the number of devices.
    [[nodiscard]] static Result<std::unique_ptr<GlContext>> create(const GlContextOptions& options);
    [[nodiscard]] static Result<std::unique_ptr<GlContext>> create(GlApi api = GlApi::kGl33Core);
    ~GlContext();

    /// Makes the context current on this thread again.
    /// Errors: kUsage if it is current on another thread.
    [[nodiscard]] Result<void> makeCurrent();

    [[nodiscard]] GlApi api() const;
    /// Returns text for reports, such as "OpenGL 4.5 (Core Profile) Mesa 22.3.6, llvmpipe (…), surfaceless".
    [[nodiscard]] const std::string& description() const;
    /// Returns true if the context renders on the CPU: slow, but it cannot hang.
    [[nodiscard]] bool software() const;

  private:
    GlContext();
    struct Impl;
    std::unique_ptr<Impl> impl_;
};

}  // namespace relief

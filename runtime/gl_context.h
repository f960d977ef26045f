// An OpenGL context without a window, through EGL: for the command-line tools and the tests. A program that
// has a context of its own does not need this.
#pragma once

#include <memory>
#include <string>

#include "formats/result.h"

namespace relief {

enum class GlApi { kGl33Core, kGles30 };

class GlContext {
  public:
    /// Creates a context of at least this version and makes it current on this thread. Tries EGL's
    /// surfaceless platform, then the default display.
    /// Errors: kUnsupported, saying what was tried; also where a float texture cannot be rendered to.
    [[nodiscard]] static Result<std::unique_ptr<GlContext>> create(GlApi api = GlApi::kGl33Core);
    ~GlContext();
    GlContext(const GlContext&) = delete;
    GlContext& operator=(const GlContext&) = delete;

    [[nodiscard]] GlApi api() const;
    /// "OpenGL 4.5 (Core Profile) Mesa 22.3.6, llvmpipe (…), surfaceless": for reports.
    [[nodiscard]] const std::string& description() const;

  private:
    GlContext();
    struct Impl;
    std::unique_ptr<Impl> impl_;
};

}  // namespace relief

// The least that tracing six orthographic ends can cost: rtcIntersect16 over the rays, and nothing else.
#pragma once

#include <cstdint>
#include <memory>
#include <span>

#include "bake/mesh/mesh.h"
#include "bake/plan/view.h"

namespace relief {

class BareLoop {
  public:
    explicit BareLoop(const TriangleMesh& mesh);
    BareLoop(const BareLoop&) = delete;
    BareLoop& operator=(const BareLoop&) = delete;
    ~BareLoop();

    /// Milliseconds that building the tree took.
    [[nodiscard]] double buildMs() const { return build_ms_; }
    /// Traces both ends of every view.
    /// \return the number of rays that hit.
    [[nodiscard]] std::uint64_t trace(std::span<const View> views) const;

  private:
    struct Impl;
    std::unique_ptr<Impl> impl_;
    double build_ms_ = 0.0;
};

}  // namespace relief

// A view and a mesh make samples: which triangle each texel's ray meets, and at what depth. By Embree.
#pragma once

#include <cstdint>
#include <memory>
#include <span>

#include "bake/mesh/prepared_mesh.h"
#include "bake/plan/view.h"
#include "formats/base/result.h"

namespace relief {

/// What the ray of one texel meets first, from the end it starts at.
class Hit {
  public:
    Hit() = default;
    /// \param depth  map depth, in [0, 1] or [0, kCubeDepthMax]
    /// \param from_behind  the ray met the side from which the triangle's corners run clockwise.
    Hit(float depth, std::uint32_t triangle, bool from_behind)
        : depth_(depth), code_(triangle << 1 | (from_behind ? 1U : 0U)) {}

    [[nodiscard]] bool empty() const { return code_ == kNothing; }
    [[nodiscard]] float depth() const { return depth_; }
    [[nodiscard]] std::uint32_t triangle() const { return code_ >> 1; }
    [[nodiscard]] bool fromBehind() const { return (code_ & 1U) != 0; }

  private:
    static constexpr std::uint32_t kNothing = 0xffffffff;  // no triangle: kTriangleMax is far below 2^31

    float depth_ = 0.0F;
    std::uint32_t code_ = kNothing;
};

/// Rows of one face of a view, in the order of a map's texels.
struct RowRange {
    std::uint32_t face = 0;
    std::uint32_t begin = 0;
    std::uint32_t end = 0;  ///< one behind the last
};

/// Traces any number of views of a mesh, from any thread.
class RayScene {
  public:
    /// Shares the mesh's tree. Errors: those of EmbreeMesh::build.
    [[nodiscard]] static Result<RayScene> build(PreparedMesh mesh);

    [[nodiscard]] const TriangleMesh& mesh() const { return *mesh_; }
    /// orientation() of the mesh.
    [[nodiscard]] double winding() const { return winding_; }

    /// Traces one ray a texel for one end of a view, on all cores of the current arena.
    ///
    /// Embree decides which triangle is met; the depth is that of the triangle's plane in double precision. A
    /// ray that meets an edge takes, of the triangles that share it, one that faces it, of those the one that
    /// faces it most, and of equals the one of the lowest index: results depend neither on the number of
    /// threads nor on the order in which the structure was built.
    /// \param hits  (end − begin) · width, row by row.
    void trace(const View& view, RayEnd end, const RowRange& rows, std::span<Hit> hits) const;
    /// The same on the calling thread alone.
    void traceRows(const View& view, RayEnd end, const RowRange& rows, std::span<Hit> hits) const;

  private:
    friend class RayProbe;
    class Tracer;
    RayScene(PreparedMesh mesh, const EmbreeMesh& tree)
        : mesh_(std::move(mesh)),
          tree_(&tree),
          winding_(mesh_.orientation()),
          closed_(mesh_.closed()) {}

    PreparedMesh mesh_;
    const EmbreeMesh* tree_;  // mesh_ holds it
    double winding_;
    bool closed_;
};

/// Single rays of one end of a view, for a look between the texels of another. Not thread-safe.
class RayProbe {
  public:
    /// \param scene, view  borrowed; must outlive the probe.
    RayProbe(const RayScene& scene, const View& view, RayEnd end);
    ~RayProbe();
    [[nodiscard]] Hit trace(std::uint32_t face, std::uint32_t x, std::uint32_t y);

  private:
    struct Impl;
    std::unique_ptr<Impl> impl_;
};

}  // namespace relief

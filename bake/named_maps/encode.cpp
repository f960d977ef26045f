// SPDX-License-Identifier: Apache-2.0
#include "bake/named_maps/encode.h"

#include <tbb/parallel_for.h>

#include <optional>

#include "formats/texel.h"

namespace relief {
namespace {

glm::vec3 outwardNormal(const TriangleMesh& mesh, std::uint32_t triangle, bool from_behind) {
    const glm::vec3 normal = unitNormal(mesh, triangle);
    return (from_behind ? -normal : normal) + 0.0F;  // + 0: no −0 in the output
}

/// Converts the hits of one end to surfaces.
class SurfaceEncoder {
  public:
    SurfaceEncoder(const RayScene& scene, const NormalTable& normals, const View& view, RayEnd end)
        : mesh_(scene.mesh()),
          inside_out_(scene.winding() < 0.0),
          normals_(normals),
          float_normals_(view.format == MapFormat::kFloat32),
          starts_free_(view.startsFree(end)),
          may_start_inside_(centreMayBeInSolid(scene, view, end)) {}

    std::optional<IndexedSurface> encode(const Hit& hit) {
        if (hit.empty()) {
            return std::nullopt;
        }
        const bool from_behind = hit.fromBehind();
        if (!starts_free_ && from_behind != inside_out_) {
            return std::nullopt;
        }
        if (hit.triangle() != triangle_ || from_behind != from_behind_) {
            triangle_ = hit.triangle();
            from_behind_ = from_behind;
            if (float_normals_) {
                normal_ = outwardNormal(mesh_, triangle_, from_behind);
            } else {
                index_ = normals_.index(triangle_, from_behind);
            }
        }
        const bool started_inside = may_start_inside_ && from_behind != inside_out_;
        return IndexedSurface{{started_inside ? 0.0F : hit.depth(), normal_}, index_};
    }

  private:
    const TriangleMesh& mesh_;
    bool inside_out_;
    const NormalTable& normals_;
    bool float_normals_;
    bool starts_free_;
    bool may_start_inside_;
    std::uint32_t triangle_ = 0xffffffff;  // none yet
    bool from_behind_ = false;
    glm::vec3 normal_{0.0F};  // only for float maps
    NormalIndex index_;       // only for other formats
};

}  // namespace

NormalTable::NormalTable(const TriangleMesh& mesh, double winding, std::uint64_t texels)
    : mesh_(mesh), from_behind_(winding < 0.0) {
    if (texels < mesh.triangles.size()) {
        return;
    }
    table_.resize(mesh.triangles.size());
    tbb::parallel_for(std::size_t{0}, table_.size(), [&](std::size_t i) {
        table_[i] = encodeNormal(outwardNormal(mesh, static_cast<std::uint32_t>(i), from_behind_));
    });
}

NormalIndex NormalTable::index(std::uint32_t triangle, bool from_behind) const {
    return table_.empty() || from_behind != from_behind_
               ? encodeNormal(outwardNormal(mesh_, triangle, from_behind))
               : table_[triangle];
}

std::uint64_t encodeRows(const RayScene& scene, const NormalTable& normals, const View& view,
                         const RowRange& rows, std::span<const Hit> near_hits, std::span<const Hit> far_hits,
                         DepthMap& map) {
    SurfaceEncoder near_encoder(scene, normals, view, RayEnd::kNear);
    SurfaceEncoder far_encoder(scene, normals, view, RayEnd::kFar);
    // A map of only the far end stores it as its single surface.
    const bool only_far = view.compare == Compare::kGreater;
    std::uint64_t covered = 0;
    for (std::uint32_t y = rows.begin; y != rows.end; ++y) {
        const std::size_t row = std::size_t{y - rows.begin} * view.width;
        for (std::uint32_t x = 0; x < view.width; ++x) {
            const std::optional<IndexedSurface> near_surface =
                near_hits.empty() ? std::nullopt : near_encoder.encode(near_hits[row + x]);
            const std::optional<IndexedSurface> far_surface =
                far_hits.empty() ? std::nullopt : far_encoder.encode(far_hits[row + x]);
            if (!near_surface && !far_surface && map.format != MapFormat::kFloat32) {
                continue;  // the bytes are already zero
            }
            encodeTexel(map.format, only_far ? far_surface : near_surface, far_surface,
                        map.texelAt(rows.face, x, y));
            covered += near_surface || far_surface ? 1 : 0;
        }
    }
    return covered;
}

}  // namespace relief

#include "bake/texels/encode.h"

#include <tbb/parallel_for.h>

#include <cmath>
#include <cstring>
#include <optional>

#include "bake/mesh/triangle_plane.h"

namespace relief {
namespace {

/// The unit normal of the side that a ray met.
glm::vec3 outwardNormal(const TriangleMesh& mesh, std::uint32_t triangle, bool from_behind) {
    const glm::dvec3 n = planeOf(mesh, triangle).normal;
    const glm::vec3 unit = n / std::sqrt(dot(n, n));
    return (from_behind ? -unit : unit) + 0.0F;  // + 0: no −0 in the output
}

/// One end of one texel, ready to be written.
struct EncodedSurface {
    float depth;
    glm::vec3 normal;
    NormalIndex index;
};

void writeBytes(std::span<std::byte> texel, const void* values, std::size_t size) {
    std::memcpy(texel.data(), values, size);
}

/// As encodeTexel of texel.h, with the normal's index at hand.
void writeTexel(MapFormat format, const std::optional<EncodedSurface>& front,
                const std::optional<EncodedSurface>& back, std::span<std::byte> texel) {
    switch (format) {
        case MapFormat::kFloat32: {
            const float values[4] = {front ? front->normal.x : 0.0F, front ? front->normal.y : 0.0F,
                                     front ? front->normal.z : 0.0F, front ? front->depth : -1.0F};
            writeBytes(texel, values, sizeof(values));
            return;
        }
        case MapFormat::kFixed8:
        case MapFormat::kCube8: {
            std::uint8_t values[4] = {0, 0, 0, 0};
            if (front) {
                const std::uint16_t depth =
                    encodeFixedDepth(front->depth, format == MapFormat::kCube8 ? kCubeDepthMax : 1.0F);
                values[0] = front->index.s;
                values[1] = front->index.t;
                values[2] = static_cast<std::uint8_t>(depth >> 8);
                values[3] = static_cast<std::uint8_t>(depth & 0xff);
            }
            writeBytes(texel, values, sizeof(values));
            return;
        }
        case MapFormat::kFrontBackHalf:
        case MapFormat::kFrontBackFixed: {
            std::uint16_t values[4] = {0, 0, 0, 0};
            for (int end = 0; end < 2; ++end) {
                if (const std::optional<EncodedSurface>& surface = end == 0 ? front : back) {
                    values[end] = packNormal(surface->index);
                    values[2 + end] = format == MapFormat::kFrontBackHalf
                                          ? encodeHalfDepth(surface->depth)
                                          : encodeFixedDepth(surface->depth, 1.0F);
                }
            }
            writeBytes(texel, values, sizeof(values));
            return;
        }
    }
}

/// Turns the hits of one end into surfaces.
class SurfaceEncoder {
  public:
    SurfaceEncoder(const RayScene& scene, const NormalTable& normals, const View& view, RayEnd end)
        : mesh_(scene.mesh()),
          inside_out_(scene.winding() < 0.0),
          normals_(normals),
          float_normals_(view.format == MapFormat::kFloat32),
          starts_free_(view.starts_free[static_cast<std::size_t>(end)]),
          may_start_inside_(mayStartInside(scene, view, end)) {}

    std::optional<EncodedSurface> encode(const Hit& hit) {
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
        return EncodedSurface{started_inside ? 0.0F : hit.depth(), normal_, index_};
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
    NormalIndex index_;       // only for the others
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
    // A map that keeps the far end alone holds it as its one surface.
    const bool only_far = view.compare == Compare::kGreater;
    std::uint64_t covered = 0;
    for (std::uint32_t y = rows.begin; y != rows.end; ++y) {
        const std::size_t row = std::size_t{y - rows.begin} * view.width;
        for (std::uint32_t x = 0; x < view.width; ++x) {
            const std::optional<EncodedSurface> near_surface =
                near_hits.empty() ? std::nullopt : near_encoder.encode(near_hits[row + x]);
            const std::optional<EncodedSurface> far_surface =
                far_hits.empty() ? std::nullopt : far_encoder.encode(far_hits[row + x]);
            if (!near_surface && !far_surface && map.format != MapFormat::kFloat32) {
                continue;  // the map's bytes are zero already
            }
            writeTexel(map.format, only_far ? far_surface : near_surface, far_surface,
                       map.texelAt(rows.face, x, y));
            covered += near_surface || far_surface ? 1 : 0;
        }
    }
    return covered;
}

}  // namespace relief

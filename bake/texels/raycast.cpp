#include "bake/texels/raycast.h"

#include <embree3/rtcore.h>
#include <tbb/parallel_for.h>

#include <algorithm>
#include <limits>

#include "bake/mesh/embree_mesh.h"
#include "bake/texels/ray_probe.h"

namespace relief {
namespace {

constexpr std::uint32_t kTile = 4;  // a packet is 4×4 texels
constexpr int kLanes = 16;
/// A ray this much deeper, in map depth, than those beside it may have slipped through.
constexpr float kDepthJump = 0.08F;

/// A hit this near to an edge, in barycentric coordinates, may as well be the neighbour's.
constexpr float kEdgeWidth = 1e-4F;

/// Traces the packets of one row of tiles of a cube.
class TileTracer {
  public:
    TileTracer(const RayScene& scene, const View& view, RayEnd end)
        : mesh_(scene.mesh()), tree_(scene.tree()), view_(view), end_(end), probe_(scene, view, end) {
        rtcInitIntersectContext(&context_);
        context_.flags = RTC_INTERSECT_CONTEXT_FLAG_COHERENT;
        for (int lane = 0; lane < kLanes; ++lane) {
            packet_.ray.mask[lane] = 0xffffffff;
            packet_.hit.instID[0][lane] = RTC_INVALID_GEOMETRY_ID;
        }
    }

    /// \param hits  rows of the view from y0 on.
    void traceTileRow(std::uint32_t face, std::uint32_t y0, std::uint32_t y_end, Hit* hits) {
        const std::uint32_t rows = std::min(kTile, y_end - y0);
        for (std::uint32_t x0 = 0; x0 < view_.width; x0 += kTile) {
            const std::uint32_t columns = std::min(kTile, view_.width - x0);
            setValid(columns, rows);
            setRays(face, x0, y0);
            rtcIntersect16(valid_, tree_.scene.get(), &context_, &packet_);
            prefetchCorners();
            // What mendPinholes goes by: most tiles need no second look.
            float low = std::numeric_limits<float>::max();
            float high = -low;
            std::uint32_t outer = 0;
            for (std::uint32_t row = 0; row < rows; ++row) {
                Hit* const out = hits + std::size_t{row} * view_.width + x0;
                for (std::uint32_t column = 0; column < columns; ++column) {
                    const std::size_t lane = row * kTile + column;
                    if (packet_.hit.geomID[lane] == RTC_INVALID_GEOMETRY_ID) {
                        out[column] = Hit();
                        continue;
                    }
                    const Hit hit = resolve(face, x0 + column, y0 + row, lane);
                    low = std::min(low, hit.depth());
                    high = std::max(high, hit.depth());
                    outer += probe_.metInside(hit) ? 0U : 1U;
                    out[column] = hit;
                }
            }
            if (outer != 0 && (outer != rows * columns || high - low >= kDepthJump)) {
                mendPinholes(face, x0, y0, columns, rows, hits);
            }
        }
    }

  private:
    static std::uint32_t columnOf(int lane) { return static_cast<std::uint32_t>(lane) % kTile; }
    static std::uint32_t rowOf(int lane) { return static_cast<std::uint32_t>(lane) / kTile; }

    /// Which lanes carry a ray: all but at the view's edges.
    void setValid(std::uint32_t columns, std::uint32_t rows) {
        if (columns != valid_columns_ || rows != valid_rows_) {
            valid_columns_ = columns;
            valid_rows_ = rows;
            for (int lane = 0; lane < kLanes; ++lane) {
                valid_[lane] = columnOf(lane) < columns && rowOf(lane) < rows ? -1 : 0;
            }
        }
    }

    /// Asks for the corners of all triangles met before the first of them is needed: half the time of
    /// resolving hits was waiting for them, one after the other. Inlined by force: GCC takes a function that
    /// only prefetches for one without effect, and leaves its calls out.
    [[gnu::always_inline]] void prefetchCorners() const {
        const glm::uvec3* const triangles = mesh_.triangles.data();
        const glm::vec3* const positions = mesh_.positions.data();
        for (int lane = 0; lane < kLanes; ++lane) {
            if (packet_.hit.geomID[lane] != RTC_INVALID_GEOMETRY_ID) {
                __builtin_prefetch(triangles + packet_.hit.primID[lane]);
            }
        }
        for (int lane = 0; lane < kLanes; ++lane) {
            if (packet_.hit.geomID[lane] != RTC_INVALID_GEOMETRY_ID) {
                const glm::uvec3& triangle = triangles[packet_.hit.primID[lane]];
                __builtin_prefetch(positions + triangle.x);
                __builtin_prefetch(positions + triangle.z);
            }
        }
    }

    void setRays(std::uint32_t face, std::uint32_t x0, std::uint32_t y0) {
        for (int lane = 0; lane < kLanes; ++lane) {
            const RaySegment segment =
                probe_.segmentOf(view_.ray(face, x0 + columnOf(lane), y0 + rowOf(lane)));
            const glm::vec3 origin = tree_.toLocal(segment.origin);
            const glm::vec3 direction = segment.direction * tree_.scale;
            packet_.ray.org_x[lane] = origin.x;
            packet_.ray.org_y[lane] = origin.y;
            packet_.ray.org_z[lane] = origin.z;
            packet_.ray.dir_x[lane] = direction.x;
            packet_.ray.dir_y[lane] = direction.y;
            packet_.ray.dir_z[lane] = direction.z;
            packet_.ray.tfar[lane] = static_cast<float>(segment.length);
            packet_.hit.geomID[lane] = RTC_INVALID_GEOMETRY_ID;
        }
    }

    Hit resolve(std::uint32_t face, std::uint32_t x, std::uint32_t y, std::size_t lane) {
        std::uint32_t triangle = packet_.hit.primID[lane];
        const float u = packet_.hit.u[lane];
        const float v = packet_.hit.v[lane];
        if (std::min({u, v, 1.0F - u - v}) < kEdgeWidth) {
            triangle =
                probe_.bestAtEdge(probe_.segmentOf(view_.ray(face, x, y)), packet_.ray.tfar[lane], triangle);
        }
        return probe_.hitOf(face, x, y, triangle);
    }

    /// Looks again at the rays of a tile that met nothing, an inner side, or something far behind, although
    /// those beside them met an outer side. `hits` begins with the tile's first row.
    void mendPinholes(std::uint32_t face, std::uint32_t x0, std::uint32_t y0, std::uint32_t columns,
                      std::uint32_t rows, Hit* hits) {
        const auto at = [&](std::uint32_t column, std::uint32_t row) -> Hit& {
            return hits[std::size_t{row} * view_.width + x0 + column];
        };
        // All are judged by what was traced, not by what was mended before them.
        std::uint32_t doubtful = 0;
        for (std::uint32_t row = 0; row < rows; ++row) {
            for (std::uint32_t column = 0; column < columns; ++column) {
                const Hit& hit = at(column, row);
                std::uint32_t beside = 0;
                std::uint32_t before = 0;
                const auto compare = [&](const Hit& other) {
                    ++beside;
                    before += isBefore(other, hit) ? 1U : 0U;
                };
                if (column > 0) {
                    compare(at(column - 1, row));
                }
                if (column + 1 < columns) {
                    compare(at(column + 1, row));
                }
                if (row > 0) {
                    compare(at(column, row - 1));
                }
                if (row + 1 < rows) {
                    compare(at(column, row + 1));
                }
                if (before > 0 && before >= std::min(beside, 3U)) {
                    doubtful |= 1U << (row * kTile + column);
                }
            }
        }
        for (std::uint32_t lane = 0; doubtful != 0; ++lane, doubtful >>= 1U) {
            if ((doubtful & 1U) != 0) {
                Hit& hit = at(lane % kTile, lane / kTile);
                hit = probe_.lookAgain(face, x0 + lane % kTile, y0 + lane / kTile, hit);
            }
        }
    }

    /// A ray met an outer side, and one beside it got past.
    [[nodiscard]] bool isBefore(const Hit& hit, const Hit& beside) const {
        if (hit.empty() || probe_.metInside(hit)) {
            return false;
        }
        const float gap = end_ == RayEnd::kNear ? beside.depth() - hit.depth() : hit.depth() - beside.depth();
        return beside.empty() || probe_.metInside(beside) || gap > kDepthJump;
    }

    const TriangleMesh& mesh_;
    const EmbreeMesh& tree_;
    const View& view_;
    RayEnd end_;
    RayProbe probe_;
    RTCIntersectContext context_{};
    std::uint32_t valid_columns_ = 0;
    std::uint32_t valid_rows_ = 0;
    alignas(64) int valid_[kLanes] = {};
    alignas(64) RTCRayHit16 packet_{};
};

}  // namespace

ViewTracer::ViewTracer(const RayScene& scene, const View& view) : scene_(scene), view_(view) {
    if (view.projection() == Projection::kOrthographic) {
        scan_.emplace(scene, view);
    }
}

void ViewTracer::trace(const RowRange& rows, std::span<Hit> near, std::span<Hit> far) const {
    // Blocks that begin where those of ScanConverter do.
    constexpr std::uint32_t kRows = ScanConverter::kBlockRows;
    tbb::parallel_for(rows.begin / kRows, (rows.end + kRows - 1) / kRows, [&](std::uint32_t block) {
        const RowRange part{rows.face, std::max(rows.begin, block * kRows),
                            std::min(rows.end, (block + 1) * kRows)};
        const std::size_t first = std::size_t{part.begin - rows.begin} * view_.width;
        const std::size_t count = std::size_t{part.end - part.begin} * view_.width;
        const auto of = [&](std::span<Hit> hits) { return hits.empty() ? hits : hits.subspan(first, count); };
        traceAlone(part, of(near), of(far));
    });
}

void ViewTracer::traceAlone(const RowRange& rows, std::span<Hit> near, std::span<Hit> far) const {
    if (scan_) {
        scan_->scanRows(rows, near, far);
        return;
    }
    for (const RayEnd end : {RayEnd::kNear, RayEnd::kFar}) {
        const std::span<Hit> hits = end == RayEnd::kNear ? near : far;
        if (hits.empty()) {
            continue;
        }
        TileTracer tracer(scene_, view_, end);
        for (std::uint32_t y = rows.begin; y < rows.end; y += kTile) {
            tracer.traceTileRow(rows.face, y, rows.end, &hits[std::size_t{y - rows.begin} * view_.width]);
        }
    }
}

}  // namespace relief

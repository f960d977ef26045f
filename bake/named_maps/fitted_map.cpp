// SPDX-License-Identifier: Apache-2.0
#include "bake/named_maps/fitted_map.h"

#include <tbb/blocked_range.h>
#include <tbb/enumerable_thread_specific.h>
#include <tbb/parallel_for.h>
#include <tbb/parallel_reduce.h>

#include <algorithm>
#include <array>
#include <functional>
#include <optional>

#include "bake/named_maps/deep_solid.h"
#include "bake/named_maps/fitted_end.h"
#include "bake/named_maps/plane_fit.h"
#include "bake/named_maps/ray_probe.h"
#include "bake/named_maps/scan_convert.h"
#include "formats/texel.h"

namespace relief {
namespace {

/// Approximate number of rows of rays per task, and maximum number of rays: few enough for their hits to stay in the
/// core's cache.
constexpr std::uint32_t kTaskRows = 32;
constexpr std::uint32_t kTaskRays = 1 << 18;
/// Steps between two rays of a footprint when locating the edge of a surface; odd.
constexpr std::uint32_t kEdgeParts = 63;

/// Provides View::ray(), from tables for orthographic views.
class RayGrid {
  public:
    explicit RayGrid(const View& view) : view_(view) {
        if (view.projection() != Projection::kOrthographic) {
            return;
        }
        for (std::uint32_t x = 0; x < view.width; ++x) {
            columns_.push_back(view.columnOffset(x));
        }
        for (std::uint32_t y = 0; y < view.height; ++y) {
            rows_.push_back(view.rowOffset(y));
        }
    }
    [[nodiscard]] const View& view() const { return view_; }
    [[nodiscard]] TexelRay at(std::uint32_t face, std::uint32_t x, std::uint32_t y) const {
        return columns_.empty() ? view_.ray(face, x, y)
                                : TexelRay{view_.origin + (columns_[x] + rows_[y]), view_.axis[2]};
    }

  private:
    const View& view_;
    std::vector<glm::dvec3> columns_;
    std::vector<glm::dvec3> rows_;
};

/// Fits the texels of one end, from the hits of a view with `samples` times as many texels along each side.
class EndFitter {
  public:
    EndFitter(const RayScene& scene, const DepthMap& map, const std::vector<glm::dvec3>& normals,
              const View& view, const RayGrid& fine_rays, const View& finest, RayEnd end,
              const FittedMapOptions& options)
        : normals_(normals),
          deep_(scene, map),
          finest_(finest),
          probe_(scene, finest, end),
          view_(view),
          fine_(fine_rays.view()),
          fine_rays_(fine_rays),
          end_(view, end),
          samples_(options.samples),
          inside_out_(scene.insideOut()),
          may_start_inside_(centreMayBeInSolid(scene, view, end)),
          starts_free_(view.startsFree(end)),
          shares_edges_(view.projection() == Projection::kOrthographic && starts_free_ &&
                        view.startsFree(otherEnd(end)) && !may_start_inside_),
          fit_(fitOptions(view, options)) {
        fit_.cautious = options.cautious;
        fit_.rays_apart = 0.5 / samples_;
        fit_.starts_free = starts_free_;
        rays_.resize(std::size_t{samples_} * samples_);
    }

    /// \param hits   of the fine view, starting at row `first_row` of the face; includes the rows next to the texel
    /// \param other  the fitter of the other end, if it has already fitted this texel
    std::optional<Surface> fit(std::uint32_t face, std::uint32_t x, std::uint32_t y, std::uint32_t first_row,
                               std::span<const Hit> hits, const EndFitter* other = nullptr) {
        const Footprint here{face, x, y, first_row, hits};
        found_.clear();
        edge_.clear();
        prefetch(here);
        const auto [any, all] = hitsOf(here);
        if (!any) {
            return std::nullopt;
        }
        for (std::uint32_t j = 0; j < samples_; ++j) {
            const std::uint32_t row = y * samples_ + j;
            for (std::uint32_t i = 0; i < samples_; ++i) {
                const std::uint32_t column = x * samples_ + i;
                const Hit& hit = hits[indexOf(here, column, row)];
                if (!hit.empty() && startsInside(hit)) {  // the ray is not free up to this surface
                    return may_start_inside_ ? std::optional(allInside(face, x, y)) : std::nullopt;
                }
                rays_[std::size_t{j} * samples_ + i] = rayAt(here, column, row);
            }
        }
        if (!all && other != nullptr && shares_edges_) {
            for (const EdgeRay& edge : other->found_) {
                addEdge(face, edge, probe_.trace(face, edge.x, edge.y));
            }
        } else if (!all) {
            findEdge(here);
        }
        const TexelRay centre = view_.ray(face, x, y);
        deep_.setTexel((std::size_t{face} * view_.height + y) * view_.width + x);
        // A single ray already hits the best plane, so deep_ must not reject it: the fallback, a plane that faces the
        // viewer, would cut more off a slope.
        const std::optional<FittedPlane> plane = fitSupportingPlane(
            rays_, [&] { return probeAround(here); }, edge_, end_.fromViewer(centre), centre.origin, fit_,
            samples_ > 1 || !starts_free_ || may_start_inside_ ? &deep_ : nullptr);
        return plane ? std::optional(end_.surfaceOf(*plane, view_.format)) : std::nullopt;
    }

  private:
    /// A texel, and the hits of the fine view from row `first_row` of its face on.
    struct Footprint {
        std::uint32_t face;
        std::uint32_t x;
        std::uint32_t y;
        std::uint32_t first_row;
        std::span<const Hit> hits;
    };

    /// Prefetches the normals of a later texel, which are scattered in memory.
    void prefetch(const Footprint& here) const {
        constexpr std::uint32_t kAhead = 2;
        const std::uint32_t column = (here.x + kAhead) * samples_;
        for (std::uint32_t j = 0; column < fine_.width && j < samples_; ++j) {
            const Hit& hit = here.hits[indexOf(here, column, here.y * samples_ + j)];
            if (!hit.empty()) {
                __builtin_prefetch(&normals_[hit.triangle()]);
            }
        }
    }

    [[nodiscard]] FootprintRay footprintRay(const TexelRay& along, const Hit& hit) const {
        FootprintRay ray = end_.fromViewer(along);
        if (!hit.empty()) {
            ray.u = end_.uOf(hit.depth());
            const glm::dvec3& normal = normals_[hit.triangle()];
            ray.normal = hit.fromBehind() ? -normal : normal;
        }
        return ray;
    }

    [[nodiscard]] FootprintRay rayAt(const Footprint& here, std::uint32_t column, std::uint32_t row) const {
        return footprintRay(fine_rays_.at(here.face, column, row), here.hits[indexOf(here, column, row)]);
    }

    /// Whether the ray of a hit started in the solid.
    [[nodiscard]] bool startsInside(const Hit& hit) const {
        return (!starts_free_ || may_start_inside_) && hit.fromBehind() != inside_out_;
    }

    /// Returns a plane through the centre, for a texel of a cube whose rays start in the solid.
    [[nodiscard]] Surface allInside(std::uint32_t face, std::uint32_t x, std::uint32_t y) const {
        const glm::dvec3 direction = view_.ray(face, x, y).direction;
        return {0.0F, glm::vec3(direction / -length(direction))};
    }

    [[nodiscard]] std::size_t indexOf(const Footprint& here, std::uint32_t column, std::uint32_t row) const {
        return std::size_t{row - here.first_row} * fine_.width + column;
    }

    /// Calls visit(column, row) for the rays of a footprint and the surrounding ring, within the face.
    template <class Visit>
    void forEachAround(const Footprint& here, const Visit& visit) const {
        const auto bounds = [&](std::uint32_t texel, std::uint32_t size) {
            const std::uint32_t first = texel * samples_;
            return std::pair{first - (first > 0 ? 1U : 0U), std::min(first + samples_ + 1, size)};
        };
        const auto [row_begin, row_end] = bounds(here.y, fine_.height);
        const auto [column_begin, column_end] = bounds(here.x, fine_.width);
        for (std::uint32_t row = row_begin; row < row_end; ++row) {
            for (std::uint32_t column = column_begin; column < column_end; ++column) {
                visit(column, row);
            }
        }
    }

    [[nodiscard]] bool isOwn(const Footprint& here, std::uint32_t column, std::uint32_t row) const {
        return row / samples_ == here.y && column / samples_ == here.x;
    }

    /// Whether any ray, and whether every ray, of a footprint and the surrounding ring hits a surface.
    [[nodiscard]] std::pair<bool, bool> hitsOf(const Footprint& here) const {
        bool any = false;
        bool all = true;
        forEachAround(here, [&](std::uint32_t column, std::uint32_t row) {
            const bool meets = !here.hits[indexOf(here, column, row)].empty();
            any = any || meets;
            all = all && meets;
        });
        return {any, all};
    }

    std::span<const FootprintRay> probeAround(const Footprint& here) {
        around_.clear();
        forEachAround(here, [&](std::uint32_t column, std::uint32_t row) {
            const Hit& hit = here.hits[indexOf(here, column, row)];
            if (!isOwn(here, column, row) && !hit.empty() && !startsInside(hit)) {
                around_.push_back(rayAt(here, column, row));
            }
        });
        return around_;
    }

    /// Finds the edges of surfaces in the texel. The edge between two neighbouring rays of which only one hits is the last
    /// ray with a hit. One of the two rays may belong to the ring, for walls up to an eighth of a texel inside the border.
    void findEdge(const Footprint& here) {
        forEachAround(here, [&](std::uint32_t column, std::uint32_t row) {
            for (const auto& [right, up] : {std::pair{1U, 0U}, std::pair{0U, 1U}}) {
                const bool on_face = column + right < fine_.width && row + up < fine_.height;
                if (on_face && (isOwn(here, column, row) || isOwn(here, column + right, row + up))) {
                    findEdgeBetween(here, column, row, right, up);
                }
            }
        });
    }

    /// The last ray of the finest grid with a hit.
    struct EdgeRay {
        std::uint32_t x;
        std::uint32_t y;
    };

    void addEdge(std::uint32_t face, const EdgeRay& edge, const Hit& hit) {
        if (!hit.empty()) {
            edge_.push_back(footprintRay(finest_.ray(face, edge.x, edge.y), hit));
        }
    }

    void findEdgeBetween(const Footprint& here, std::uint32_t column, std::uint32_t row, std::uint32_t right,
                         std::uint32_t up) {
        const bool meets = !here.hits[indexOf(here, column, row)].empty();
        if (meets == !here.hits[indexOf(here, column + right, row + up)].empty()) {
            return;
        }
        // In the finest grid. An odd number of parts puts one at the centre of each sample.
        std::uint32_t on[2] = {column * kEdgeParts + kEdgeParts / 2, row * kEdgeParts + kEdgeParts / 2};
        std::uint32_t off[2] = {on[0] + right * kEdgeParts, on[1] + up * kEdgeParts};
        if (!meets) {
            std::swap(on, off);
        }
        Hit last = probe_.trace(here.face, on[0], on[1]);
        if (last.empty() || startsInside(last)) {
            return;
        }
        while (on[0] + 1 < off[0] || off[0] + 1 < on[0] || on[1] + 1 < off[1] || off[1] + 1 < on[1]) {
            const std::uint32_t middle[2] = {(on[0] + off[0]) / 2, (on[1] + off[1]) / 2};
            const Hit hit = probe_.trace(here.face, middle[0], middle[1]);
            std::copy_n(middle, 2, hit.empty() ? off : on);
            last = hit.empty() ? last : hit;
        }
        if (isOwn(here, on[0] / kEdgeParts, on[1] / kEdgeParts) && !startsInside(last)) {
            found_.push_back({on[0], on[1]});
            addEdge(here.face, found_.back(), last);
        }
    }

    const std::vector<glm::dvec3>& normals_;
    DeepSolid deep_;
    const View& finest_;
    RayProbe probe_;
    const View& view_;
    const View& fine_;
    const RayGrid& fine_rays_;
    EndView end_;
    std::uint32_t samples_;
    bool inside_out_;
    bool may_start_inside_;
    bool starts_free_;
    bool shares_edges_;  // all rays of both ends start in free space, so both ends hit the same edges
    PlaneFitOptions fit_;
    std::vector<FootprintRay> rays_;
    std::vector<FootprintRay> around_;
    std::vector<EdgeRay> found_;  // by findEdge() for the current texel
    std::vector<FootprintRay> edge_;
};

/// Fits all texels of a map, a few rows per task.
class MapFitter {
  public:
    MapFitter(const RayScene& scene, const std::vector<glm::dvec3>& normals, const View& view,
              const FittedMapOptions& options)
        : scene_(scene),
          normals_(normals),
          view_(view),
          fine_(view.scaled(options.samples)),
          fine_rays_(fine_),
          finest_(fine_.scaled(kEdgeParts)),
          options_(options),
          map_(view.emptyMap()),
          scan_(scene, fine_) {
        map_.decode = Decode::kPlane;
    }

    DepthMap run(std::uint64_t& covered, const std::function<void(std::uint32_t)>& rowsDone) {
        const std::uint32_t task_rows =
            std::max(1U, std::min(kTaskRows, kTaskRays / fine_.width) / options_.samples);
        const std::uint32_t tasks_per_face = (view_.height + task_rows - 1) / task_rows;
        tbb::enumerable_thread_specific<Worker> workers([&] { return Worker(*this); });
        covered = tbb::parallel_reduce(
            tbb::blocked_range<std::uint32_t>(0, view_.faceCount() * tasks_per_face), std::uint64_t{0},
            [&](const auto& tasks, std::uint64_t count) {
                Worker& worker = workers.local();
                for (std::uint32_t task = tasks.begin(); task != tasks.end(); ++task) {
                    const std::uint32_t begin = task % tasks_per_face * task_rows;
                    const RowRange rows{task / tasks_per_face, begin,
                                        std::min(begin + task_rows, view_.height)};
                    count += fitRows(rows, worker);
                    rowsDone(rows.end - rows.begin);
                }
                return count;
            },
            std::plus<>());
        return std::move(map_);
    }

  private:
    /// Per-thread buffers.
    struct Worker {
        explicit Worker(const MapFitter& map)
            : near_fitter(map.fitter(RayEnd::kNear)), far_fitter(map.fitter(RayEnd::kFar)) {}
        EndFitter near_fitter;
        EndFitter far_fitter;
        std::array<std::vector<Hit>, 2> hits;  // by RayEnd
        std::vector<std::uint8_t> busy;        // by column of texels: a ray in or beside the column has a hit
    };
    [[nodiscard]] EndFitter fitter(RayEnd end) const {
        return {scene_, map_, normals_, view_, fine_rays_, finest_, end, options_};
    }

    /// Marks the columns with hits: most texels between distant parts are empty.
    void findBusy(Worker& worker) const {
        worker.busy.assign(view_.width, 0);
        for (const std::vector<Hit>& hits : worker.hits) {
            for (std::size_t row = 0; row < hits.size(); row += fine_.width) {
                const Hit* hit = hits.data() + row;
                for (std::uint32_t x = 0; x < view_.width; ++x) {
                    bool meets = false;
                    for (std::uint32_t i = 0; i < options_.samples; ++i) {
                        meets = meets || !hit[i].empty();
                    }
                    hit += options_.samples;
                    if (meets) {
                        worker.busy[x] = worker.busy[x > 0 ? x - 1 : 0] = 1;
                        worker.busy[std::min(x + 1, view_.width - 1)] = 1;
                    }
                }
            }
        }
    }

    /// \return the number of texels with a surface.
    std::uint64_t fitRows(const RowRange& rows, Worker& worker) {
        // One more row on each side, for the rings around the texels.
        const RowRange rays{rows.face, rows.begin * options_.samples - (rows.begin > 0 ? 1 : 0),
                            std::min(rows.end * options_.samples + 1, fine_.height)};
        for (const RayEnd end : {RayEnd::kNear, RayEnd::kFar}) {
            if (view_.keeps(end)) {
                worker.hits[static_cast<std::size_t>(end)].resize(std::size_t{rays.end - rays.begin} *
                                                                  fine_.width);
            }
        }
        const auto& [near_hits, far_hits] = worker.hits;
        scan_.scan(rays, worker.hits[0], worker.hits[1]);
        findBusy(worker);
        std::uint64_t covered = 0;
        for (std::uint32_t y = rows.begin; y != rows.end; ++y) {
            for (std::uint32_t x = 0; x < view_.width; ++x) {
                Texel texel;
                if (worker.busy[x] != 0 && !isBorder(view_, x, y)) {
                    if (view_.keeps(RayEnd::kNear)) {
                        texel.front = worker.near_fitter.fit(rows.face, x, y, rays.begin, near_hits);
                    }
                    if (view_.keeps(RayEnd::kFar)) {
                        texel.back =
                            worker.far_fitter.fit(rows.face, x, y, rays.begin, far_hits,
                                                  view_.keeps(RayEnd::kNear) ? &worker.near_fitter : nullptr);
                    }
                    if (view_.compare == Compare::kGreater) {
                        texel.front.swap(texel.back);  // a map of one surface stores it as the front
                    }
                }
                encodeTexel(map_.format, texel, map_.texelAt(rows.face, x, y));
                covered += texel.front || texel.back ? 1U : 0U;
            }
        }
        return covered;
    }

    const RayScene& scene_;
    const std::vector<glm::dvec3>& normals_;
    const View& view_;
    View fine_;  // one texel per ray of a footprint
    RayGrid fine_rays_;
    View finest_;  // one texel per step of an edge between two rays
    const FittedMapOptions& options_;
    DepthMap map_;
    ScanConverter scan_;  // of fine_
};

}  // namespace

std::vector<glm::dvec3> unitNormals(const TriangleMesh& mesh) {
    std::vector<glm::dvec3> normals(mesh.triangles.size());
    tbb::parallel_for(std::size_t{0}, normals.size(),
                      [&](std::size_t i) { normals[i] = unitNormal(mesh, static_cast<std::uint32_t>(i)); });
    return normals;
}

DepthMap bakeFittedMap(const RayScene& scene, const std::vector<glm::dvec3>& normals, const View& view,
                       const FittedMapOptions& options, std::uint64_t& covered,
                       const std::function<void(std::uint32_t)>& rowsDone) {
    return MapFitter(scene, normals, view, options).run(covered, rowsDone);
}

}  // namespace relief

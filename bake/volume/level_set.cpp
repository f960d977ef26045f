// SPDX-License-Identifier: Apache-2.0
#include "bake/volume/level_set.h"

#include <tbb/parallel_for.h>

#include <algorithm>
#include <atomic>
#include <cmath>
#include <functional>
#include <glm/vector_relational.hpp>
#include <new>
#include <numbers>
#include <string>

#include "formats/nearest_surface.h"
#include "formats/polygons/ply_bytes.h"
#include "runtime/vdb/vdb_writer.h"

namespace relief {
namespace {

constexpr int kBand = 3;    // voxels on each side
constexpr int kMargin = 4;  // voxels around the bounds, to contain the band

// Classes of voxels by their distance from the surface.
constexpr char kNone = 0;
constexpr char kNear = 1;
constexpr char kBeside = 2;

constexpr double kIndexMax = 0x1p30;  // maximum index of a voxel, from the origin
constexpr double kCellsMax = 0x1p31;

/// The voxels around a collider: their side, and whether they belong to the band.
class Voxels {
  public:
    /// \param box  the region they cover, plus a margin
    /// Errors: kLimit.
    static Result<Voxels> create(const Collider& collider, const Bounds& box, std::uint32_t along) {
        Voxels voxels(collider, double{collider.bounds.longestSide()} / along);
        double cells = 1.0;
        for (int i = 0; i < 3; ++i) {
            const double low = std::floor(double{box.min[i]} / voxels.size_) - kMargin;
            const double high = std::ceil(double{box.max[i]} / voxels.size_) + kMargin;
            if (!(std::abs(low) < kIndexMax && std::abs(high) < kIndexMax)) {
                return fail(ErrorCode::kLimit,
                            "it is too far from the origin for voxels this small; lower --voxels");
            }
            voxels.low_[i] = static_cast<int>(low);
            voxels.count_[i] = static_cast<int>(high - low) + 1;
            cells *= high - low + 1.0;
        }
        if (cells > kCellsMax) {
            return fail(ErrorCode::kLimit, "the box around its inside has too many voxels; lower --voxels");
        }
        voxels.inside_.resize(static_cast<std::size_t>(cells));
        voxels.band_.resize(voxels.inside_.size());
        voxels.forEach([&](const glm::ivec3& at, std::size_t cell) {
            voxels.inside_[cell] = evaluateInside(collider, voxels.place(at)).inside ? 1 : 0;
        });
        return voxels;
    }

    /// Whether the outermost voxels are outside, so that the surface is closed.
    [[nodiscard]] bool closed() const {
        std::atomic<bool> closed = true;
        forEach([&](const glm::ivec3& at, std::size_t cell) {
            const bool border =
                glm::any(glm::equal(at, glm::ivec3(0))) || glm::any(glm::equal(at + 1, count_));
            if (border && inside_[cell] != 0) {
                closed = false;
            }
        });
        return closed;
    }

    [[nodiscard]] bool anyInside() const {
        return std::find(inside_.begin(), inside_.end(), 1) != inside_.end();
    }
    [[nodiscard]] double size() const { return size_; }

    /// Finds the voxels within kBand voxels, along each axis, of a voxel on the other side.
    void findBand() {
        forEach([this](const glm::ivec3& at, std::size_t cell) {
            band_[cell] = besideTheOtherSide(at, inside_[cell]) ? kBeside : kNone;
        });
        for (int axis = 0; axis < 3; ++axis) {
            widen(axis);
        }
    }

    /// Estimates the fraction of the surface in parts thinner than a voxel, which contain no voxel centre. Counts the
    /// outside voxels that touch the surface but are not in the band, relative to all outside voxels that touch it.
    [[nodiscard]] double missing() const {
        std::atomic<std::size_t> missed = 0;
        std::atomic<std::size_t> seen = 0;
        forEach([&](const glm::ivec3& at, std::size_t cell) {
            if (inside_[cell] == 0 && band_[cell] == kBeside) {
                ++seen;
            } else if (inside_[cell] == 0 && band_[cell] == kNone && touchesSurface(place(at))) {
                ++missed;
            }
        });
        return static_cast<double>(missed) / (static_cast<double>(missed) + static_cast<double>(seen));
    }

    [[nodiscard]] NarrowBand band() const {
        NarrowBand all{size_, static_cast<float>(kBand * size_), {}, {}};
        std::vector<NarrowBand> slices(static_cast<std::size_t>(count_.z));
        forEach([&](const glm::ivec3& at, std::size_t cell) {
            if (band_[cell] == kNone) {
                return;
            }
            // The surface passes between neighbours on different sides, regardless of the distance.
            const float most = static_cast<float>(band_[cell] == kBeside ? size_ : kBand * size_);
            const SurfaceSample sample = nearestSurface(collider_, place(at));
            const float length = sample.map < 0 ? most : std::min(std::abs(sample.distance), most);
            if (length < all.background) {
                NarrowBand& slice = slices[static_cast<std::size_t>(at.z)];
                slice.at.push_back(low_ + at);
                slice.distance.push_back(inside_[cell] != 0 ? -length : length);
            }
        });
        for (const NarrowBand& slice : slices) {
            all.at.insert(all.at.end(), slice.at.begin(), slice.at.end());
            all.distance.insert(all.distance.end(), slice.distance.begin(), slice.distance.end());
        }
        return all;
    }

  private:
    Voxels(const Collider& collider, double size) : collider_(collider), size_(size) {}

    [[nodiscard]] std::size_t cellOf(const glm::ivec3& at) const {
        const auto wide = [](int value) { return static_cast<std::size_t>(value); };
        return (wide(at.z) * wide(count_.y) + wide(at.y)) * wide(count_.x) + wide(at.x);
    }
    [[nodiscard]] glm::vec3 place(const glm::ivec3& at) const { return size_ * glm::dvec3(low_ + at); }

    /// Calls use(at, cell) for the voxels of each slice of equal z in order, with slices in parallel.
    template <class Use>
    void forEach(Use use) const {
        tbb::parallel_for(0, count_.z, [&](int k) {
            std::size_t cell = cellOf({0, 0, k});
            for (int j = 0; j < count_.y; ++j) {
                for (int i = 0; i < count_.x; ++i) {
                    use(glm::ivec3(i, j, k), cell++);
                }
            }
        });
    }
    [[nodiscard]] bool besideTheOtherSide(const glm::ivec3& at, char here) const {
        for (int axis = 0; axis < 3; ++axis) {
            for (const int step : {-1, 1}) {
                glm::ivec3 other = at;
                other[axis] += step;
                if (other[axis] >= 0 && other[axis] < count_[axis] && inside_[cellOf(other)] != here) {
                    return true;
                }
            }
        }
        return false;
    }
    /// Widens the band by kBand − 1 voxels: voxels beside the other side are already in the band.
    void widen(int axis) {
        const std::vector<char> before = band_;
        forEach([&](const glm::ivec3& at, std::size_t cell) {
            for (int d = 1 - kBand; d < kBand && band_[cell] == kNone; ++d) {
                glm::ivec3 other = at;
                other[axis] += d;
                const bool there = other[axis] >= 0 && other[axis] < count_[axis];
                band_[cell] = there && before[cellOf(other)] != kNone ? kNear : kNone;
            }
        });
    }
    /// Whether a surface with an inside behind it passes through the ball around a voxel.
    /// \param p  the centre of the voxel, which is outside.
    [[nodiscard]] bool touchesSurface(const glm::vec3& p) const {
        const auto reach = static_cast<float>(0.5 * std::numbers::sqrt3 * size_);
        const FieldSample vote = evaluate(collider_, p);  // most voxels are far, and their votes are cheap
        if (vote.map < 0 || vote.distance > reach) {
            return false;
        }
        const SurfaceSample near = nearestSurface(collider_, p);
        if (near.map < 0 || near.distance > reach) {
            return false;
        }
        for (float depth = static_cast<float>(size_) / 16.0F; depth > 1e-3F * static_cast<float>(size_);
             depth /= 4.0F) {
            if (evaluateInside(collider_, near.point - depth * near.normal).inside) {
                return true;
            }
        }
        return false;
    }

    std::reference_wrapper<const Collider> collider_;
    double size_;
    glm::ivec3 low_{0};
    glm::ivec3 count_{0};
    std::vector<char> inside_;
    std::vector<char> band_;  // kNone, kNear or kBeside
};

Result<Voxels> checkedVoxels(const Collider& collider, const FieldGridOptions& options) {
    if (options.voxels < kVoxelsMin || options.voxels > kVoxelsMax) {
        return fail(ErrorCode::kLimit, std::to_string(options.voxels) +
                                           " voxels along the longest side; choose " +
                                           std::to_string(kVoxelsMin) + " to " + std::to_string(kVoxelsMax));
    }
    Voxels voxels = RELIEF_TRY(Voxels::create(collider, collider.bounds, options.voxels));
    if (!voxels.closed()) {
        voxels = RELIEF_TRY(Voxels::create(collider, solidBox(collider), options.voxels));
    }
    if (!voxels.anyInside()) {
        return invalidInput(
            "no voxel is inside this collider, so it has no surface on this grid; use "
            "more voxels along the longest side");
    }
    if (!voxels.closed()) {
        return invalidInput(
            "its inside extends infinitely beyond its bounds, so its surface is not closed; bake it "
            "with a map that contains the whole mesh");
    }
    voxels.findBand();
    return voxels;
}

std::vector<std::byte> plyOf(const GridSurface& surface) {
    PlyBytes out;
    out.text(
        "ply\nformat binary_little_endian 1.0\ncomment surface of a collider; object units\nelement vertex " +
        std::to_string(surface.points.size()) +
        "\nproperty float x\nproperty float y\nproperty float z\nelement face " +
        std::to_string(surface.triangles.size() + surface.quads.size()) +
        "\nproperty list uchar uint vertex_indices\nend_header\n");
    for (const glm::vec3& p : surface.points) {
        for (int i = 0; i < 3; ++i) {
            out.number(p[i]);
        }
    }
    const auto addFaces = [&](const auto& faces) {
        for (const auto& corners : faces) {
            out.byte(static_cast<std::uint8_t>(corners.size()));
            for (const std::uint32_t corner : corners) {
                out.word(corner);
            }
        }
    };
    addFaces(surface.quads);
    addFaces(surface.triangles);
    return out.take();
}

Result<FieldGrids> makeGrids(const Collider& collider, const FieldGridOptions& options) {
    VdbWriter* const writer = RELIEF_TRY(vdbWriter());
    const Voxels voxels = RELIEF_TRY(checkedVoxels(collider, options));
    const NarrowBand band = voxels.band();
    FieldGrids out;
    out.voxel = voxels.size();
    out.missing = voxels.missing();
    if (options.level_set) {
        out.level_set = RELIEF_TRY(writer->levelSet(band));
    }
    if (options.surface) {
        const GridSurface surface = RELIEF_TRY(writer->surface(band));
        out.surface = plyOf(surface);
    }
    return out;
}

}  // namespace

Result<FieldGrids> encodeGrids(const Collider& collider, const FieldGridOptions& options) {
    try {
        return makeGrids(collider, options);
    } catch (const std::bad_alloc&) {
        return fail(ErrorCode::kLimit, "out of memory for this number of voxels; use fewer");
    }
}

}  // namespace relief

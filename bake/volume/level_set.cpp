#include "bake/volume/level_set.h"

#include <tbb/parallel_for.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <functional>
#include <limits>
#include <new>
#include <numbers>
#include <numeric>
#include <string>

#include "formats/nearest_surface.h"
#include "formats/polygons/ply_bytes.h"
#include "runtime/vdb/vdb_writer.h"

namespace relief {
namespace {

constexpr int kBand = 3;    // voxels to either side
constexpr int kMargin = 4;  // voxels of outside about the bounds, so that the band ends within

// Kinds of voxels by their place to the surface.
constexpr char kNone = 0;
constexpr char kNear = 1;
constexpr char kBeside = 2;

constexpr double kIndexMax = 0x1p30;  // of a voxel, from the origin
constexpr double kCellsMax = 0x1p31;

/// The box about a map's volume, in object space.
Bounds volumeBox(const DepthMap& map) {
    const float low = map.projection() == Projection::kCube ? -1.0F : 0.0F;
    Bounds box;
    for (int corner = 0; corner < 8; ++corner) {
        glm::vec3 p(0.0F);
        for (int i = 0; i < 3; ++i) {
            const glm::vec4& row = map.object_to_map.row[i];
            const glm::vec3 axis(row);
            p += axis * (((corner >> i & 1) != 0 ? 1.0F : low) - row.w) / glm::dot(axis, axis);
        }
        box.add(p);
    }
    return box;
}

/// A box that holds all that is inside. Ground goes deeper than the mesh that it stands for, and so than the bounds.
Bounds insideBox(const Collider& collider) {
    Bounds box{glm::vec3(-std::numeric_limits<float>::max()), glm::vec3(std::numeric_limits<float>::max())};
    bool any = false;
    for (const DepthMap& map : collider.maps) {
        if (map.encloses) {
            const Bounds volume = volumeBox(map);
            box.min = glm::max(box.min, volume.min);
            box.max = glm::min(box.max, volume.max);
            any = true;
        }
    }
    if (!any) {
        return collider.bounds;
    }
    box.add(collider.bounds.min);
    box.add(collider.bounds.max);
    return box;
}

/// The voxels about a collider: on which side each is, and which are of the band.
class Voxels {
  public:
    /// \param box  what they cover, and a margin
    /// Errors: kLimit.
    static Result<Voxels> create(const Collider& collider, const Bounds& box, std::uint32_t along) {
        Voxels voxels(collider, double{collider.bounds.longestSide()} / along);
        double cells = 1.0;
        for (int i = 0; i < 3; ++i) {
            const double low = std::floor(double{box.min[i]} / voxels.size_) - kMargin;
            const double high = std::ceil(double{box.max[i]} / voxels.size_) + kMargin;
            if (!(std::abs(low) < kIndexMax && std::abs(high) < kIndexMax)) {
                return fail(ErrorCode::kLimit,
                            "it lies too far from the origin for voxels this small; ask for fewer");
            }
            voxels.low_[i] = static_cast<int>(low);
            voxels.count_[i] = static_cast<int>(high - low) + 1;
            cells *= high - low + 1.0;
        }
        if (cells > kCellsMax) {
            return fail(ErrorCode::kLimit, "the box about its inside has too many voxels; ask for fewer");
        }
        voxels.findSides();
        return voxels;
    }

    /// The outermost voxels are outside, so that the surface is closed.
    [[nodiscard]] bool closed() const {
        for (int k = 0; k < count_[2]; ++k) {
            for (int j = 0; j < count_[1]; ++j) {
                for (int i = 0; i < count_[0]; ++i) {
                    const bool border = i == 0 || j == 0 || k == 0 || i + 1 == count_[0] ||
                                        j + 1 == count_[1] || k + 1 == count_[2];
                    if (border && inside_[cell(i, j, k)] != 0) {
                        return false;
                    }
                }
            }
        }
        return true;
    }

    [[nodiscard]] bool anyInside() const {
        return std::find(inside_.begin(), inside_.end(), 1) != inside_.end();
    }
    [[nodiscard]] double size() const { return size_; }

    /// Within kBand voxels, along each axis, of a voxel on the other side.
    void findBand() {
        forEachRow([this](int j, int k) {
            for (int i = 0; i < count_[0]; ++i) {
                band_[cell(i, j, k)] = besideTheOtherSide(i, j, k) ? kBeside : kNone;
            }
        });
        for (int axis = 0; axis < 3; ++axis) {
            widen(axis);
        }
    }

    /// Of the surface, the share about which no voxel lies on the other side: parts thinner than a voxel. An estimate: of
    /// all voxels that touch a surface from outside, those that are not of the band.
    [[nodiscard]] double missing() const {
        std::vector<std::size_t> missed(static_cast<std::size_t>(count_[2]), 0);
        std::vector<std::size_t> seen(missed.size(), 0);
        forEachRow([&](int j, int k) {
            for (int i = 0; i < count_[0]; ++i) {
                const std::size_t at = cell(i, j, k);
                if (inside_[at] != 0) {
                    continue;
                }
                const auto row = static_cast<std::size_t>(k);
                seen[row] += band_[at] == kBeside ? 1 : 0;
                missed[row] += band_[at] == kNone && touchesSurface(place(i, j, k)) ? 1 : 0;
            }
        });
        const auto sum = [](const std::vector<std::size_t>& counts) {
            return static_cast<double>(std::accumulate(counts.begin(), counts.end(), std::size_t{0}));
        };
        return sum(missed) / (sum(missed) + sum(seen));
    }

    /// Calls use(where, distance) for each voxel of the band.
    template <class Use>
    void forEachOfBand(Use use) const {
        const auto slices = distances();
        for (int k = 0; k < count_[2]; ++k) {
            auto distance = slices[static_cast<std::size_t>(k)].begin();
            for (int j = 0; j < count_[1]; ++j) {
                for (int i = 0; i < count_[0]; ++i) {
                    if (band_[cell(i, j, k)] != kNone) {
                        use(glm::ivec3(low_[0] + i, low_[1] + j, low_[2] + k), *distance++);
                    }
                }
            }
        }
    }

  private:
    Voxels(const Collider& collider, double size) : collider_(collider), size_(size) {}

    void findSides() {
        inside_.resize(cells());
        band_.resize(cells());
        forEachRow([this](int j, int k) {
            for (int i = 0; i < count_[0]; ++i) {
                inside_[cell(i, j, k)] = evaluateInside(collider_, place(i, j, k)).inside ? 1 : 0;
            }
        });
    }
    [[nodiscard]] std::size_t cells() const {
        return static_cast<std::size_t>(count_[0]) * static_cast<std::size_t>(count_[1]) *
               static_cast<std::size_t>(count_[2]);
    }
    [[nodiscard]] std::size_t cell(int i, int j, int k) const {
        return (static_cast<std::size_t>(k) * static_cast<std::size_t>(count_[1]) +
                static_cast<std::size_t>(j)) *
                   static_cast<std::size_t>(count_[0]) +
               static_cast<std::size_t>(i);
    }
    [[nodiscard]] glm::vec3 place(int i, int j, int k) const {
        return {static_cast<float>(size_ * (low_[0] + i)), static_cast<float>(size_ * (low_[1] + j)),
                static_cast<float>(size_ * (low_[2] + k))};
    }
    /// Of the voxels of the band, slice by slice of equal z.
    [[nodiscard]] std::vector<std::vector<float>> distances() const {
        std::vector<std::vector<float>> out(static_cast<std::size_t>(count_[2]));
        forEachRow([&](int j, int k) {
            for (int i = 0; i < count_[0]; ++i) {
                const std::size_t at = cell(i, j, k);
                if (band_[at] != kNone) {
                    // The surface passes between neighbours of two sides, whatever the distance.
                    const float most = static_cast<float>(band_[at] == kBeside ? size_ : kBand * size_);
                    const float length = lengthAt(place(i, j, k), most);
                    out[static_cast<std::size_t>(k)].push_back(inside_[at] != 0 ? -length : length);
                }
            }
        });
        return out;
    }
    /// Calls use(j, k), rows of a slice in order, slices at once.
    template <class Use>
    void forEachRow(Use use) const {
        tbb::parallel_for(0, count_[2], [&](int k) {
            for (int j = 0; j < count_[1]; ++j) {
                use(j, k);
            }
        });
    }
    [[nodiscard]] bool besideTheOtherSide(int i, int j, int k) const {
        const char here = inside_[cell(i, j, k)];
        const auto other = [&](int x, int y, int z) {
            return x >= 0 && y >= 0 && z >= 0 && x < count_[0] && y < count_[1] && z < count_[2] &&
                   inside_[cell(x, y, z)] != here;
        };
        return other(i - 1, j, k) || other(i + 1, j, k) || other(i, j - 1, k) || other(i, j + 1, k) ||
               other(i, j, k - 1) || other(i, j, k + 1);
    }
    /// By kBand − 1 voxels: those beside the other side are of the band already.
    void widen(int axis) {
        const std::vector<char> before = band_;
        forEachRow([&](int j, int k) {
            for (int i = 0; i < count_[0]; ++i) {
                int at[3] = {i, j, k};
                const int middle = at[axis];
                char found = before[cell(i, j, k)];
                for (int d = 1 - kBand; d < kBand && found == kNone; ++d) {
                    at[axis] = middle + d;
                    const bool there = at[axis] >= 0 && at[axis] < count_[axis];
                    found = there && before[cell(at[0], at[1], at[2])] != kNone ? kNear : kNone;
                }
                band_[cell(i, j, k)] = found;
            }
        });
    }
    /// For P outside: a surface passes through the ball about this voxel, and behind it is an inside.
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
    [[nodiscard]] float lengthAt(const glm::vec3& p, float most) const {
        const SurfaceSample sample = nearestSurface(collider_, p);
        return sample.map < 0 ? most : std::min(std::abs(sample.distance), most);
    }

    std::reference_wrapper<const Collider> collider_;
    double size_;
    int low_[3]{};
    int count_[3]{};
    std::vector<char> inside_;
    std::vector<char> band_;  // kNone, kNear or kBeside
};

NarrowBand bandOf(const Voxels& voxels) {
    NarrowBand band{voxels.size(), static_cast<float>(kBand * voxels.size()), {}, {}};
    voxels.forEachOfBand([&](const glm::ivec3& at, float distance) {
        if (std::abs(distance) < band.background) {
            band.at.push_back(at);
            band.distance.push_back(distance);
        }
    });
    return band;
}

Result<Voxels> checkedVoxels(const Collider& collider, const FieldGridOptions& options) {
    if (options.voxels < kVoxelsMin || options.voxels > kVoxelsMax) {
        return fail(ErrorCode::kLimit, std::to_string(options.voxels) +
                                           " voxels along the longest side; from " +
                                           std::to_string(kVoxelsMin) + " to " + std::to_string(kVoxelsMax) +
                                           " may be asked for");
    }
    Voxels voxels = RELIEF_TRY(Voxels::create(collider, collider.bounds, options.voxels));
    if (!voxels.closed()) {
        voxels = RELIEF_TRY(Voxels::create(collider, insideBox(collider), options.voxels));
    }
    if (!voxels.anyInside()) {
        return invalidInput(
            "no voxel lies inside this collider, so that it has no surface on such a grid; ask for "
            "smaller voxels, more of them along the longest side");
    }
    if (!voxels.closed()) {
        return invalidInput(
            "its inside goes on beyond its bounds without end, so that its surface is not closed; bake it "
            "with a map that holds the whole mesh");
    }
    voxels.findBand();
    return voxels;
}

template <std::size_t kCount>
void addFace(const std::array<std::uint32_t, kCount>& corners, PlyBytes& out) {
    out.byte(kCount);
    std::for_each(corners.begin(), corners.end(), [&](std::uint32_t corner) { out.word(corner); });
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
    for (const auto& quad : surface.quads) {
        addFace(quad, out);
    }
    for (const auto& triangle : surface.triangles) {
        addFace(triangle, out);
    }
    return out.take();
}

Result<FieldGrids> makeGrids(const Collider& collider, const FieldGridOptions& options) {
    VdbWriter* const writer = RELIEF_TRY(vdbWriter());
    const Voxels voxels = RELIEF_TRY(checkedVoxels(collider, options));
    const NarrowBand band = bandOf(voxels);
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
        return fail(ErrorCode::kLimit, "out of memory for so many voxels; ask for fewer");
    }
}

}  // namespace relief

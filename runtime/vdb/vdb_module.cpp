// SPDX-License-Identifier: Apache-2.0
// The module relief-vdb.so: implements VdbWriter with OpenVDB.
#include <openvdb/io/Archive.h>
#include <openvdb/openvdb.h>
#include <openvdb/points/PointConversion.h>
#include <openvdb/tools/SignedFloodFill.h>
#include <openvdb/tools/VolumeToMesh.h>

#include <algorithm>
#include <cmath>
#include <functional>
#include <span>
#include <sstream>
#include <string>

#include "formats/base/hash.h"
#include "runtime/vdb/vdb_writer.h"

namespace relief {
namespace {

using openvdb::points::PointDataGrid;
using openvdb::points::PointDataTree;
using openvdb::tools::PointIndexGrid;

constexpr double kPointsPerVoxel = 8.0;
constexpr double kVoxelsMax = 4096.0;  // along the longest side
constexpr double kIndexMax = 0x1p24;   // maximum voxel index

/// Returns a voxel size for about eight points per voxel, if they fill their box evenly.
double voxelSize(const std::vector<openvdb::Vec3f>& positions) {
    openvdb::BBoxd box;
    for (const openvdb::Vec3f& p : positions) {
        box.expand(openvdb::Vec3d(p));
    }
    const double side = positions.empty() ? 0.0 : box.extents()[box.maxExtent()];
    const double cells = std::cbrt(static_cast<double>(positions.size()) / kPointsPerVoxel);
    const double size = side > 0.0 ? side / std::clamp(cells, 1.0, kVoxelsMax) : 1.0;
    double farthest = 0.0;
    for (int i = 0; i < 3 && !positions.empty(); ++i) {
        farthest = std::max({farthest, std::abs(box.min()[i]), std::abs(box.max()[i])});
    }
    return std::max(size, farthest / kIndexMax);
}

/// Adds an attribute to all points.
template <class Value, class Of>
void add(PointDataTree& tree, const PointIndexGrid& index, std::span<const VdbPoint> particles,
         const std::string& name, Of of) {
    std::vector<Value> values;
    values.reserve(particles.size());
    for (const VdbPoint& particle : particles) {
        values.push_back(of(particle));
    }
    openvdb::points::appendAttribute<Value>(tree, name);
    openvdb::points::populateAttribute(tree, index.tree(), name,
                                       openvdb::points::PointAttributeVector<Value>(values));
}

openvdb::GridPtrVec makePoints(std::span<const VdbPoint> particles) {
    std::vector<openvdb::Vec3f> positions;
    for (const VdbPoint& p : particles) {
        positions.emplace_back(p.position.x, p.position.y, p.position.z);
    }
    const auto transform = openvdb::math::Transform::createLinearTransform(voxelSize(positions));
    const openvdb::points::PointAttributeVector<openvdb::Vec3f> wrapped(positions);
    const auto index = openvdb::tools::createPointIndexGrid<PointIndexGrid>(wrapped, *transform);
    const auto grid = openvdb::points::createPointDataGrid<openvdb::points::NullCodec, PointDataGrid>(
        *index, wrapped, *transform);
    grid->setName("particles");
    grid->insertMeta("points", openvdb::Int64Metadata(static_cast<std::int64_t>(positions.size())));
    PointDataTree& tree = grid->tree();
    if (!positions.empty()) {
        add<openvdb::Vec3f>(tree, *index, particles, "v", [](const VdbPoint& p) {
            return openvdb::Vec3f(p.velocity.x, p.velocity.y, p.velocity.z);
        });
        add<float>(tree, *index, particles, "age", [](const VdbPoint& p) { return p.age; });
        add<float>(tree, *index, particles, "life", [](const VdbPoint& p) { return p.lifetime; });
        add<int>(tree, *index, particles, "id", [](const VdbPoint& p) { return static_cast<int>(p.id); });
        add<int>(tree, *index, particles, "type", [](const VdbPoint& p) { return static_cast<int>(p.type); });
    }
    return {grid};
}

openvdb::FloatGrid::Ptr makeGrid(const NarrowBand& band) {
    auto grid = openvdb::FloatGrid::create(band.background);
    grid->setName("surface");
    grid->setGridClass(openvdb::GRID_LEVEL_SET);
    grid->setTransform(openvdb::math::Transform::createLinearTransform(band.voxel));
    auto to = grid->getAccessor();
    for (std::size_t i = 0; i < band.at.size(); ++i) {
        to.setValueOn(openvdb::Coord(band.at[i].x, band.at[i].y, band.at[i].z), band.distance[i]);
    }
    openvdb::tools::signedFloodFill(grid->tree());
    return grid;
}

/// Writes an archive to memory with grid offsets, so that programs can read it in parts.
class MemoryArchive : public openvdb::io::Archive {
  public:
    [[nodiscard]] Ptr copy() const override { return Ptr(new MemoryArchive(*this)); }
    void writeTo(std::ostream& out, const openvdb::GridCPtrVec& grids) {
        // Not every build of OpenVDB has Zip and Blosc; every build reads files without them.
        setCompression(openvdb::io::COMPRESS_ACTIVE_MASK);
        setGridStatsMetadataEnabled(false);
        Archive::write(out, grids, true);
    }
};

// The header has a magic number, three versions and a flag, then 36 random characters that identify the file.
constexpr std::size_t kTagAt = 8 + 3 * 4 + 1;
constexpr std::size_t kTagSize = 36;

/// Replaces the random characters by a hash of the bytes, so that equal content gives equal files.
void nameByContent(std::string& bytes) {
    const auto tag = bytes.begin() + static_cast<std::ptrdiff_t>(kTagAt);
    std::fill_n(tag, kTagSize, '0');
    const std::string hash = xxh3_128Hex(std::as_bytes(std::span(bytes)));
    std::size_t from = 0;
    for (std::size_t i = 0; i < kTagSize; ++i) {
        const bool dash = i == 8 || i == 13 || i == 18 || i == 23;
        bytes[kTagAt + i] = dash ? '-' : hash[from++];
    }
}

/// Returns reproducible bytes of the grids that `make` returns. Registers the types of OpenVDB first.
/// Errors: kFailure (exceptions of OpenVDB or of `make`; out of memory).
Result<std::vector<std::byte>> vdbBytes(const std::function<openvdb::GridPtrVec()>& make) {
    try {
        openvdb::initialize();
        const openvdb::GridPtrVec made = make();
        const openvdb::GridCPtrVec grids(made.begin(), made.end());
        std::ostringstream out;
        MemoryArchive().writeTo(out, grids);
        std::string bytes = std::move(out).str();
        nameByContent(bytes);
        const auto* const data = reinterpret_cast<const std::byte*>(bytes.data());
        return std::vector<std::byte>(data, data + bytes.size());
    } catch (const std::exception& error) {
        return fail(ErrorCode::kFailure, std::string("OpenVDB: ") + error.what());
    }
}

class Writer : public VdbWriter {
  public:
    Result<std::vector<std::byte>> points(std::span<const VdbPoint> particles) override {
        return vdbBytes([&] { return makePoints(particles); });
    }

    Result<std::vector<std::byte>> levelSet(const NarrowBand& band) override {
        return vdbBytes([&] { return openvdb::GridPtrVec{makeGrid(band)}; });
    }

    Result<GridSurface> surface(const NarrowBand& band) override {
        std::vector<openvdb::Vec3s> points;
        std::vector<openvdb::Vec3I> triangles;
        std::vector<openvdb::Vec4I> quads;
        RELIEF_TRY(vdbBytes([&] {
            openvdb::tools::volumeToMesh(*makeGrid(band), points, triangles, quads, 0.0, 0.0);
            return openvdb::GridPtrVec{};
        }));
        GridSurface out;
        for (const openvdb::Vec3s& p : points) {
            out.points.emplace_back(p.x(), p.y(), p.z());
        }
        // Faces of OpenVDB are clockwise, seen from outside.
        for (const openvdb::Vec3I& t : triangles) {
            out.triangles.push_back({t[2], t[1], t[0]});
        }
        for (const openvdb::Vec4I& q : quads) {
            out.quads.push_back({q[3], q[2], q[1], q[0]});
        }
        return out;
    }
};

}  // namespace
}  // namespace relief

extern "C" __attribute__((visibility("default"))) relief::VdbWriter* reliefVdbWriter() {
    static relief::Writer writer;
    return &writer;
}

#include "bake/texels/rasterize.h"

#include <algorithm>
#include <cstring>
#include <vector>

namespace relief {
namespace {

/// Along a side. Every OpenGL has targets of this size; 96 MB of texels and depth at most.
constexpr std::uint32_t kTile = 2048;

bool isEmpty(MapFormat format, std::span<const std::byte> texel) {
    if (format == MapFormat::kFloat32) {
        float depth = 0.0F;
        std::memcpy(&depth, &texel[12], sizeof(depth));
        return depth < 0.0F;
    }
    return std::all_of(texel.begin(), texel.end(), [](std::byte b) { return b == std::byte{0}; });
}

/// One row of a tile to its place. \return the texels with a surface.
std::uint64_t copyRow(std::span<const std::byte> row, MapFormat format, std::span<std::byte> to) {
    std::copy(row.begin(), row.end(), to.begin());
    const std::size_t size = texelSize(format);
    std::uint64_t covered = 0;
    for (std::size_t at = 0; at < row.size(); at += size) {
        covered += isEmpty(format, row.subspan(at, size)) ? 0 : 1;
    }
    return covered;
}

DepthMapFrame frameOf(const View& view, Decode decode, const PreparedMesh& mesh) {
    DepthMapFrame frame;
    frame.format = view.format;
    frame.compare = view.compare;
    frame.decode = decode;
    frame.width = view.width;
    frame.height = view.height;
    frame.origin = view.origin;
    std::copy(std::begin(view.axis), std::end(view.axis), std::begin(frame.axis));
    frame.encloses = view.encloses;
    std::copy(std::begin(view.starts_free), std::end(view.starts_free), std::begin(frame.starts_free));
    frame.inside_out = mesh.orientation() < 0.0;
    frame.exact = true;
    // A hundredth of a texel, as for rays.
    const double unit = view.depthUnit();
    frame.good_enough =
        0.01 * static_cast<double>(mesh->bounds.longestSide()) / std::max(view.width, view.height) / unit;
    return frame;
}

}  // namespace

Result<Rasterizer> Rasterizer::create(const PreparedMesh& mesh) {
    auto gpu_mesh = GpuMesh::create(mesh->positions, mesh->triangles);
    if (!gpu_mesh) {
        return fail(gpu_mesh.error().code, mesh->name + ": " + gpu_mesh.error().message);
    }
    auto renderer = RELIEF_TRY(DepthMapRenderer::create());
    return Rasterizer(mesh, std::move(*gpu_mesh), std::move(renderer));
}

Result<DepthMap> Rasterizer::bake(const View& view, Decode decode, std::uint64_t& covered,
                                  const std::function<void(std::uint32_t)>& rowsDone) {
    const DepthMapFrame frame = frameOf(view, decode, mesh_);
    DepthMap map = view.emptyMap();
    map.decode = decode;
    const auto target = RELIEF_TRY(
        DepthMapTarget::create(frame.format, std::min(kTile, frame.width), std::min(kTile, frame.height)));
    covered = 0;
    std::vector<std::byte> tile;
    for (std::uint32_t face = 0; face < map.faceCount(); ++face) {
        for (std::uint32_t y = 0; y < map.height; y += kTile) {
            const std::uint32_t rows = std::min(kTile, map.height - y);
            for (std::uint32_t x = 0; x < map.width; x += kTile) {
                const TexelWindow window{face, x, y, std::min(kTile, map.width - x), rows};
                RELIEF_TRY(renderer_.render(gpu_mesh_, frame, window, target));
                const std::size_t row_bytes = window.width * texelSize(map.format);
                tile.resize(row_bytes * rows);
                RELIEF_TRY(target.read(0, 0, window.width, rows, tile));
                for (std::uint32_t row = 0; row < rows; ++row) {
                    const std::size_t first = map.texelAt(face, x, y + row).data() - map.texels.data();
                    covered += copyRow(std::span(tile).subspan(row * row_bytes, row_bytes), map.format,
                                       std::span(map.texels).subspan(first, row_bytes));
                }
            }
            rowsDone(rows);
        }
    }
    return map;
}

}  // namespace relief

// SPDX-License-Identifier: Apache-2.0
#include "bake/ground/ground_bake.h"

#include <tbb/global_control.h>

#include <algorithm>
#include <bit>
#include <cmath>
#include <iterator>
#include <limits>
#include <optional>
#include <span>
#include <utility>

#include "bake/mesh/loops.h"
#include "bake/recipe/recipe_jobs.h"
#include "bake/world/coarse_collider.h"
#include "bake/world/world_files.h"
#include "formats/base/file_io.h"
#include "formats/base/hash.h"
#include "formats/base/text.h"
#include "formats/container.h"

namespace relief {
namespace {

namespace fs = std::filesystem;

constexpr std::size_t kKeyDigits = 16;
constexpr std::uint32_t kRowsBetweenReports = 256;

/// A range of squares along an axis, and the range of their samples.
struct Stretch {
    std::uint32_t first = 0;  ///< its first square
    std::uint32_t begin = 0;  ///< its first sample, one leaf before the first square
    std::uint32_t end = 0;    ///< the end of its samples, one leaf beyond the last square
};

std::vector<Stretch> stretchesOf(std::uint32_t samples, std::uint32_t squares) {
    std::vector<Stretch> stretches;
    for (std::uint32_t first = 0; first + 1 < samples; first += squares) {
        stretches.push_back({first, first - std::min(first, kLeafSquares),
                             std::min(first + squares + kLeafSquares + 1, samples)});
    }
    return stretches;
}

/// A sliding window over the rows of a height map.
class RowBand {
  public:
    explicit RowBand(HeightMap& map) : map_(map) {}

    /// \param rows  begin and end must not decrease between calls.
    Result<void> moveTo(const Stretch& rows) {
        const std::size_t columns = map_.columns();
        const std::uint32_t gone = std::min(rows.begin, end_) - begin_;
        heights_.erase(heights_.begin(), heights_.begin() + static_cast<std::ptrdiff_t>(gone * columns));
        begin_ += gone;
        heights_.resize((rows.end - begin_) * columns);
        for (; end_ < rows.end; ++end_) {
            RELIEF_TRY(map_.next(std::span(heights_).subspan((end_ - begin_) * columns, columns)));
        }
        return {};
    }
    [[nodiscard]] HeightGrid cut(const Stretch& columns) const {
        HeightGrid grid{columns.end - columns.begin, end_ - begin_, {}};
        grid.heights.reserve(std::size_t{grid.columns} * grid.rows);
        for (std::size_t row = 0; row < grid.rows; ++row) {
            const auto at = heights_.begin() + static_cast<std::ptrdiff_t>(row * map_.columns());
            grid.heights.insert(grid.heights.end(), at + columns.begin, at + columns.end);
        }
        return grid;
    }
    /// Moves out all rows; the window is empty afterwards.
    [[nodiscard]] HeightGrid take() { return {map_.columns(), end_ - begin_, std::move(heights_)}; }

  private:
    HeightMap& map_;
    std::uint32_t begin_ = 0;
    std::uint32_t end_ = 0;
    std::vector<float> heights_;
};

/// A tile and its containers. `bytes` is empty if the tile has no ground, `coarse` if it has no coarse collider.
struct BakedTile {
    GroundTile tile;
    std::vector<std::byte> bytes;
    std::vector<std::byte> coarse;
};

/// Squares along the side of a coarse square.
constexpr std::uint32_t kCoarse = 4;
static_assert(kLeafSquares % kCoarse == 0, "coarse squares of neighbouring tiles must meet");

/// Returns the ground sample nearest to a position within a coarse square; a hole if there is none.
float nearestGround(const HeightGrid& grid, std::uint32_t column, std::uint32_t row) {
    float nearest = grid.at(column, row);
    std::uint32_t least = std::numeric_limits<std::uint32_t>::max();
    const auto from = [](std::uint32_t at) { return at - std::min(at, kCoarse - 1); };
    for (std::uint32_t y = from(row);
         std::isnan(grid.at(column, row)) && y < std::min(row + kCoarse, grid.rows); ++y) {
        for (std::uint32_t x = from(column); x < std::min(column + kCoarse, grid.columns); ++x) {
            const std::uint32_t away = (x - column) * (x - column) + (y - row) * (y - row);
            if (!std::isnan(grid.at(x, y)) && away < least) {
                least = away;
                nearest = grid.at(x, y);
            }
        }
    }
    return nearest;
}

HeightGrid coarseOf(const HeightGrid& grid) {
    const auto samples = [](std::uint32_t fine) { return (fine - 1 + kCoarse - 1) / kCoarse + 1; };
    HeightGrid coarse{samples(grid.columns), samples(grid.rows), {}};
    coarse.heights.reserve(std::size_t{coarse.columns} * coarse.rows);
    for (std::uint32_t row = 0; row < coarse.rows; ++row) {
        for (std::uint32_t column = 0; column < coarse.columns; ++column) {
            coarse.heights.push_back(nearestGround(grid, std::min(kCoarse * column, grid.columns - 1),
                                                   std::min(kCoarse * row, grid.rows - 1)));
        }
    }
    return coarse;
}

class GroundBaker {
  public:
    GroundBaker(HeightMap& map, const GroundOptions& options) : map_(map), options_(options) {
        result_.columns = map.columns();
        result_.rows = map.rows();
        result_.heights = map.spec();
    }

    Result<GroundResult> run() {
        if (options_.folder.empty() && heights().tile != HeightsSpec().tile) {
            return fail(ErrorCode::kUsage, "tile= of --heights has no effect without --world; remove it");
        }
        RELIEF_TRY(checkPlace());
        const Result<void> done = options_.folder.empty() ? bakeWhole() : bakeTiles();
        if (!done && done.error().code == ErrorCode::kLimit) {
            const BetterFormat format = map_.betterFormat();
            if (format.found() || format.doubtful) {
                return fail(ErrorCode::kLimit,
                            done.error().message + "; " +
                                (format.found() ? fixBy(format) : "check --heights type and order too"));
            }
        }
        RELIEF_TRY(done);
        warn();
        return std::move(result_);
    }

  private:
    [[nodiscard]] const HeightsSpec& heights() const { return options_.heights; }

    void report(double share) const {
        if (options_.progress) {
            options_.progress(share);
        }
    }

    [[nodiscard]] Result<void> checkPlace() const {
        const glm::dvec3 size(heights().spacing * map_.columns(), 0.0, heights().spacing * map_.rows());
        const glm::dvec3 far = glm::max(glm::abs(heights().offset.at), glm::abs(heights().offset.at + size));
        if (!(std::max({far.x, far.y, far.z}) < kFloatSteps * heights().spacing)) {
            return fail(
                ErrorCode::kLimit,
                map_.name() +
                    ": it is too far from the origin for floats to resolve its spacing; give a smaller "
                    "--heights offset, or a larger spacing");
        }
        return {};
    }

    [[nodiscard]] tl::unexpected<Error> noGround() const {
        return invalidInput(
            map_.name() +
            ": there is no ground: each square of four samples has a hole; check --heights hole");
    }

    Result<std::vector<std::byte>> containerOf(const Collider& collider) const {
        return withPrefix(map_.name(), writeContainer(collider, {static_cast<int>(options_.compress)}));
    }

    Result<BakedTile> bakeTile(const HeightGrid& grid, const GroundPlace& place) const {
        Ground ground = RELIEF_TRY(withPrefix(map_.name(), bakeGround(grid, place)));
        BakedTile baked;
        if (ground.squares == 0) {
            return baked;
        }
        Collider collider;
        collider.bounds = ground.bounds;
        collider.unit = "m";
        // Two triangles per square.
        collider.provenance = {map_.name(),
                               map_.hash(),
                               2 * ground.squares,
                               "relief " RELIEF_VERSION,
                               {{"heights", toString(map_.spec())}}};
        collider.maps.push_back(std::move(ground.map));
        baked.bytes = RELIEF_TRY(containerOf(collider));
        baked.tile.hash = xxh3_128Hex(baked.bytes);
        baked.tile.bytes = baked.bytes.size();
        baked.tile.gpu_bytes = collider.texelBytes();
        baked.tile.squares = ground.squares;
        baked.tile.steep = ground.steep;
        baked.tile.error_max = ground.error_max;
        baked.tile.box = ground.bounds;
        if (!options_.folder.empty() && hasCoarse(collider)) {
            RELIEF_TRY(bakeCoarse(grid, place, std::move(collider), baked));
        }
        return baked;
    }

    /// \param collider  the tile's collider.
    Result<void> bakeCoarse(const HeightGrid& grid, const GroundPlace& place, Collider collider,
                            BakedTile& baked) const {
        const Bounds& box = baked.tile.box;
        const GroundPlace coarse{.spacing = kCoarse * place.spacing,
                                 .origin = place.origin,
                                 .leaf_level = kLeafLevel - std::countr_zero(kCoarse),
                                 .heights = glm::dvec2(box.min.y, box.max.y)};
        collider.maps = {RELIEF_TRY(withPrefix(map_.name(), bakeGround(coarseOf(grid), coarse))).map};
        baked.coarse = RELIEF_TRY(containerOf(collider));
        baked.tile.coarse = {"", xxh3_128Hex(baked.coarse), collider.texelBytes()};
        return {};
    }

    Result<void> bakeWhole() {
        RowBand band(map_);
        for (std::uint32_t rows = 0; rows < map_.rows();) {
            rows += std::min(kRowsBetweenReports, map_.rows() - rows);
            RELIEF_TRY(band.moveTo({0, 0, rows}));
            report(0.5 * rows / map_.rows());
        }
        BakedTile baked =
            RELIEF_TRY(bakeTile(band.take(), {.spacing = heights().spacing, .origin = heights().offset.at}));
        if (baked.bytes.empty()) {
            return noGround();
        }
        result_.container = std::move(baked.bytes);
        result_.tiles.push_back(std::move(baked.tile));
        return {};
    }

    Result<void> bakeTiles() {
        const std::vector<Stretch> across = stretchesOf(map_.columns(), heights().tile);
        const std::vector<Stretch> along = stretchesOf(map_.rows(), heights().tile);
        if (across.size() * along.size() > kWorldCollidersMax) {
            return fail(ErrorCode::kLimit,
                        map_.name() + ": it needs " + std::to_string(across.size() * along.size()) +
                            " tiles, more than the limit of " + std::to_string(kWorldCollidersMax) +
                            "; give a larger --heights tile");
        }
        World world;
        world.unit = "m";
        RowBand band(map_);
        for (std::size_t row = 0; row < along.size(); ++row) {
            RELIEF_TRY(band.moveTo(along[row]));
            RELIEF_TRY(bakeRow(band, across, along[row], row, world));
            report(static_cast<double>(row + 1) / static_cast<double>(along.size()));
        }
        if (world.bodies.empty()) {
            return noGround();
        }
        ReplacedWorld replaced = RELIEF_TRY(replaceWorld(options_.folder, world, {}, map_.name()));
        result_.removed = std::move(replaced.removed);
        std::move(replaced.warnings.begin(), replaced.warnings.end(), std::back_inserter(result_.warnings));
        return {};
    }

    Result<void> bakeRow(const RowBand& band, const std::vector<Stretch>& across, const Stretch& along,
                         std::size_t row, World& world) {
        std::vector<Result<BakedTile>> tiles(across.size());
        forEachIndex(0, across.size(), 1, [&](std::size_t i) {
            const Stretch& columns = across[i];
            // The origin is the tile's first square; the leaf before it has negative coordinates.
            const glm::uvec2 first(columns.first - columns.begin, along.first - along.begin);
            const GroundPlace place{.spacing = heights().spacing,
                                    .origin = -heights().spacing * glm::dvec3(first.x, 0.0, first.y),
                                    .first = first,
                                    .squares = glm::uvec2(heights().tile)};
            tiles[i] = bakeTile(band.cut(columns), place).and_then([&](BakedTile&& baked) {
                return written(std::move(baked), i, row);
            });
        });
        for (std::size_t i = 0; i < tiles.size(); ++i) {
            GroundTile tile = RELIEF_TRY(std::move(tiles[i])).tile;
            if (tile.file.empty()) {
                continue;
            }
            WorldBody body;
            body.collider = static_cast<std::uint32_t>(world.colliders.size());
            body.node = "tile " + std::to_string(i) + " " + std::to_string(row);
            body.position = glm::vec3(heights().offset.at +
                                      heights().spacing * glm::dvec3(across[i].first, 0.0, along.first));
            world.colliders.push_back(
                {{tile.file, tile.hash, tile.gpu_bytes}, map_.name(), tile.box, tile.coarse});
            world.bodies.push_back(std::move(body));
            result_.tiles.push_back(std::move(tile));
        }
        return {};
    }

    /// Writes a tile's containers if it has ground.
    [[nodiscard]] Result<BakedTile> written(BakedTile baked, std::size_t column, std::size_t row) const {
        const auto write = [&](std::vector<std::byte>& bytes, const std::string& hash, const char* kind) {
            const std::string file = fileStem(fs::path(map_.name()).stem().string()) + "-" +
                                     std::to_string(column) + "-" + std::to_string(row) + kind + "-" +
                                     hash.substr(0, kKeyDigits) + std::string(kColliderExtension);
            return writeFile(options_.folder / file, std::exchange(bytes, {})).map([&] { return file; });
        };
        if (!baked.bytes.empty()) {
            baked.tile.file = RELIEF_TRY(write(baked.bytes, baked.tile.hash, ""));
        }
        if (baked.tile.coarse) {
            baked.tile.coarse->file = RELIEF_TRY(write(baked.coarse, baked.tile.coarse->hash, "-coarse"));
        }
        return baked;
    }

    void warn() {
        std::uint64_t steep = 0;
        std::uint64_t squares = 0;
        for (const GroundTile& tile : result_.tiles) {
            steep += tile.steep;
            squares += tile.squares;
        }
        const std::string cause = causeOfSteep(2 * steep > squares);
        if (steep > 0) {
            result_.warnings.push_back(
                map_.name() + ": " + std::to_string(steep) +
                " squares are steep: they rise by more than 2.9 times their side (64 degrees along a "
                "diagonal, "
                "71 along a row); walls there are displaced by up to 0.15 of a square");
        }
        if (!cause.empty()) {
            result_.warnings.push_back(map_.name() + ": " + cause);
        }
    }

    [[nodiscard]] std::string fixBy(const BetterFormat& format) const {
        return "its samples look like those of another format; try --heights " + toString(format) +
               (map_.hasLow() && format.type ? ", without low and high" : "") +
               (format.eight_bits ? ", unless they are 8 bits times 256" : "");
    }

    /// Returns the settings that probably do not match the file; empty if there are none.
    /// \param most  whether most of its squares are steep.
    [[nodiscard]] std::string causeOfSteep(bool most) const {
        std::optional<OutlierSample> outliers = map_.outliers();
        if (outliers && outliers->gap <= kSteepest * heights().spacing) {
            outliers.reset();
        }
        const BetterFormat format = map_.betterFormat();
        if (outliers && format != BetterFormat{.type = SampleType::kInt16}) {
            const std::string far =
                std::string(" far ") + (outliers->lowest ? "below" : "above") + " all others; if ";
            return std::string("its ") + (outliers->lowest ? "lowest" : "highest") +
                   (outliers->sample == outliers->last
                        ? " sample, " + shortest(outliers->sample) + ", lies" + far +
                              "it stands for no data, give --heights hole=" + shortest(outliers->sample)
                        : " samples, " + shortest(std::min(outliers->sample, outliers->last)) + " to " +
                              shortest(std::max(outliers->sample, outliers->last)) + ", lie" + far +
                              "they stand for no data, save them as one value and give it as --heights hole");
        }
        if (format.found()) {
            return fixBy(format) +
                   (outliers && outliers->sample == outliers->last
                        ? std::string("; or, if its ") + (outliers->lowest ? "lowest" : "highest") +
                              " sample, " + shortest(outliers->sample) +
                              ", stands for no data, --heights hole=" + shortest(outliers->sample)
                        : "");
        }
        return most ? std::string("most of its squares are steep; check --heights spacing") +
                          (map_.hasLow() ? ", low and high" : "") + (map_.isRaw() ? ", type and order" : "")
                    : std::string();
    }

    HeightMap& map_;
    const GroundOptions& options_;
    GroundResult result_;
};

}  // namespace

std::uint64_t GroundResult::gpuBytes() const {
    std::uint64_t bytes = 0;
    for (const GroundTile& tile : tiles) {
        bytes += tile.gpu_bytes;
    }
    return bytes;
}

double GroundResult::errorMax() const {
    double most = 0.0;
    for (const GroundTile& tile : tiles) {
        most = std::max(most, tile.error_max);
    }
    return most;
}

Result<GroundResult> bakeHeightMap(HeightMap& map, const GroundOptions& options) {
    return GroundBaker(map, options).run();
}

Result<GroundResult> bakeHeightMap(const BakeRequest& request, GroundOptions options) {
    static_cast<void>(RELIEF_TRY(settingsOf(request)));
    options.heights = RELIEF_TRY(parseHeightsSpec(request.heights));
    std::optional<tbb::global_control> control;
    if (request.threads) {
        control.emplace(tbb::global_control::max_allowed_parallelism, *request.threads);
    }
    HeightMap map = RELIEF_TRY(HeightMap::open(request.mesh, options.heights, request.import_limits));
    GroundResult result = RELIEF_TRY(bakeHeightMap(map, options));
    result.inputs.push_back({request.mesh, map.hash()});
    return result;
}

}  // namespace relief

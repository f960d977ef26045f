// What a run of a recipe says: events for machines while it runs, a display for people, and both at its end.
#pragma once

#include <nlohmann/json_fwd.hpp>
#include <string>
#include <vector>

#include "bake/recipe/prune.h"
#include "bake/recipe/recipe_run.h"
#include "formats/base/descriptor.h"
#include "formats/base/stopwatch.h"

namespace relief {

struct RecipeCounts {
    std::size_t stale = 0;
    std::size_t up_to_date = 0;
    std::size_t baked = 0;
    std::size_t failed = 0;
    std::size_t cancelled = 0;
    std::uint64_t bytes = 0;  ///< of the outputs that are up to date now

    [[nodiscard]] std::size_t all() const { return stale + up_to_date + baked + failed + cancelled; }
};
[[nodiscard]] RecipeCounts countAssets(const std::vector<AssetResult>& assets);

/// "12 assets: 3 baked, 8 up to date, 1 failed; 1.2 MB; 4.5 s", or "12 assets up to date".
[[nodiscard]] std::string recipeSummary(const RecipeCounts& counts, double ms);

/// asset, mesh, state, reason, ms, bytes, hash, inputs, warnings, code and error: those that apply.
[[nodiscard]] nlohmann::ordered_json jsonAsset(const AssetResult& asset);
[[nodiscard]] nlohmann::ordered_json jsonCounts(const RecipeCounts& counts);

/// asset, mesh, state, bytes, and reason where it stays.
[[nodiscard]] nlohmann::ordered_json jsonPruned(const PrunedOutput& output, bool dry_run);
/// "removed, as the recipe no longer names it", or why it stays.
[[nodiscard]] std::string prunedReason(const PrunedOutput& output, bool dry_run);

/// Lines of JSON, each written as it happens.
class RecipeEvents {
  public:
    /// \param path  a log of an earlier run is emptied; "-": standard output.
    /// Errors: kIo; kUsage: it is another kind of file, whose contents would be lost: what meshes refer to is not known
    /// before they are read.
    [[nodiscard]] Result<void> open(const std::string& path);
    /// Does nothing if open() was not called. What cannot be written is told by finish().
    void write(const nlohmann::ordered_json& event);
    /// Errors: kIo: an event could not be written.
    [[nodiscard]] Result<void> finish() const;

  private:
    std::string path_;
    Descriptor file_;
    int fd_ = -1;  ///< file_, or standard output
    int error_ = 0;
};

/// On a terminal one line that is drawn again, elsewhere a line for each asset that was baked; on standard
/// error.
class RecipeDisplay {
  public:
    /// \param wanted  false: draws nothing.
    RecipeDisplay(std::size_t assets, bool wanted);
    RecipeDisplay(const RecipeDisplay&) = delete;
    RecipeDisplay& operator=(const RecipeDisplay&) = delete;
    ~RecipeDisplay();

    void started(const AssetResult& asset);
    void ended(const AssetResult& asset);
    /// Now and then: tells what takes long, its first time after half a minute, and then each time that it has taken twice
    /// as long.
    void tick();
    /// Wipes the line, so that something else can be written.
    void wipe();

  private:
    static constexpr double kLong = 30'000.0;  // ms
    struct Running {
        std::string name;
        Stopwatch watch = {};
        double tell_ms = kLong;
    };
    void draw();
    [[nodiscard]] std::string place() const;

    std::size_t assets_;
    bool wanted_;
    bool terminal_;
    bool drawn_ = false;
    std::size_t done_ = 0;
    std::size_t failed_ = 0;
    std::vector<Running> running_;
};

/// "2 assets (a.relief, b.relief): it is skinned": the warnings, one line each, in the order of the assets; one that several
/// have is told once, that of a missing unit too, with the size of the first.
[[nodiscard]] std::vector<std::string> warningLines(const std::vector<AssetResult>& assets);

/// "the slowest: a.relief 12.3 s, b.relief 4.0 s": up to three that were baked and took more than twice the median; "" where
/// none did.
[[nodiscard]] std::string slowestText(const std::vector<AssetResult>& assets);

}  // namespace relief

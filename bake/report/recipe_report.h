// The reports of a run of a recipe: events for programs while it runs, and its end for both people and programs.
#pragma once

#include <array>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <variant>
#include <vector>

#include "bake/recipe/recipe_run.h"
#include "bake/report/bake_report.h"
#include "formats/base/descriptor.h"

namespace relief {

struct RecipeCounts {
    std::array<std::size_t, kWordsOf<AssetState>.size()> of_state{};
    std::uint64_t bytes = 0;  ///< of the outputs that are up to date now

    [[nodiscard]] std::size_t of(AssetState state) const { return of_state[static_cast<std::size_t>(state)]; }
    [[nodiscard]] std::size_t all() const;
};
[[nodiscard]] RecipeCounts countAssets(const std::vector<AssetResult>& assets);

/// "baked, 255 kB, 0.8 s"
[[nodiscard]] std::string bakedText(const AssetResult& asset);

/// "12 assets: 3 baked, 8 up to date, 1 failed; 1.2 MB; 4.5 s", or "12 assets up to date".
[[nodiscard]] std::string recipeSummary(const RecipeCounts& counts, double ms);

// --- The same as fields.

/// An asset by its state.
struct AssetReport {
    const AssetResult& asset = kNone<AssetResult>;
    bool event = false;  ///< in an event, which leaves out the key of an asset that was not made

    [[nodiscard]] static std::vector<AssetReport> kinds();
};

template <class Visitor, FieldsOf<AssetReport> R>
void fields(Visitor& visit, R& report) {
    const AssetResult& asset = report.asset;
    const AssetState state = asset.state;
    const bool made = state == AssetState::kBaked || state == AssetState::kUpToDate;
    const bool failed = state == AssetState::kFailed;
    const bool tried = state == AssetState::kBaked || failed;
    visit("asset", asset.job.output, {"Output, relative to the output folder: a collider, or a world"});
    visit("mesh", asset.job.mesh, {"Its mesh, level or height map, relative to the folder of the recipe"});
    visit("state", wordOf(state),
          {.help = "State of the asset", .words = {&kWordsOf<AssetState>[std::size_t(state)], 1}});
    if (state != AssetState::kUpToDate) {
        visit("reason", asset.reason, {"Reason why it is not up to date"});
    }
    if (tried) {
        visit("ms", asset.ms, {"Time", "ms", kFromZero});
    }
    if (made) {
        visit("bytes", asset.bytes, {"Size of the output, with its containers", "bytes"});
        visit("hash", asset.hash,
              {.help = "XXH3-128 of the output; that of a world has those of its containers",
               .pattern = kHashPattern});
        visit("containers", asset.containers,
              {.help = "Containers of a world, relative to the output folder", .left_out = true});
        visit("inputs", asset.inputs, {.help = "All files that it was made from", .items = kFromOne});
    }
    if (made || !report.event) {
        visit("key", asset.key,
              {.help = "XXH3-128 of the program, the options and the inputs: equal keys mean equal outputs",
               .pattern = "^[0-9a-f]{32}$",
               .left_out = !made});
    }
    if (failed) {
        visit("code", static_cast<int>(asset.error.code), {"Exit code", {}, {1.0, 7.0}});
        visit("error", asset.error.message, {"One line for people"});
    }
    if (tried) {
        visit("warnings", asset.warnings, {.help = "Warnings, one line each", .left_out = true});
    }
}

template <class Visitor, FieldsOf<RecipeCounts> C>
void fields(Visitor& visit, C& counts) {
    visit("assets", counts.all(), {"All assets"});
    visit("stale", counts.of(AssetState::kStale), {"Assets to be baked, in a dry run"});
    visit("baked", counts.of(AssetState::kBaked), {"Assets baked"});
    visit("up_to_date", counts.of(AssetState::kUpToDate), {"Assets not baked because nothing changed"});
    visit("failed", counts.of(AssetState::kFailed), {"Assets that failed"});
    visit("cancelled", counts.of(AssetState::kCancelled), {"Assets not baked because the run ended before"});
    visit("bytes", counts.bytes, {"Size of all outputs that are up to date now", "bytes"});
}

/// "2/4"; null without --shard.
[[nodiscard]] std::optional<std::string> shardText(const std::optional<Shard>& shard);
inline constexpr FieldInfo kShardField{.help = "--shard; null without it", .pattern = "^[0-9]+/[0-9]+$"};

/// `relief bake --recipe --json`
struct RecipeJson {
    std::string recipe;
    std::string output;
    std::optional<Shard> shard;
    RecipeCounts counts = {};
    double ms = 0.0;
    std::vector<AssetReport> assets = {};
};

template <class Visitor, FieldsOf<RecipeJson> R>
void fields(Visitor& visit, R& report) {
    visit("recipe", report.recipe, {"Recipe as given"});
    visit("output", report.output, {"Output folder"});
    visit("shard", shardText(report.shard), kShardField);
    visit("counts", report.counts, {"Numbers of assets"});
    visit("ms", report.ms, {"Time of the whole run", "ms", kFromZero});
    visit("assets", report.assets, {"Assets, in the order of the recipe"});
}

// --- Events

struct RecipeStart {
    std::string recipe;
    std::size_t assets = 0;
    std::optional<Shard> shard;
    unsigned at_once = 1;
};

template <class Visitor, FieldsOf<RecipeStart> S>
void fields(Visitor& visit, S& start) {
    visit("event", "start", {.help = "The first line", .words = kWords<"start">});
    visit("tool", std::string("relief ") + RELIEF_VERSION, {"Name and version of the program"});
    visit("recipe", start.recipe, {"Recipe as given"});
    visit("assets", start.assets, {"All assets"});
    visit("shard", shardText(start.shard), kShardField);
    visit("at_once", start.at_once, {"Assets baked at the same time", {}, kFromOne});
}

struct AssetEvent {
    AssetReport asset = {};

    [[nodiscard]] static std::vector<AssetEvent> kinds();
};

template <class Visitor, FieldsOf<AssetEvent> E>
void fields(Visitor& visit, E& event) {
    static constexpr auto kEvents =
        kWords<"started", "skipped", "done", "failed", "cancelled">;  // as in AssetState
    const auto& word = kEvents[static_cast<std::size_t>(event.asset.asset.state)];
    visit("event", word, {.help = "Kind of event", .words = {&word, 1}});
    fields(visit, event.asset);
}

struct RecipeEnd {
    RecipeCounts counts = {};
    double ms = 0.0;
    int signal = 0;  ///< 0: none
};

template <class Visitor, FieldsOf<RecipeEnd> E>
void fields(Visitor& visit, E& end) {
    visit("event", "summary", {.help = "The last line", .words = kWords<"summary">});
    fields(visit, end.counts);
    visit("ms", end.ms, {"Time of the whole run", "ms", kFromZero});
    visit("signal", onlyIf(end.signal != 0, end.signal),
          {"Signal that ended the run; null if none did", {}, kFromOne});
}

using RecipeEvent = std::variant<RecipeStart, AssetEvent, RecipeEnd>;

/// Lines of JSON, each written as it happens.
class RecipeEvents {
  public:
    /// \param path  a log of an earlier run is emptied; "-": standard output
    /// Errors: kIo; kUsage: a file of another kind, whose contents would be lost.
    [[nodiscard]] Result<void> open(const std::string& path);
    /// Does nothing without open(). finish() reports errors.
    void write(const RecipeEvent& event);
    /// Errors: kIo: an event could not be written.
    [[nodiscard]] Result<void> finish() const;

  private:
    std::string path_;
    Descriptor file_;
    int fd_ = -1;  ///< file_, or standard output
    int error_ = 0;
};

/// Warnings of one of many bakes.
struct OwnWarnings {
    std::string owner;  ///< that a line names
    std::string mesh;   ///< with which a warning may begin
    std::span<const std::string> warnings;
};
/// One line for those that are equal, in the order of the first. \param owners  "assets" \param join_numbers  numbers may differ
[[nodiscard]] std::vector<std::string> warningLines(std::span<const OwnWarnings> all, std::string_view owners,
                                                    bool join_numbers);
/// "2 assets (a.relief, b.relief): it is skinned": the warnings, one line each, in the order of the assets; one that several
/// have is told once, that of a missing unit too, with the size of the first.
[[nodiscard]] std::vector<std::string> warningLines(const std::vector<AssetResult>& assets);

}  // namespace relief

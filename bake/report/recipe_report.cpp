// SPDX-License-Identifier: Apache-2.0
#include "bake/report/recipe_report.h"

#include <fcntl.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <cerrno>
#include <csignal>
#include <numeric>
#include <span>

#include "bake/verdict/report_text.h"
#include "formats/base/file_io.h"
#include "formats/base/text.h"
#include "formats/fields/json.h"

namespace relief {
namespace {

std::string seconds(double ms) {
    return formatted("%.1f s", ms / 1000.0);
}

/// Fails if a file that will be truncated does not start with an event.
Result<void> checkOlderLog(const std::string& path) {
    constexpr std::string_view kBegin = R"({"event":)";
    std::error_code error;
    if (!std::filesystem::is_regular_file(path, error) || std::filesystem::file_size(path, error) == 0) {
        return {};
    }
    std::array<char, kBegin.size()> begin{};
    const Descriptor file(openRetry(path.c_str(), O_RDONLY));
    if (file && ::read(file.get(), begin.data(), begin.size()) == static_cast<ssize_t>(begin.size()) &&
        std::string_view(begin.data(), begin.size()) == kBegin) {
        return {};
    }
    return fail(ErrorCode::kUsage, quotedPath(path) +
                                       " is not an event log, and would be overwritten; remove it, or "
                                       "give --events another file");
}

void shardField(FieldVisitor& visit, const std::optional<Shard>& shard) {
    visit("shard",
          shard ? std::optional(std::to_string(shard->index) + "/" + std::to_string(shard->count))
                : std::nullopt,
          {.help = "--shard; null without it", .pattern = "^[0-9]+/[0-9]+$"});
}

}  // namespace

std::size_t RecipeCounts::all() const {
    return std::accumulate(of_state.begin(), of_state.end(), std::size_t{0});
}

RecipeCounts countAssets(const std::vector<AssetResult>& assets) {
    RecipeCounts counts;
    for (const AssetResult& asset : assets) {
        ++counts.of_state[static_cast<std::size_t>(asset.state)];
        counts.bytes += asset.bytes;
    }
    return counts;
}

std::string bakedText(const AssetResult& asset) {
    return "baked, " + bytesText(asset.bytes) + ", " +
           (asset.wrong_percent ? percentText(*asset.wrong_percent) + " wrong, " : "") + seconds(asset.ms);
}

std::string recipeSummary(const RecipeCounts& counts, double ms) {
    const std::string assets = countText(counts.all(), "asset");
    if (counts.of(AssetState::kUpToDate) == counts.all()) {
        return assets + " up to date";
    }
    std::string text;
    const auto add = [&](AssetState state, const char* words) {
        if (const std::size_t count = counts.of(state); count > 0) {
            text += (text.empty() ? ": " : ", ") + std::to_string(count) + " " + words;
        }
    };
    add(AssetState::kStale, "to bake");
    add(AssetState::kBaked, "baked");
    add(AssetState::kUpToDate, "up to date");
    add(AssetState::kFailed, "failed");
    add(AssetState::kCanceled, "not baked");
    return assets + text + "; " + bytesText(counts.bytes) + "; " + seconds(ms);
}

std::vector<AssetReport> AssetReport::kinds() {
    static const auto each = [] {
        std::vector<AssetResult> assets(kWordsOf<AssetState>.size());
        for (std::size_t i = 0; i < assets.size(); ++i) {
            assets[i].state = static_cast<AssetState>(i);
        }
        return assets;
    }();
    return viewsOf<AssetReport>(each);
}

std::vector<AssetEvent> AssetEvent::kinds() {
    std::vector<AssetEvent> events;
    for (const AssetReport& asset : AssetReport::kinds()) {
        events.push_back({{asset.asset, true}});
    }
    return events;
}

// --- Events ---

Result<void> RecipeEvents::open(const std::string& path) {
    // The bakes must continue if the reader of the events exits.
    std::signal(SIGPIPE, SIG_IGN);
    path_ = path;
    if (path != "-") {
        RELIEF_TRY(checkOlderLog(path));
        file_ = Descriptor(openRetry(path.c_str(), O_WRONLY | O_CREAT | O_TRUNC, 0666));
    }
    fd_ = path == "-" ? STDOUT_FILENO : file_.get();
    if (fd_ < 0) {
        return fail(ErrorCode::kIo, "cannot write " + quotedPath(path) + ": " +
                                        std::system_category().message(errno) +
                                        "; give --events another file");
    }
    return {};
}

void RecipeEvents::write(const RecipeEvent& event) {
    if (fd_ < 0 || error_ != 0) {
        return;
    }
    const std::string line = jsonLineOf(event);
    error_ = writeAll(fd_, std::as_bytes(std::span(line)));
}

Result<void> RecipeEvents::finish() const {
    if (error_ != 0) {
        return fail(ErrorCode::kIo,
                    "cannot write events to " + (path_ == "-" ? "standard output" : quotedPath(path_)) +
                        ": " + std::system_category().message(error_) + "; the baked outputs are complete");
    }
    return {};
}

// --- Summary ---

std::vector<std::string> warningLines(std::span<const OwnerWarnings> all, std::string_view owners,
                                      bool join_numbers) {
    constexpr std::size_t kNamed = 3;
    struct Group {
        std::string warning;  // of the first owner
        bool same = true;     // all owners have the same text
        std::vector<std::string> owners;
    };
    const auto words = [](std::string text) {
        std::erase_if(text, [](char c) { return (c >= '0' && c <= '9') || c == '.'; });
        return text;
    };
    std::vector<Group> groups;
    for (const OwnerWarnings& own : all) {
        // Remove the name of the mesh, with which a warning may start, so that equal warnings match.
        const std::string mesh = own.mesh + ": ";
        for (const std::string& full : own.warnings) {
            const std::string warning = full.starts_with(mesh) ? full.substr(mesh.size()) : full;
            auto group = std::ranges::find_if(groups, [&](const Group& one) {
                return one.warning == warning || (join_numbers && words(one.warning) == words(warning)) ||
                       (one.warning.starts_with(kNoUnit) && warning.starts_with(kNoUnit));
            });
            group = group == groups.end() ? groups.insert(group, {warning, true, {}}) : group;
            group->same = group->same && group->warning == warning;
            group->owners.push_back(own.owner);
        }
    }
    std::vector<std::string> out;
    for (const Group& group : groups) {
        const std::size_t count = group.owners.size();
        const std::vector<std::string_view> named(group.owners.begin(),
                                                  group.owners.begin() + std::min(count, kNamed));
        const std::string more = count > kNamed ? ", and " + std::to_string(count - kNamed) + " more" : "";
        out.push_back((count == 1 ? group.owners.front()
                                  : std::to_string(count) + " " + std::string(owners) + " (" + listed(named) +
                                        more + ")") +
                      ": " + (group.same ? "" : "first of several: ") + group.warning);
    }
    return out;
}

std::vector<std::string> warningLines(const std::vector<AssetResult>& assets) {
    std::vector<OwnerWarnings> all;
    for (const AssetResult& asset : assets) {
        all.push_back({cleanUtf8(asset.job.output),
                       cleanUtf8(std::filesystem::path(asset.job.mesh).filename().string()), asset.warnings});
    }
    return warningLines(all, "assets", false);
}

void fields(FieldVisitor& visit, const AssetReport& report) {
    const AssetResult& asset = report.asset;
    const AssetState state = asset.state;
    const bool made = state == AssetState::kBaked || state == AssetState::kUpToDate;
    const bool failed = state == AssetState::kFailed;
    const bool tried = state == AssetState::kBaked || failed;
    visit("asset", asset.job.output, {"Output, relative to the output folder: a collider, or a world"});
    visit("mesh", asset.job.mesh, {"Mesh, level or height map, relative to the recipe's folder"});
    visit("state", wordOf(state),
          {.help = "State of the asset", .words = {&kWordsOf<AssetState>[std::size_t(state)], 1}});
    if (state != AssetState::kUpToDate) {
        visit("reason", asset.reason, {"Why it is not up to date"});
    }
    if (tried) {
        visit("ms", asset.ms, {"Time", "ms", kFromZero});
    }
    if (made) {
        visit("bytes", asset.bytes, {"Size of the output, including its containers", "bytes"});
        visit("wrong_percent", asset.wrong_percent,
              {"Points near the surface that are on the wrong side; for a world, those of its worst "
               "collider; null if any was not measured",
               "%", kPercentRange});
        visit("hash", asset.hash,
              {.help = "XXH3-128 of the output; for a world, it covers the containers",
               .pattern = kHashPattern});
        visit("containers", asset.containers,
              {.help = "Containers of a world, relative to the output folder", .left_out = true});
        visit("inputs", asset.inputs, {.help = "All input files", .items = kFromOne});
    }
    if (made || !report.event) {
        visit("key", asset.key,
              {.help = "XXH3-128 of the program, the options and the inputs: equal keys mean equal outputs",
               .pattern = "^[0-9a-f]{32}$",
               .left_out = !made});
    }
    if (failed) {
        visit("code", static_cast<int>(asset.error.code), {"Exit code", {}, {1.0, 7.0}});
        visit("error", asset.error.message, {"Error message in one line"});
    }
    if (tried) {
        visit("warnings", asset.warnings, {.help = "Warnings, one line each", .left_out = true});
    }
}

void fields(FieldVisitor& visit, const RecipeCounts& counts) {
    visit("assets", counts.all(), {"Number of assets"});
    visit("stale", counts.of(AssetState::kStale), {"Assets to be baked, in a dry run"});
    visit("baked", counts.of(AssetState::kBaked), {"Assets baked"});
    visit("up_to_date", counts.of(AssetState::kUpToDate), {"Assets that were already up to date"});
    visit("failed", counts.of(AssetState::kFailed), {"Assets that failed"});
    visit("canceled", counts.of(AssetState::kCanceled), {"Assets not baked because the run ended early"});
    visit("bytes", counts.bytes, {"Size of all outputs that are up to date", "bytes"});
}

void fields(FieldVisitor& visit, const RecipeJson& report) {
    visit("recipe", report.recipe, {"Recipe, as on the command line"});
    visit("output", report.output, {"Output folder"});
    shardField(visit, report.shard);
    visit("counts", report.counts, {"Assets by state"});
    visit("ms", report.ms, {"Time of the whole run", "ms", kFromZero});
    visit("assets", report.assets, {"Assets, in the order of the recipe"});
}

void fields(FieldVisitor& visit, const RecipeStart& start) {
    visit("event", "run_started", {.help = "The first line", .words = kWords<"run_started">});
    toolField(visit);
    visit("recipe", start.recipe, {"Recipe, as on the command line"});
    visit("assets", start.assets, {"Number of assets"});
    shardField(visit, start.shard);
    visit("jobs", start.jobs, {"Assets baked at the same time", {}, kFromOne});
}

void fields(FieldVisitor& visit, const AssetEvent& event) {
    static constexpr auto kEvents =
        kWords<"started", "skipped", "done", "failed", "canceled">;  // as in AssetState
    const auto& word = kEvents[static_cast<std::size_t>(event.asset.asset.state)];
    visit("event", word, {.help = "Kind of event", .words = {&word, 1}});
    fields(visit, event.asset);
}

void fields(FieldVisitor& visit, const RecipeEnd& end) {
    visit("event", "summary", {.help = "The last line", .words = kWords<"summary">});
    fields(visit, end.counts);
    visit("ms", end.ms, {"Time of the whole run", "ms", kFromZero});
    visit("signal", onlyIf(end.signal != 0, end.signal),
          {"Signal that ended the run; null if none did", {}, kFromOne});
}

}  // namespace relief

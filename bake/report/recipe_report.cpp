#include "bake/report/recipe_report.h"

#include <fcntl.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <cerrno>
#include <csignal>
#include <cstdio>
#include <numeric>
#include <span>

#include "bake/report/report_text.h"
#include "formats/base/file_io.h"
#include "formats/base/text.h"
#include "formats/fields/json.h"

namespace relief {
namespace {

std::string seconds(double ms) {
    char text[32];
    std::snprintf(text, sizeof(text), "%.1f s", ms / 1000.0);
    return text;
}

/// Whether a file that will be emptied holds nothing but events.
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
                                       " holds no events of an earlier run, and would be lost; remove it, or "
                                       "give --events another file");
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
    return "baked, " + bytesText(asset.bytes) + ", " + seconds(asset.ms);
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
    add(AssetState::kCancelled, "not baked");
    return assets + text + "; " + bytesText(counts.bytes) + "; " + seconds(ms);
}

std::optional<std::string> shardText(const std::optional<Shard>& shard) {
    return shard ? std::optional(std::to_string(shard->index) + "/" + std::to_string(shard->count))
                 : std::nullopt;
}

std::vector<AssetReport> AssetReport::kinds() {
    static const auto each = [] {
        std::array<AssetResult, kWordsOf<AssetState>.size()> assets;
        for (std::size_t i = 0; i < assets.size(); ++i) {
            assets[i].state = static_cast<AssetState>(i);
        }
        return assets;
    }();
    std::vector<AssetReport> reports;
    for (const AssetResult& asset : each) {
        reports.push_back({asset});
    }
    return reports;
}

std::vector<AssetEvent> AssetEvent::kinds() {
    std::vector<AssetEvent> events;
    for (const AssetReport& asset : AssetReport::kinds()) {
        events.push_back({{asset.asset, true}});
    }
    return events;
}

// --- events ---

Result<void> RecipeEvents::open(const std::string& path) {
    // A reader that goes away must not take the bakes with it.
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
    const std::string line = jsonLine(jsonOf(event));
    error_ = writeAll(fd_, std::as_bytes(std::span(line)));
}

Result<void> RecipeEvents::finish() const {
    if (error_ != 0) {
        return fail(ErrorCode::kIo,
                    "cannot write events to " + (path_ == "-" ? "standard output" : quotedPath(path_)) +
                        ": " + std::system_category().message(error_) + "; what was baked is in place");
    }
    return {};
}

// --- at the end ---

std::vector<std::string> warningLines(const std::vector<AssetResult>& assets) {
    constexpr std::size_t kNamed = 3;
    struct Group {
        std::string warning;  // of the first
        std::vector<std::string> assets;
    };
    std::vector<Group> groups;
    for (const AssetResult& asset : assets) {
        // Warnings begin with the mesh's name, which would tell equal ones apart.
        const std::string mesh = cleanUtf8(std::filesystem::path(asset.job.mesh).filename().string()) + ": ";
        for (const std::string& full : asset.warnings) {
            const std::string warning = full.starts_with(mesh) ? full.substr(mesh.size()) : full;
            // Only the size of the box differs where no unit is named.
            auto group = std::ranges::find_if(groups, [&](const Group& one) {
                return one.warning == warning ||
                       (one.warning.starts_with(kNoUnit) && warning.starts_with(kNoUnit));
            });
            group = group == groups.end() ? groups.insert(group, {warning, {}}) : group;
            group->assets.push_back(cleanUtf8(asset.job.output));
        }
    }
    std::vector<std::string> out;
    for (const Group& group : groups) {
        const std::size_t count = group.assets.size();
        const std::vector<std::string_view> named(group.assets.begin(),
                                                  group.assets.begin() + std::min(count, kNamed));
        const std::string more = count > kNamed ? ", and " + std::to_string(count - kNamed) + " more" : "";
        const std::string first = count > 1 && group.warning.starts_with(kNoUnit) ? "of the first: " : "";
        out.push_back((count == 1 ? group.assets.front()
                                  : std::to_string(count) + " assets (" + listed(named) + more + ")") +
                      ": " + first + group.warning);
    }
    return out;
}

}  // namespace relief

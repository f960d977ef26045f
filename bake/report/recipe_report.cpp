#include "bake/report/recipe_report.h"

#include <fcntl.h>
#include <sys/ioctl.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <cerrno>
#include <csignal>
#include <cstdio>
#include <cstdlib>
#include <cstring>
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

/// Whether lines can be drawn again where standard error goes.
bool canRedraw() {
    const char* terminal = std::getenv("TERM");
    return ::isatty(STDERR_FILENO) == 1 && terminal != nullptr && std::strcmp(terminal, "dumb") != 0;
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

std::string prunedReason(const PrunedOutput& output, bool dry_run) {
    return output.kept.empty()
               ? std::string(dry_run ? "to be removed" : "removed") + ", as the recipe no longer names it"
               : "the recipe no longer names it, but it stays: " + output.kept + "; remove it yourself";
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

std::vector<PrunedReport> PrunedReport::kinds() {
    static const PrunedOutput kept{.output = "", .mesh = "", .kept = "changed"};
    return {{}, {kept}};
}

std::vector<AssetEvent> AssetEvent::kinds() {
    std::vector<AssetEvent> events;
    for (const AssetReport& asset : AssetReport::kinds()) {
        events.push_back({{asset.asset, true}});
    }
    return events;
}

std::vector<PrunedEvent> PrunedEvent::kinds() {
    return {{{}}, {PrunedReport::kinds().back()}};
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

// --- the display ---

RecipeDisplay::RecipeDisplay(std::size_t assets, bool wanted)
    : assets_(assets), wanted_(wanted), terminal_(wanted && canRedraw()) {}

RecipeDisplay::~RecipeDisplay() {
    wipe();
}

void RecipeDisplay::started(const AssetResult& asset) {
    running_.push_back({cleanUtf8(asset.job.output)});
    draw();
}

void RecipeDisplay::ended(const AssetResult& asset) {
    const std::string name = cleanUtf8(asset.job.output);
    const auto found =
        std::find_if(running_.begin(), running_.end(), [&](const Running& one) { return one.name == name; });
    if (found != running_.end()) {
        running_.erase(found);
    }
    ++done_;
    failed_ += asset.state == AssetState::kFailed ? 1 : 0;
    if (wanted_ && !terminal_ && asset.state == AssetState::kBaked) {
        std::fprintf(stderr, "%s %s: baked, %s, %s\n", place().c_str(), name.c_str(),
                     bytesText(asset.bytes).c_str(), seconds(asset.ms).c_str());
    }
    draw();
}

void RecipeDisplay::tick() {
    for (Running& one : running_) {
        const double ms = one.watch.ms();
        if (wanted_ && !terminal_ && ms >= one.tell_ms) {
            std::fprintf(stderr, "%s %s: still baking, %s\n", place().c_str(), one.name.c_str(),
                         seconds(ms).c_str());
            one.tell_ms = 2.0 * one.tell_ms;
        }
    }
    draw();
}

std::string RecipeDisplay::place() const {
    return "[" + std::to_string(done_) + "/" + std::to_string(assets_) + "]";
}

void RecipeDisplay::wipe() {
    if (drawn_) {
        std::fputs("\r\033[K", stderr);
        drawn_ = false;
    }
}

void RecipeDisplay::draw() {
    if (!terminal_) {
        return;
    }
    std::string line = place();
    if (failed_ > 0) {
        line += " " + std::to_string(failed_) + " failed";
    }
    for (std::size_t i = 0; i < running_.size(); ++i) {
        line += (i == 0 ? " baking " : ", ") + running_[i].name;
        if (running_[i].watch.ms() >= kLong / 10.0) {
            line += " (" + seconds(running_[i].watch.ms()) + ")";
        }
    }
    winsize size{};
    const std::size_t columns =
        ::ioctl(STDERR_FILENO, TIOCGWINSZ, &size) == 0 && size.ws_col > 1 ? size.ws_col - 1U : 79U;
    std::fprintf(stderr, "\r%s\033[K", cleanUtf8(line, columns).c_str());
    std::fflush(stderr);
    drawn_ = true;
}

// --- at the end ---

std::vector<std::string> warningLines(const std::vector<AssetResult>& assets) {
    constexpr std::size_t kNamed = 3;
    struct Group {
        std::string warning;  // of the first
        std::string_view kind;
        std::vector<std::string> assets;
    };
    std::vector<Group> groups;
    for (const AssetResult& asset : assets) {
        // Warnings begin with the mesh's name, which would tell equal ones apart.
        const std::string mesh = cleanUtf8(std::filesystem::path(asset.job.mesh).filename().string()) + ": ";
        for (const std::string& said : asset.warnings) {
            const std::string warning = said.starts_with(mesh) ? said.substr(mesh.size()) : said;
            // Only the size of the box differs.
            const std::string_view kind = warning.starts_with(kNoUnit) ? kNoUnit : "";
            auto group = std::find_if(groups.begin(), groups.end(), [&](const Group& one) {
                return one.warning == warning || (!kind.empty() && one.kind == kind);
            });
            if (group == groups.end()) {
                groups.push_back({warning, kind, {}});
                group = groups.end() - 1;
            }
            group->assets.push_back(cleanUtf8(asset.job.output));
        }
    }
    std::vector<std::string> out;
    for (const Group& group : groups) {
        const std::size_t count = group.assets.size();
        std::string names;
        for (std::size_t i = 0; i < std::min(count, kNamed); ++i) {
            names += (i == 0 ? "" : ", ") + group.assets[i];
        }
        if (count > kNamed) {
            names += ", and " + std::to_string(count - kNamed) + " more";
        }
        const std::string whose = count > 1 && !group.kind.empty() ? "of the first: " : "";
        out.push_back((count == 1 ? names : std::to_string(count) + " assets (" + names + ")") + ": " +
                      whose + group.warning);
    }
    return out;
}

std::string slowestText(const std::vector<AssetResult>& assets) {
    std::vector<const AssetResult*> baked;
    for (const AssetResult& asset : assets) {
        if (asset.state == AssetState::kBaked) {
            baked.push_back(&asset);
        }
    }
    std::stable_sort(baked.begin(), baked.end(),
                     [](const AssetResult* a, const AssetResult* b) { return a->ms > b->ms; });
    std::string text;
    for (std::size_t i = 0; i < std::min<std::size_t>(baked.size(), 3); ++i) {
        if (baked[i]->ms > 2.0 * baked[baked.size() / 2]->ms) {
            text += (text.empty() ? "the slowest: " : ", ") + cleanUtf8(baked[i]->job.output) + " " +
                    seconds(baked[i]->ms);
        }
    }
    return text;
}

}  // namespace relief

// SPDX-License-Identifier: Apache-2.0
#include "bake/recipe/glob.h"

#include <fnmatch.h>

#include <algorithm>
#include <system_error>

#include "formats/base/file_io.h"
#include "formats/base/text.h"

namespace relief {
namespace {

namespace fs = std::filesystem;

constexpr std::size_t kPartsMax = 64;
constexpr std::size_t kNamesMax = 1'000'000;
constexpr std::size_t kFilesMax = 100'000;
constexpr std::string_view kFolders = "**";

}  // namespace

Result<GlobPattern> GlobPattern::parse(std::string_view text) {
    if (text.find('\0') != std::string_view::npos) {
        return invalidInput("contains a zero byte; remove it");
    }
    if (text.starts_with('/')) {
        return invalidInput("is an absolute path; write it relative to the recipe's folder");
    }
    GlobPattern pattern;
    for (const std::string_view part : split(text, '/')) {
        if (part.empty() || part == ".") {
            continue;
        }
        if (part == "..") {
            return invalidInput("leaves the recipe's folder; name files below it");
        }
        // Consecutive ** are equivalent to one.
        if (part != kFolders || pattern.parts_.empty() || pattern.parts_.back() != kFolders) {
            pattern.parts_.emplace_back(part);
        }
        pattern.wild_ = pattern.wild_ || part.find_first_of("*?[\\") != std::string_view::npos;
    }
    pattern.of_folders_ = text.ends_with('/');
    if (pattern.parts_.empty()) {
        return invalidInput("names no file; write a file or a pattern such as rocks/*.obj");
    }
    if (pattern.parts_.back() == kFolders) {
        return invalidInput("ends with **, which matches folders; write **/* for the files in them");
    }
    if (pattern.parts_.size() > kPartsMax) {
        return fail(ErrorCode::kLimit,
                    "has more than " + std::to_string(kPartsMax) + " parts; use a shorter path");
    }
    return pattern;
}

// state[i]: the parts before i have matched the names so far, and part i may come next. All alternatives are followed
// at once, so that no pattern takes exponential time.
GlobPattern::State GlobPattern::start() const {
    State state(parts_.size() + 1, false);
    state[0] = true;
    if (parts_[0] == kFolders) {
        state[1] = true;
    }
    return state;
}

GlobPattern::State GlobPattern::step(const State& state, const char* name, bool link) const {
    State next(state.size(), false);
    for (std::size_t i = 0; i < parts_.size(); ++i) {
        if (!state[i]) {
            continue;
        }
        if (parts_[i] == kFolders) {
            next[i] = next[i] || (name[0] != '.' && !link);
        } else if (::fnmatch(parts_[i].c_str(), name, FNM_PERIOD) == 0) {
            next[i + 1] = true;
        }
    }
    for (std::size_t i = 0; i < parts_.size(); ++i) {
        if (next[i] && parts_[i] == kFolders) {
            next[i + 1] = true;
        }
    }
    return next;
}

bool GlobPattern::matches(std::string_view path) const {
    State state = start();
    for (const std::string_view name : split(path, '/')) {
        state = step(state, std::string(name).c_str(), false);
    }
    return accepts(state);
}

Result<GlobResult> globFiles(const fs::path& folder, const GlobPattern& pattern) {
    struct Pending {
        std::string path;  // relative to `folder`, with a trailing slash unless empty
        GlobPattern::State state;
        std::size_t depth;
    };
    GlobResult result;
    const auto take = [&](std::string name) {
        result.files.push_back(std::move(name));
        return result.files.size() <= kFilesMax;
    };
    std::vector<Pending> pending{{"", pattern.start(), 0}};
    std::size_t names = 0;
    const auto tooMuch = [](const std::string& what) {
        return fail(ErrorCode::kLimit, what + "; use a smaller folder");
    };
    while (!pending.empty()) {
        const Pending here = std::move(pending.back());
        pending.pop_back();
        result.folders.push_back(here.path.empty() ? "" : here.path.substr(0, here.path.size() - 1));
        const fs::path full = (folder.empty() ? fs::path(".") : folder) / here.path;
        std::error_code error;
        fs::directory_iterator entry(full, error);
        for (; !error && entry != fs::directory_iterator(); entry.increment(error)) {
            if (++names > kNamesMax) {
                return tooMuch("it visits more than " + std::to_string(kNamesMax) + " names");
            }
            const std::string name = entry->path().filename().string();
            std::error_code none;  // an inaccessible name is neither a file nor a folder
            const bool is_folder = entry->is_directory(none);
            GlobPattern::State next =
                pattern.step(here.state, name.c_str(), is_folder && entry->is_symlink(none));
            const bool accepted = pattern.accepts(next) && is_folder == pattern.ofFolders() &&
                                  (is_folder || entry->is_regular_file(none));
            if (accepted && !take(here.path + name)) {
                return tooMuch("it matches more than " + std::to_string(kFilesMax) + " files");
            }
            if (is_folder) {
                if (std::find(next.begin(), next.end() - 1, true) == next.end() - 1) {
                    continue;
                }
                if (here.depth == kPartsMax) {
                    return tooMuch("its folders are nested more than " + std::to_string(kPartsMax) + " deep");
                }
                pending.push_back({here.path + name + "/", std::move(next), here.depth + 1});
            }
        }
        if (error) {
            return fail(ErrorCode::kIo, "cannot read " + quotedPath(full) + ": " + error.message() +
                                            "; check its permissions");
        }
    }
    std::sort(result.files.begin(), result.files.end());
    std::sort(result.folders.begin(), result.folders.end());
    return result;
}

}  // namespace relief

// SPDX-License-Identifier: Apache-2.0
#include "formats/base/file_guard.h"

#include <sys/stat.h>
#include <unistd.h>

#include <algorithm>
#include <optional>
#include <string_view>
#include <system_error>
#include <utility>

#include "formats/base/file_io.h"
#include "formats/base/text.h"

namespace relief {
namespace {

namespace fs = std::filesystem;

std::string shown(const fs::path& path, const char* standard) {
    return path == "-" ? standard : quotedPath(path);
}

/// Returns the location of a symbolic link; nullopt for other files.
std::optional<std::string> placeOfLink(const fs::path& path) {
    std::error_code error;
    if (!fs::is_symlink(fs::symlink_status(path, error))) {
        return std::nullopt;
    }
    const fs::path folder = path.parent_path();
    const fs::path real = destination(folder.empty() ? "." : folder, error);
    return error ? std::nullopt : std::optional((real / path.filename()).native());
}

/// \param folder  may be empty, which is within no folder.
bool isWithin(const fs::path& folder, const fs::path& outer) {
    std::error_code error;
    return !folder.empty() &&
           (destination(folder, error) / "").native().starts_with((destination(outer, error) / "").native());
}

/// Rejects links that leave the folder: a run that fills a folder must not write outside it.
Result<void> checkLink(const fs::path& path, const fs::path& folder, std::string_view option) {
    std::error_code error;
    return fs::is_symlink(fs::symlink_status(path, error)) && !isWithin(path, folder)
               ? fail(ErrorCode::kUsage, quotedPath(path) + " of " + std::string(option) +
                                             " is a link that leads out of its folder; remove it")
               : Result<void>();
}

}  // namespace

FileGuard::Keys FileGuard::keysOf(const fs::path& path, int standard) {
    const std::optional<int> descriptor = path == "-" ? std::optional(standard) : descriptorOf(path);
    Keys keys;
    struct stat status {};
    const bool exists = (descriptor ? ::fstat(*descriptor, &status) : ::stat(path.c_str(), &status)) == 0;
    if (exists && S_ISREG(status.st_mode)) {
        keys.push_back(std::to_string(status.st_dev) + ":" + std::to_string(status.st_ino));
    }
    if (descriptor) {
        if (standard == STDOUT_FILENO && descriptor == STDOUT_FILENO) {
            keys.emplace_back("-");
        }
    } else if (!exists || S_ISREG(status.st_mode) || S_ISDIR(status.st_mode)) {
        if (auto link = placeOfLink(path); link) {
            keys.insert(keys.begin(), *std::move(link));
        }
        std::error_code error;
        const fs::path place = destination(path, error);
        keys.push_back(error ? path.native() : place.native());
    }
    return keys;
}

std::optional<FileGuard::File> FileGuard::find(const Keys& keys) const {
    for (const std::string& key : keys) {
        if (const auto known = by_key_.find(key); known != by_key_.end()) {
            return files_[known->second];
        }
        const fs::path place = key;
        const auto [begin, end] = series_.equal_range(place.parent_path().native());
        for (auto at = begin; at != end; ++at) {
            const auto& [folder, holds] = at->second;
            if (holds(place.filename().native())) {
                return File{folder.path / place.filename(), folder.option, Use::kOneOfMany};
            }
        }
    }
    return std::nullopt;
}

void FileGuard::add(const Keys& keys, File file) {
    for (const std::string& key : keys) {
        by_key_.emplace(key, files_.size());
    }
    files_.push_back(std::move(file));
}

Result<void> FileGuard::refusal(const File& file, const File& other) {
    if (file.use == Use::kRead || other.use == Use::kRead) {
        const bool reads = file.use == Use::kRead;
        const File& input = reads ? file : other;
        const File& output = reads ? other : file;
        const std::string name = input.path == output.path ? "" : " " + shown(input.path, "standard input");
        return fail(ErrorCode::kUsage, (output.path == "-" ? "" : "the output ") +
                                           shown(output.path, "standard output") + " is the input" + name +
                                           "; choose another place for " + output.option);
    }
    const bool same = file.path.lexically_normal() == other.path.lexically_normal();
    return fail(ErrorCode::kUsage, "two outputs are the same file: " + other.option + " and " + file.option +
                                       " would both write " + shown(file.path, "standard output") +
                                       (same ? "" : ", which is " + shown(other.path, "standard output")) +
                                       "; choose another place for one of them");
}

Result<void> FileGuard::reads(const fs::path& path) {
    if (path.empty()) {
        return {};
    }
    const Keys keys = keysOf(path, STDIN_FILENO);
    if (const auto other = find(keys); other && other->use != Use::kRead) {
        return refusal({path, "", Use::kRead}, *other);
    }
    add(keys, {path, "", Use::kRead});
    return {};
}

Result<void> FileGuard::writes(const fs::path& path, std::string_view option, const fs::path& made) {
    if (path.empty()) {
        return {};
    }
    if (isWithin(made, path)) {
        return fail(ErrorCode::kIo, "cannot write " + quotedPath(path) + " of " + std::string(option) +
                                        ": the run creates a folder there; name a file");
    }
    const fs::path folder = path.parent_path();
    std::error_code error;
    if (folder.empty() || fs::is_directory(folder, error) || !isWithin(made, folder)) {
        RELIEF_TRY(preflightFile(path, option));
    }
    if (const auto other = claim(path, option)) {
        return refusal({path, std::string(option)}, *other);
    }
    return isWithin(folder, made) ? checkLink(path, made, option) : Result<void>();
}

std::optional<FileGuard::File> FileGuard::claim(const fs::path& path, std::string_view option) {
    const Keys keys = keysOf(path, STDOUT_FILENO);
    if (auto other = find(keys); other || keys.empty()) {
        return other;
    }
    // An output folder, or a parent of one, that does not exist yet.
    const std::string inside = keys.back() + "/";
    for (const auto& series : {series_.find(keys.back()), series_.lower_bound(inside)}) {
        if (series != series_.end() && (series->first + "/").starts_with(inside)) {
            return series->second.folder;
        }
    }
    add(keys, {path, std::string(option)});
    return std::nullopt;
}

FileGuard::MadeFolders::~MadeFolders() {
    for (; !made.empty(); made.pop_back()) {
        ::rmdir(made.back().c_str());  // fails if not empty
    }
}

Result<void> FileGuard::makes(const fs::path& path, std::string_view option) {
    std::error_code error;
    fs::path folder;
    for (const fs::path& part : path) {
        folder /= part;
        if (!fs::exists(folder, error)) {
            folders_->made.push_back(folder);
        }
    }
    return preflightFolder(path, option);
}

Result<void> FileGuard::keeps(const fs::path& path, std::string_view option) {
    const auto link = placeOfLink(path);
    const Keys keys = link ? Keys{*link} : keysOf(path, STDOUT_FILENO);
    File file{path, std::string(option), Use::kKept};
    if (const auto other = find(keys); other && other->use != Use::kKept) {
        return refusal(file, *other);
    }
    add(keys, std::move(file));
    return {};
}

Result<void> FileGuard::writes(const NumberedFiles& files, std::string_view option) {
    return writesSeries(
        files.folder, [files](const std::string& name) { return files.hold(name); }, option);
}

Result<void> FileGuard::writes(const FilesByEnding& files, std::string_view option) {
    const auto holds = [ending = files.ending](const std::string& name) { return name.ends_with(ending); };
    return writesSeries(files.folder, holds, option);
}

Result<void> FileGuard::writesSeries(const fs::path& folder, const HoldsName& holds,
                                     std::string_view option) {
    const File self{folder, std::string(option), Use::kOneOfMany};
    std::error_code error;
    const fs::path real = destination(folder, error);
    if (error) {
        return fail(ErrorCode::kIo, "cannot follow " + quotedPath(folder) + ": " + error.message() +
                                        "; choose another place for " + self.option);
    }
    for (fs::path outer = real; outer.has_relative_path(); outer = outer.parent_path()) {
        if (const auto known = by_key_.find(outer.native());
            known != by_key_.end() && files_[known->second].use != Use::kRead) {
            return refusal(self, files_[known->second]);
        }
    }
    // Files that do not exist yet can only be matched by name.
    const std::string inside = (real / "").native();
    for (auto known = by_key_.lower_bound(inside); known != by_key_.end() && known->first.starts_with(inside);
         ++known) {
        const std::string name = known->first.substr(inside.size());
        if (name.find('/') == std::string::npos && holds(name)) {
            return refusal({folder / name, self.option, self.use}, files_[known->second]);
        }
    }
    std::vector<std::pair<Keys, File>> found;
    for (fs::directory_iterator entry(real, error), end; !error && entry != end; entry.increment(error)) {
        const fs::path name = entry->path().filename();
        if (!holds(name.native())) {
            continue;
        }
        const auto& [keys, file] = found.emplace_back(keysOf(entry->path(), STDOUT_FILENO),
                                                      File{folder / name, self.option, self.use});
        const auto other = find(keys);
        // Files of a series are replaced, so other hard links to an old file are not affected.
        if (other && (other->use != Use::kOneOfMany || find({keys.back()}))) {
            return refusal(file, *other);
        }
        RELIEF_TRY(checkLink(file.path, folder, option));
    }
    for (auto& [keys, file] : found) {
        add(keys, std::move(file));
    }
    series_.emplace(real.native(), Series{self, holds});
    return {};
}

fs::path NumberedFiles::path(std::uint32_t number) const {
    const std::string digits = std::to_string(number);
    return folder / (head + std::string(4 - std::min<std::size_t>(digits.size(), 4), '0') + digits + ending);
}

bool NumberedFiles::hold(const std::string& name) const {
    if (name.size() <= head.size() + ending.size() || !std::string_view(name).starts_with(head) ||
        !std::string_view(name).ends_with(ending)) {
        return false;
    }
    const auto number =
        parseUnsigned(std::string_view(name).substr(head.size(), name.size() - head.size() - ending.size()));
    return number && *number < count && path(static_cast<std::uint32_t>(*number)).filename() == name;
}

}  // namespace relief

#include "formats/base/file_guard.h"

#include <sys/stat.h>
#include <unistd.h>

#include <algorithm>
#include <system_error>

#include "formats/base/destination.h"
#include "formats/base/file_io.h"
#include "formats/base/preflight.h"

namespace relief {
namespace {

namespace fs = std::filesystem;

std::string shown(const fs::path& path, const char* standard) {
    return path == "-" ? standard : quotedPath(path);
}

/// The folder, or one that it lies in.
bool isOrHolds(const fs::path& outer, const fs::path& inner) {
    return std::mismatch(outer.begin(), outer.end(), inner.begin(), inner.end()).first == outer.end();
}

}  // namespace

FileGuard::Target FileGuard::targetOf(const fs::path& path, int standard) {
    const std::optional<int> descriptor = path == "-" ? std::optional(standard) : descriptorOf(path);
    Target target;
    struct stat status {};
    const bool exists = (descriptor ? ::fstat(*descriptor, &status) : ::stat(path.c_str(), &status)) == 0;
    if (exists && S_ISREG(status.st_mode)) {
        target.id = Id(status.st_dev, status.st_ino);
    }
    if (descriptor) {
        target.place = standard == STDOUT_FILENO && descriptor == STDOUT_FILENO ? "-" : "";
    } else if (!exists || S_ISREG(status.st_mode) || S_ISDIR(status.st_mode)) {
        std::error_code error;
        const fs::path place = destination(path, error);
        target.place = error ? path.native() : place.native();
    }
    return target;
}

const FileGuard::File* FileGuard::find(const Target& target) const {
    if (const auto known = target.id ? by_id_.find(*target.id) : by_id_.end(); known != by_id_.end()) {
        return &files_[known->second];
    }
    if (const auto known = by_place_.find(target.place); known != by_place_.end()) {
        return &files_[known->second];
    }
    const fs::path place = target.place;
    for (const Series& series : series_) {
        if (place.parent_path() == series.files.folder && series.files.hold(place.filename().native())) {
            return &files_[series.file];
        }
    }
    return nullptr;
}

const FileGuard::File* FileGuard::findFolder(const fs::path& folder) const {
    for (const auto& [place, file] : by_place_) {
        if (place != "-" && !files_[file].input && isOrHolds(place, folder)) {
            return &files_[file];
        }
    }
    return nullptr;
}

void FileGuard::add(const Target& target, File file) {
    const std::size_t index = files_.size();
    files_.push_back(std::move(file));
    if (target.id) {
        by_id_.emplace(*target.id, index);
    }
    if (!target.place.empty()) {
        by_place_.emplace(target.place, index);
    }
}

Result<void> FileGuard::refusal(const File& file, const File& other) {
    if (file.input || other.input) {
        const File& input = file.input ? file : other;
        const File& output = file.input ? other : file;
        const std::string name = input.path == output.path ? "" : " " + shown(input.path, "standard input");
        return fail(ErrorCode::kUsage, (output.path == "-" ? "" : "the output ") +
                                           shown(output.path, "standard output") + " is the input" + name +
                                           "; choose another place for " + output.option);
    }
    return fail(ErrorCode::kUsage, "two outputs are one: " + other.option + " and " + file.option +
                                       " would both write " + shown(file.path, "standard output") +
                                       "; choose another place for one of them");
}

Result<void> FileGuard::reads(const fs::path& path) {
    if (path.empty()) {
        return {};
    }
    File input{path, "", true};
    const Target target = targetOf(path, STDIN_FILENO);
    if (const File* other = find(target); other != nullptr && !other->input) {
        return refusal(input, *other);
    }
    add(target, std::move(input));
    return {};
}

Result<void> FileGuard::writes(const fs::path& path, std::string_view option) {
    if (path.empty()) {
        return {};
    }
    RELIEF_TRY(preflightFile(path, option));
    if (const File* other = claim(path, option); other != nullptr) {
        return refusal({path, std::string(option)}, *other);
    }
    return {};
}

const FileGuard::File* FileGuard::claim(const fs::path& path, std::string_view option) {
    const Target target = targetOf(path, STDOUT_FILENO);
    if (const File* other = find(target); other != nullptr) {
        return other;
    }
    // A folder of frames that is not made yet.
    for (const Series& series : series_) {
        if (!target.place.empty() && isOrHolds(target.place, series.files.folder)) {
            return &files_[series.file];
        }
    }
    add(target, {path, std::string(option)});
    return nullptr;
}

Result<void> FileGuard::writes(const NumberedFiles& files, std::string_view option) {
    const File self{files.folder, std::string(option)};
    std::error_code error;
    NumberedFiles real = files;
    real.folder = destination(files.folder, error);
    if (error) {
        return fail(ErrorCode::kIo, "cannot follow " + quotedPath(files.folder) + ": " + error.message() +
                                        "; choose another place for " + self.option);
    }
    if (const File* other = findFolder(real.folder); other != nullptr) {
        return refusal(self, *other);
    }
    // Files that are not there yet are known by their names alone.
    for (const auto& [place, file] : by_place_) {
        const fs::path path = place;
        if (path.parent_path() == real.folder && real.hold(path.filename().native())) {
            return refusal({files.folder / path.filename(), self.option}, files_[file]);
        }
    }
    std::vector<std::pair<Target, File>> found;
    for (fs::directory_iterator entry(real.folder, error), end; !error && entry != end;
         entry.increment(error)) {
        const std::string name = entry->path().filename().native();
        if (!real.hold(name)) {
            continue;
        }
        File file{files.folder / name, self.option};
        Target target = targetOf(entry->path(), STDOUT_FILENO);
        if (const File* other = find(target); other != nullptr) {
            return refusal(file, *other);
        }
        // A link to another of them: one picture would be written over the other.
        const fs::path place = target.place;
        if (place != entry->path() && place.parent_path() == real.folder &&
            real.hold(place.filename().native())) {
            return fail(ErrorCode::kUsage, quotedPath(file.path) + " is a link to another file of " +
                                               self.option + "; remove it, or choose another place");
        }
        found.emplace_back(std::move(target), std::move(file));
    }
    for (auto& [target, file] : found) {
        add(target, std::move(file));
    }
    series_.push_back({std::move(real), files_.size()});
    files_.push_back(self);
    return {};
}

}  // namespace relief

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

/// The folder, or one that it lies in.
bool isOrHolds(const fs::path& outer, const fs::path& inner) {
    return std::mismatch(outer.begin(), outer.end(), inner.begin(), inner.end()).first == outer.end();
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
        std::error_code error;
        const fs::path place = destination(path, error);
        keys.push_back(error ? path.native() : place.native());
    }
    return keys;
}

const FileGuard::File* FileGuard::find(const Keys& keys) const {
    for (const std::string& key : keys) {
        if (const auto known = by_key_.find(key); known != by_key_.end()) {
            return &files_[known->second];
        }
        const fs::path place = key;
        for (const Series& series : series_) {
            if (place.parent_path() == series.files.folder && series.files.hold(place.filename().native())) {
                return &files_[series.file];
            }
        }
    }
    return nullptr;
}

void FileGuard::add(const Keys& keys, File file) {
    for (const std::string& key : keys) {
        by_key_.emplace(key, files_.size());
    }
    files_.push_back(std::move(file));
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
    const Keys keys = keysOf(path, STDIN_FILENO);
    if (const File* other = find(keys); other != nullptr && !other->input) {
        return refusal({path, "", true}, *other);
    }
    add(keys, {path, "", true});
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
    const Keys keys = keysOf(path, STDOUT_FILENO);
    if (const File* other = find(keys); other != nullptr) {
        return other;
    }
    // A folder of frames that is not made yet.
    for (const Series& series : series_) {
        if (!keys.empty() && isOrHolds(keys.back(), series.files.folder)) {
            return &files_[series.file];
        }
    }
    add(keys, {path, std::string(option)});
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
    for (const auto& [key, file] : by_key_) {
        const fs::path path = key;
        if (!files_[file].input && path.is_absolute() && isOrHolds(path, real.folder)) {
            return refusal(self, files_[file]);
        }
        // Files that are not there yet are known by their names alone.
        if (path.parent_path() == real.folder && real.hold(path.filename().native())) {
            return refusal({files.folder / path.filename(), self.option}, files_[file]);
        }
    }
    std::vector<std::pair<Keys, File>> found;
    for (fs::directory_iterator entry(real.folder, error), end; !error && entry != end;
         entry.increment(error)) {
        const fs::path name = entry->path().filename();
        if (real.hold(name.native())) {
            found.emplace_back(keysOf(entry->path(), STDOUT_FILENO), File{files.folder / name, self.option});
            if (const File* other = find(found.back().first); other != nullptr) {
                return refusal(found.back().second, *other);
            }
        }
    }
    for (auto& [keys, file] : found) {
        add(keys, std::move(file));
    }
    series_.push_back({std::move(real), files_.size()});
    files_.push_back(self);
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

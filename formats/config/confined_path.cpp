#include "formats/config/confined_path.h"

#include <algorithm>
#include <string>
#include <system_error>

#include "formats/base/file_io.h"

namespace relief {
namespace {

namespace fs = std::filesystem;

constexpr int kLinksMax = 40;  // as Linux follows

/// Without any symbolic link but dangling ones, and without `.` and `..`; parts that do not exist stay.
fs::path settled(const fs::path& path, std::error_code& error) {
    fs::path result = fs::weakly_canonical(fs::absolute(path, error), error);
    // A folder that does not exist keeps the slash at its end, which would count as a part.
    return result.has_filename() ? result : result.parent_path();
}

/// As settled(), and where dangling links would lead. weakly_canonical takes one for a file that does not
/// exist yet, but by the time it is opened its target may be there.
fs::path destination(const fs::path& path, std::error_code& error) {
    fs::path result = settled(path, error);
    for (int i = 0; i < kLinksMax && !error; ++i) {
        fs::path walked;
        auto part = result.begin();
        for (; part != result.end(); ++part) {
            std::error_code none;
            if (fs::is_symlink(fs::symlink_status(walked / *part, none))) {
                break;
            }
            walked /= *part;
        }
        if (part == result.end()) {
            return result;
        }
        fs::path followed = walked / fs::read_symlink(walked / *part, error);
        for (++part; part != result.end(); ++part) {
            followed /= *part;
        }
        result = settled(followed, error);
    }
    if (!error) {
        error = std::make_error_code(std::errc::too_many_symbolic_link_levels);
    }
    return result;
}

bool liesIn(const fs::path& folder, const fs::path& path) {
    return std::mismatch(folder.begin(), folder.end(), path.begin(), path.end()).first == folder.end();
}

}  // namespace

Result<fs::path> resolveInside(const fs::path& folder, std::string_view text, std::string_view owner,
                               const fs::path& root) {
    const fs::path path(text);
    const std::string whose(owner);
    const auto refuse = [&](const std::string& why) {
        return fail(ErrorCode::kInvalidInput, quotedPath(path) + " " + why);
    };
    if (text.empty()) {
        return refuse("names no file; name one in the " + whose + "'s folder");
    }
    if (text.find('\0') != std::string_view::npos) {
        return refuse("holds a zero byte; remove it");
    }
    if (path.is_absolute()) {
        return refuse("is an absolute path; put the file into the " + whose +
                      "'s folder and name it from there");
    }
    std::error_code error;
    const fs::path own = settled(folder.empty() ? fs::path(".") : folder, error);
    const fs::path target = error ? fs::path() : destination(own / path, error);
    const fs::path other = error || root.empty() ? fs::path() : settled(root, error);
    if (error) {
        return refuse("cannot be followed: " + error.message() + "; mend the path");
    }
    if (!liesIn(own, target) && !(!root.empty() && liesIn(other, target))) {
        return refuse("leads out of the " + whose + "'s folder" +
                      (root.empty() ? "" : " and of --root " + quotedPath(root)) +
                      "; put the file there, or the " + whose + " beside the file");
    }
    // Alone, "-" would be standard input.
    return text == "-" ? folder / "./-" : folder / path;
}

Result<void> checkRoot(const fs::path& root) {
    std::error_code error;
    if (!fs::is_directory(root, error)) {
        return fail(ErrorCode::kIo, "--root " + quotedPath(root) + " is no folder; name one that exists");
    }
    return {};
}

}  // namespace relief

// SPDX-License-Identifier: Apache-2.0
#include "formats/config/confined_path.h"

#include <algorithm>
#include <string>
#include <system_error>

#include "formats/base/file_io.h"

namespace relief {
namespace {

namespace fs = std::filesystem;

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
        return refuse("contains a zero byte; remove it");
    }
    if (path.is_absolute()) {
        return refuse("is an absolute path; move the file into the " + whose +
                      "'s folder and use a relative path");
    }
    std::error_code error;
    const fs::path own = destination(folder.empty() ? fs::path(".") : folder, error);
    const fs::path target = error ? fs::path() : destination(own / path, error);
    const fs::path other = error || root.empty() ? fs::path() : destination(root, error);
    if (error) {
        return refuse("cannot be followed: " + error.message() + "; fix the path");
    }
    if (!liesIn(own, target) && !(!root.empty() && liesIn(other, target))) {
        return refuse("leads out of the " + whose + "'s folder" +
                      (root.empty() ? "" : " and of --root " + quotedPath(root)) +
                      "; move the file there, or the " + whose + " next to the file");
    }
    // "-" by itself would mean standard input.
    return text == "-" ? folder / "./-" : folder / path;
}

Result<void> checkRoot(const fs::path& root) {
    std::error_code error;
    if (!fs::is_directory(root, error)) {
        return fail(ErrorCode::kIo, "--root " + quotedPath(root) + " is not a folder; name an existing one");
    }
    return {};
}

}  // namespace relief

#include "formats/base/preflight.h"

#include <unistd.h>

#include <system_error>

#include "formats/base/file_io.h"

namespace relief {

namespace fs = std::filesystem;

Result<void> preflightFile(const fs::path& path, std::string_view option) {
    const auto refuse = [&](const std::string& why) {
        return fail(ErrorCode::kIo,
                    "cannot write " + quotedPath(path) + " of " + std::string(option) + ": " + why);
    };
    if (path == "-") {
        return {};
    }
    std::error_code error;
    if (path.empty()) {
        return refuse("no name; name a file");
    }
    if (fs::is_directory(path, error)) {
        return refuse("it is a folder; name a file");
    }
    if (mayBlock(path)) {
        return refuse("it is a pipe, a socket or a disk; name a file, or - for standard output");
    }
    if (fs::exists(path, error) && !fs::is_regular_file(path, error)) {
        if (::access(path.c_str(), W_OK) != 0) {
            return refuse("no permission; choose another file");
        }
        return {};
    }
    const fs::path folder = path.has_parent_path() ? path.parent_path() : fs::path(".");
    if (!fs::is_directory(folder, error)) {
        return refuse("its folder does not exist; make the folder first");
    }
    // A file is replaced by renaming, so it is the folder that must be writable.
    if (!fs::is_symlink(path, error) && ::access(folder.c_str(), W_OK | X_OK) != 0) {
        return refuse("its folder cannot be written; change its permissions or choose another");
    }
    return {};
}

Result<void> preflightFolder(const fs::path& path, std::string_view option) {
    const std::string name = quotedPath(path) + " of " + std::string(option);
    std::error_code error;
    fs::create_directories(path, error);
    if (error || !fs::is_directory(path, error)) {
        return fail(ErrorCode::kIo, "cannot make the folder " + name + ": " +
                                        (error ? error.message() : "a file of that name is in the way") +
                                        "; choose another");
    }
    if (::access(path.c_str(), W_OK | X_OK) != 0) {
        return fail(ErrorCode::kIo,
                    "cannot write into the folder " + name + "; change its permissions or choose another");
    }
    return {};
}

}  // namespace relief

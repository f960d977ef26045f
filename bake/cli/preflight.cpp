#include "bake/cli/preflight.h"

#include <unistd.h>

#include <system_error>

#include "formats/base/file_io.h"

namespace relief {
namespace {

namespace fs = std::filesystem;

tl::unexpected<Error> cannotWrite(const fs::path& path, const std::string& why) {
    return fail(ErrorCode::kIo, "cannot write " + quotedPath(path) + ": " + why);
}

}  // namespace

Result<void> preflightFile(const fs::path& path) {
    if (path == "-") {
        return {};
    }
    std::error_code error;
    if (path.empty()) {
        return cannotWrite(path, "no name; name a file");
    }
    if (fs::is_directory(path, error)) {
        return cannotWrite(path, "it is a folder; name a file");
    }
    if (mayBlock(path)) {
        return cannotWrite(path, "it is a pipe, a socket or a disk; name a file, or - for standard output");
    }
    if (fs::exists(path, error) && !fs::is_regular_file(path, error)) {
        if (::access(path.c_str(), W_OK) != 0) {
            return cannotWrite(path, "no permission; choose another file");
        }
        return {};
    }
    const fs::path folder = path.has_parent_path() ? path.parent_path() : fs::path(".");
    if (!fs::is_directory(folder, error)) {
        return cannotWrite(path, "its folder does not exist; make the folder first");
    }
    // A file is replaced by renaming, so it is the folder that must be writable.
    if (!fs::is_symlink(path, error) && ::access(folder.c_str(), W_OK | X_OK) != 0) {
        return cannotWrite(path, "its folder cannot be written; change its permissions or choose another");
    }
    return {};
}

Result<void> preflightFolder(const fs::path& path) {
    std::error_code error;
    fs::create_directories(path, error);
    if (error) {
        return fail(ErrorCode::kIo, "cannot make the folder " + quotedPath(path) + ": " + error.message() +
                                        "; choose another");
    }
    if (::access(path.c_str(), W_OK | X_OK) != 0) {
        return fail(ErrorCode::kIo, "cannot write into the folder " + quotedPath(path) +
                                        "; change its permissions or choose another");
    }
    return {};
}

Result<void> preflightDistinct(const fs::path& input, const fs::path& output) {
    std::error_code error;
    if (input != "-" && output != "-" && fs::equivalent(input, output, error) && !error &&
        fs::is_regular_file(input, error)) {
        return fail(ErrorCode::kUsage,
                    "the output " + quotedPath(output) + " is the input; name another file");
    }
    return {};
}

Result<void> preflightTwoOutputs(const fs::path& one, const fs::path& other) {
    std::error_code error;
    const auto full = [&](const fs::path& path) {
        return fs::weakly_canonical(fs::absolute(path, error), error);
    };
    if (one != "-" && other != "-" && full(one) == full(other) && !error) {
        return fail(ErrorCode::kUsage, "two outputs would be " + quotedPath(other) + "; name another file");
    }
    return preflightDistinct(one, other);
}

}  // namespace relief

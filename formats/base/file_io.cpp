// SPDX-License-Identifier: Apache-2.0
#include "formats/base/file_io.h"

#include <sys/stat.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <charconv>
#include <cstdio>
#include <exception>
#include <mutex>
#include <optional>
#include <set>
#include <string_view>
#include <system_error>

#include "formats/base/descriptor.h"
#include "formats/base/temporary_file.h"
#include "formats/base/text.h"

namespace relief {
namespace {

namespace fs = std::filesystem;

constexpr std::size_t kChunk = std::size_t{1} << 20;  // bytes per system call, for streams
constexpr int kLinksMax = 40;                         // limit of Linux

/// Returns the advice for an errno.
const char* advice(int code, bool reads) {
    switch (code) {
        case ENOENT:
        case ENOTDIR:
            return reads ? "check the path" : "check the path; folders are not created";
        case EISDIR:
            return "name a file, not a folder";
        case EACCES:
        case EPERM:
        case EROFS:
            return "check the permissions of the file and of its folder, or choose another folder";
        case ENOSPC:
        case EDQUOT:
        case EFBIG:
            return "free some space, raise the limit, or write elsewhere";
        case EMFILE:
        case ENFILE:
            return "close other files, or raise the limit (ulimit -n)";
        case EPIPE:
            return "the program that reads the output has ended";
        default:
            return "check the path and the disk, or choose another place";
    }
}

tl::unexpected<Error> ioError(const char* action, const std::string& name, int code) {
    const bool reads = std::string_view(action) == "read";
    return fail(ErrorCode::kIo, std::string("cannot ") + action + " " + name + ": " +
                                    std::system_category().message(code) + "; " + advice(code, reads));
}

/// Checks for paths that the system would truncate or misinterpret.
/// \return 0 or an errno.
int checkPath(const fs::path& path) {
    if (path.empty()) {
        return ENOENT;
    }
    return path.native().find('\0') == std::string::npos ? 0 : EINVAL;
}

/// Reads to the end.
/// \param expected  estimated number of bytes, at most size_max.
Result<std::vector<std::byte>> readAll(int fd, const std::string& name, std::uint64_t expected,
                                       std::uint64_t size_max) {
    std::vector<std::byte> bytes;
    std::size_t used = 0;
    // One byte more than expected or allowed, to detect the end without reallocation.
    std::uint64_t room = expected + 1;
    while (true) {
        if (used == bytes.size()) {
            try {
                bytes.resize(static_cast<std::size_t>(room));
            } catch (const std::exception&) {
                return fail(ErrorCode::kLimit,
                            "cannot read " + name + ": it does not fit into memory; use a smaller file");
            }
            const std::uint64_t more = std::max<std::uint64_t>(room, kChunk);
            room += std::min(more, size_max < room ? 1 : size_max + 1 - room);
        }
        const ssize_t got = ::read(fd, bytes.data() + used, bytes.size() - used);
        if (got < 0) {
            if (errno == EINTR) {
                continue;
            }
            return ioError("read", name, errno);
        }
        if (got == 0) {
            bytes.resize(used);
            return bytes;
        }
        used += static_cast<std::size_t>(got);
        if (used > size_max) {
            return fail(ErrorCode::kLimit, "cannot read " + name + ": it is longer than the limit of " +
                                               std::to_string(size_max) + " bytes; use a smaller file");
        }
    }
}

/// Returns the canonical path, but keeps a dangling link, which weakly_canonical treats as a missing file.
fs::path canonicalPath(const fs::path& path, std::error_code& error) {
    fs::path result = fs::weakly_canonical(fs::absolute(path, error), error);
    // A missing folder keeps its trailing slash, which would count as a component.
    return result.has_filename() ? result : result.parent_path();
}

bool isStream(mode_t mode) {
    return S_ISFIFO(mode) || S_ISSOCK(mode) || S_ISBLK(mode);
}

tl::unexpected<Error> streamError(const char* action, const std::string& name, const char* instead) {
    return fail(ErrorCode::kIo, std::string("cannot ") + action + " " + name +
                                    ": it is a pipe, a socket or a disk; name a file, or - for " + instead);
}

Result<void> writeInPlace(const fs::path& path, std::span<const std::byte> bytes) {
    Descriptor file(openRetry(path.c_str(), O_WRONLY));
    if (!file) {
        return ioError("write", quotedPath(path), errno);
    }
    int code = writeAll(file.get(), bytes);
    if (code == 0) {
        code = file.close();
    }
    if (code != 0) {
        return ioError("write", quotedPath(path), code);
    }
    return {};
}

/// Removes the temporary files of killed processes, once per folder.
void removeLeftoversOnce(const fs::path& folder) {
    static std::mutex mutex;
    static std::set<fs::path> done;
    std::error_code error;
    const std::scoped_lock lock(mutex);
    if (done.insert(fs::absolute(folder, error)).second) {
        TemporaryFile::removeLeftovers(folder);
    }
}

/// \param older_mode  permission bits of the replaced file, if it exists.
Result<void> replaceFile(const fs::path& target, const std::string& name, std::span<const std::byte> bytes,
                         std::optional<mode_t> older_mode) {
    const fs::path folder = target.has_parent_path() ? target.parent_path() : fs::path(".");
    // The file stays private until it has the old file's permissions, so that other users cannot read it early.
    const mode_t first_mode = older_mode ? 0600 : 0666;
    TemporaryFile temporary;
    int code = temporary.create(folder, first_mode);
    if (code == 0) {
        code = temporary.fill(bytes, older_mode);
    }
    if (code == 0) {
        code = temporary.renameTo(target);
    }
    if (code != 0) {
        return ioError("write", name, code);
    }
    removeLeftoversOnce(folder);
    // A folder that is writable but not readable cannot be synced; the file is complete nevertheless.
    if (const Descriptor opened(openRetry(folder.c_str(), O_RDONLY | O_DIRECTORY)); opened) {
        if (const int sync_code = syncToDisk(opened.get())) {
            return ioError("sync", name + " to disk (the new file is in place)", sync_code);
        }
    }
    return {};
}

}  // namespace

std::optional<int> descriptorOf(const fs::path& path) {
    if (path == "/dev/stdin") {
        return STDIN_FILENO;
    }
    if (path == "/dev/stdout") {
        return STDOUT_FILENO;
    }
    if (path == "/dev/stderr") {
        return STDERR_FILENO;
    }
    for (const std::string_view folder : {"/dev/fd/", "/proc/self/fd/"}) {
        const std::string_view name = path.native();
        if (name.starts_with(folder)) {
            int number = 0;
            const auto [end, error] =
                std::from_chars(name.data() + folder.size(), name.data() + name.size(), number);
            if (error == std::errc() && end == name.data() + name.size()) {
                return number;
            }
        }
    }
    return std::nullopt;
}

bool mayBlock(const fs::path& path) {
    struct stat status {};
    return !descriptorOf(path) && ::stat(path.c_str(), &status) == 0 && isStream(status.st_mode);
}

Result<std::vector<std::byte>> readFile(const fs::path& path, std::uint64_t size_max) {
    if (path == "-") {
        return readAll(STDIN_FILENO, "standard input", 0, size_max);
    }
    const std::string name = quotedPath(path);
    if (const int code = checkPath(path)) {
        return ioError("read", name, code);
    }
    if (mayBlock(path)) {
        return streamError("read", name, "standard input");
    }
    const Descriptor file(openRetry(path.c_str(), O_RDONLY));
    struct stat status {};
    if (!file || ::fstat(file.get(), &status) != 0) {
        return ioError("read", name, errno);
    }
    if (S_ISDIR(status.st_mode)) {
        return ioError("read", name, EISDIR);
    }
    const std::uint64_t size = S_ISREG(status.st_mode) ? static_cast<std::uint64_t>(status.st_size) : 0;
    if (size > size_max) {
        return fail(ErrorCode::kLimit, "cannot read " + name + ": its " + std::to_string(size) +
                                           " bytes are more than the limit of " + std::to_string(size_max) +
                                           "; use a smaller file");
    }
    return readAll(file.get(), name, size, size_max);
}

Result<void> writeFile(const fs::path& path, std::span<const std::byte> bytes) {
    const std::string name = path == "-" ? "standard output" : quotedPath(path);
    if (const int code = checkPath(path)) {
        return ioError("write", name, code);
    }
    if (const std::optional<int> number = path == "-" ? STDOUT_FILENO : descriptorOf(path)) {
        if (const int code = writeAll(*number, bytes)) {
            return ioError("write", name, code);
        }
        return {};
    }
    struct stat status {};
    std::optional<mode_t> older_mode;
    if (::stat(path.c_str(), &status) == 0) {
        if (S_ISDIR(status.st_mode)) {
            return ioError("write", name, EISDIR);
        }
        if (isStream(status.st_mode)) {
            return streamError("write", name, "standard output");
        }
        if (!S_ISREG(status.st_mode)) {
            return writeInPlace(path, bytes);
        }
        older_mode = status.st_mode & 0777;
    } else if (errno != ENOENT) {
        return ioError("write", name, errno);
    }
    std::error_code error;
    const bool link = fs::is_symlink(fs::symlink_status(path, error));
    const fs::path target = link ? destination(path, error) : path;
    return error && link ? ioError("write", name, error.value())
                         : replaceFile(target, name, bytes, older_mode);
}

Result<void> writeText(const fs::path& path, std::string_view text) {
    return writeFile(path, std::as_bytes(std::span(text.data(), text.size())));
}

std::string quotedPath(const fs::path& path) {
    return "'" + escapedUtf8(path.native()) + "'";
}

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
            return refuse("permission denied; choose another file");
        }
        return {};
    }
    const fs::path folder = path.has_parent_path() ? path.parent_path() : fs::path(".");
    if (!fs::is_directory(folder, error)) {
        return refuse("its folder does not exist; create it first");
    }
    // Files are replaced by renaming, so the folder must be writable.
    if (!fs::is_symlink(path, error) && ::access(folder.c_str(), W_OK | X_OK) != 0) {
        return refuse("its folder is not writable; change its permissions or choose another");
    }
    return {};
}

Result<void> preflightFolder(const fs::path& path, std::string_view option) {
    const std::string name = quotedPath(path) + " of " + std::string(option);
    std::error_code error;
    fs::create_directories(path, error);
    if (error || !fs::is_directory(path, error)) {
        return fail(ErrorCode::kIo, "cannot create the folder " + name + ": " +
                                        (error ? error.message() : "a file with that name exists") +
                                        "; choose another");
    }
    if (::access(path.c_str(), W_OK | X_OK) != 0) {
        return fail(ErrorCode::kIo,
                    "cannot write into the folder " + name + "; change its permissions or choose another");
    }
    return {};
}

fs::path destination(const fs::path& path, std::error_code& error) {
    fs::path result = canonicalPath(path, error);
    for (int i = 0; i < kLinksMax && !error; ++i) {
        const auto link =
            std::find_if(result.begin(), result.end(), [walked = fs::path()](const fs::path& part) mutable {
                std::error_code none;
                return fs::is_symlink(fs::symlink_status(walked /= part, none));
            });
        if (link == result.end()) {
            return result;
        }
        fs::path before;
        std::for_each(result.begin(), link, [&](const fs::path& part) { before /= part; });
        fs::path followed = before / fs::read_symlink(before / *link, error);
        std::for_each(std::next(link), result.end(), [&](const fs::path& part) { followed /= part; });
        result = canonicalPath(followed, error);
    }
    if (!error) {
        error = std::make_error_code(std::errc::too_many_symbolic_link_levels);
    }
    return result;
}

}  // namespace relief

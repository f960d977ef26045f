// SPDX-License-Identifier: Apache-2.0
#include "bake/import/import_files.h"

#include <fcntl.h>
#include <linux/openat2.h>
#include <sys/stat.h>
#include <sys/syscall.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <cstring>

#include "formats/base/hash.h"
#include "formats/base/text.h"

namespace relief {
namespace {

constexpr std::size_t kRefusedMax = 4;  // the most that a message lists
constexpr std::size_t kRefusedPathMax = 200;

/// Converts "a\b" and "./a/b" to "a/b".
std::string relativePath(std::string_view path) {
    std::string text(path);
    std::replace(text.begin(), text.end(), '\\', '/');
    while (text.starts_with("./")) {
        text.erase(0, 2);
    }
    return text;
}

}  // namespace

bool ImportFiles::isMesh(std::string_view path) const {
    return path == name_ || relativePath(path) == name_;
}

Descriptor ImportFiles::openBeneath(const std::string& path, std::string& why) const {
    const std::vector<std::string_view> folders = split(path, '/');
    if (path.empty() || path.starts_with('/') || path.find('\0') != std::string::npos ||
        std::ranges::find(folders, "..") != folders.end()) {
        why = "not below the mesh's folder";
        return Descriptor();
    }
    if (folder_ < 0) {
        why = "the mesh's folder is unknown";
        return Descriptor();
    }
    open_how how{};
    // Non-blocking, so that a pipe without a writer cannot hang the importer.
    how.flags = O_RDONLY | O_CLOEXEC | O_NOCTTY | O_NONBLOCK;
    how.resolve = RESOLVE_BENEATH | RESOLVE_NO_MAGICLINKS;
    Descriptor file(static_cast<int>(::syscall(SYS_openat2, folder_, path.c_str(), &how, sizeof(how))));
    if (!file) {
        why = errno == EXDEV ? "not below the mesh's folder" : std::strerror(errno);
        return file;
    }
    struct stat status {};
    if (::fstat(file.get(), &status) != 0 || !S_ISREG(status.st_mode)) {
        why = "not a regular file";
        return Descriptor();
    }
    return file;
}

void ImportFiles::refuse(std::string_view path, const std::string& why) {
    const std::string line = "'" + cleanUtf8(path, kRefusedPathMax) + "' (" + why + ")";
    if (refused_.size() < kRefusedMax && std::ranges::find(refused_, line) == refused_.end()) {
        refused_.push_back(line);
    }
}

bool ImportFiles::exists(std::string_view path) {
    if (isMesh(path)) {
        return true;
    }
    std::string why;
    return static_cast<bool>(openBeneath(relativePath(path), why));
}

std::optional<std::vector<std::byte>> ImportFiles::open(std::string_view path) {
    const std::string name = relativePath(path);
    std::string why;
    const Descriptor file = openBeneath(name, why);
    if (!file) {
        refuse(path, why);
        return std::nullopt;
    }
    struct stat status {};
    if (::fstat(file.get(), &status) != 0 || static_cast<std::uint64_t>(status.st_size) > left_) {
        refuse(path, "all files together exceed " + std::to_string(kImportBytesMax) + " bytes");
        return std::nullopt;
    }
    std::vector<std::byte> bytes(static_cast<std::size_t>(status.st_size));
    std::size_t size = 0;
    while (size < bytes.size()) {
        const ssize_t got = ::read(file.get(), bytes.data() + size, bytes.size() - size);
        if (got < 0 && errno == EINTR) {
            continue;
        }
        if (got <= 0) {
            break;
        }
        size += static_cast<std::size_t>(got);
    }
    bytes.resize(size);
    left_ -= size;
    read_.emplace(name, xxh3_128Hex(bytes));
    return bytes;
}

}  // namespace relief

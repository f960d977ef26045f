// SPDX-License-Identifier: Apache-2.0
// `relief-import`: reads one mesh file or image for its parent (import_protocol.h) in a sandbox, so that a hostile file
// can harm only this process. Started by ImportProcess; not for direct use.
#include <fcntl.h>
#include <malloc.h>
#include <poll.h>
#include <sys/mman.h>
#include <sys/stat.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <cerrno>
#include <filesystem>
#include <new>
#include <span>
#include <vector>

#include "bake/import/image_rows.h"
#include "bake/import/import_job.h"
#include "bake/import/import_protocol.h"
#include "bake/import/import_sandbox.h"
#include "bake/import/import_source.h"
#include "formats/base/descriptor.h"
#include "formats/base/file_io.h"
#include "formats/base/heap.h"
#include "formats/base/text.h"
#include "formats/fields/text.h"

namespace relief {
namespace {

/// Address space for the stack of importRaw and small allocations, in addition to the limit.
constexpr std::uint64_t kExtraMemory = (std::uint64_t{1} << 30) + (std::uint64_t{64} << 20);
/// Initial heap, which may use large pages.
constexpr std::uint64_t kHeapBytes = std::uint64_t{64} << 20;

/// Returns zeros on failure.
struct stat statusOf(int file) {
    struct stat status {};
    if (::fstat(file, &status) != 0) {
        status = {};
    }
    return status;
}

/// Whether the parent ended before PR_SET_PDEATHSIG took effect.
bool orphaned() {
    pollfd alive{kImportAliveFd, 0, 0};
    return ::poll(&alive, 1, 0) > 0 && (alive.revents & POLLERR) != 0;
}

int exitOf(int number) {
    return kImportExitErrno + (number > 0 && number < 128 ? number : EIO);
}

/// \return an exit code.
int sendMessage(const Result<TriangleMesh>& raw) {
    const std::uint64_t size = importMessageSize(raw);
    if (size > static_cast<std::uint64_t>(statusOf(kImportResultFd).st_size)) {
        return kImportExitTooLarge;
    }
    // Allocates the whole message now: a page that cannot be allocated later raises SIGBUS.
    if (const int code = reserveMemory(kImportResultFd, size)) {
        return exitOf(code);
    }
    // mmap(), because the sandbox forbids write().
    void* const pages =
        ::mmap(nullptr, size, PROT_READ | PROT_WRITE, MAP_SHARED | MAP_POPULATE, kImportResultFd, 0);
    if (pages == MAP_FAILED) {
        return errno == ENOMEM ? kImportExitMemory : exitOf(errno);
    }
    writeImportMessage(raw, {static_cast<std::byte*>(pages), size});
    if (::munmap(pages, size) != 0 || ::ftruncate(kImportResultFd, static_cast<off_t>(size)) != 0) {
        return exitOf(errno);
    }
    const int code = addSeals(kImportResultFd, F_SEAL_SHRINK | F_SEAL_GROW | F_SEAL_WRITE | F_SEAL_SEAL);
    return code == 0 ? kImportExitMessage : exitOf(code);
}

/// \return an exit code.
int sendError(const Error& error) {
    const std::array<std::uint32_t, 2> head = {static_cast<std::uint32_t>(error.code),
                                               static_cast<std::uint32_t>(error.message.size())};
    int code = writeAll(kImportResultFd, std::as_bytes(std::span(head)));
    code = code != 0 ? code : writeAll(kImportResultFd, std::as_bytes(std::span(error.message)));
    return code == 0 ? kImportExitMessage : exitOf(code);
}

/// \return an exit code.
int sendRows(std::span<const std::byte> image) {
    const Result<std::unique_ptr<SampleRows>> rows = openImageRows(image);
    if (!rows) {
        return sendError(rows.error());
    }
    const std::uint32_t good = 0;
    const ImageSize size{(*rows)->columns(), (*rows)->rows(), (*rows)->most()};
    int code = writeAll(kImportResultFd, std::as_bytes(std::span(&good, 1)));
    code = code != 0 ? code : writeAll(kImportResultFd, std::as_bytes(std::span(&size, 1)));
    std::vector<float> row(1 + size.columns);  // the leading 0.0F has the bytes of a u32 of 0
    for (std::uint64_t i = 0; i < size.rows && code == 0; ++i) {
        if (const Result<void> read = (*rows)->next(std::span(row).subspan(1)); !read) {
            return sendError(read.error());
        }
        code = writeAll(kImportResultFd, std::as_bytes(std::span(row)));
    }
    return code == 0 ? kImportExitMessage : exitOf(code);
}

int work(std::span<char*> arguments) {
    constexpr std::array kBegun = {std::byte{1}};
    if (const int code = writeAll(kImportAliveFd, kBegun)) {
        return exitOf(code);
    }
    const std::filesystem::path path = arguments[1];
    const std::uint64_t memory = parseUnsigned(arguments[2]).value_or(0);
    const std::uint64_t seconds = parseUnsigned(arguments[3]).value_or(0);
    const std::uint64_t triangles = parseUnsigned(arguments[4]).value_or(0);
    const bool image = arguments[5] == kImportImage;
    const std::optional<ImportKind> kind = fromWord<ImportKind>(arguments[5]);
    if (!image && !kind) {
        return kImportExitArguments;
    }
    ImportOptions options;
    std::size_t next = 6;
    for (; arguments[next] != kImportNamesMarker; next += 2) {
        if (next + 2 >= arguments.size() || !setField(options, arguments[next], arguments[next + 1])) {
            return kImportExitArguments;
        }
    }
    options.names.assign(arguments.begin() + static_cast<std::ptrdiff_t>(next) + 1, arguments.end());
    const auto size = static_cast<std::uint64_t>(statusOf(kImportMeshFd).st_size);
    void* const pages = ::mmap(nullptr, size, PROT_READ, MAP_SHARED | MAP_POPULATE, kImportMeshFd, 0);
    const int folder = S_ISDIR(statusOf(kImportFolderFd).st_mode) ? kImportFolderFd : -1;
    if (pages == MAP_FAILED) {
        return exitOf(errno);
    }
    const Result<void> limited =
        enterSandbox({memory + kExtraMemory, static_cast<std::uint32_t>(seconds)}, folder, kImportResultFd);
    if (!limited) {
        const Error error{limited.error().code, limited.error().message +
                                                    "; raise the limits of this "
                                                    "process (ulimit -a)"};
        return image ? sendError(error)
                     : sendMessage(withPrefix("cannot read the mesh " + quotedPath(path),
                                              Result<TriangleMesh>(tl::unexpected<Error>(error))));
    }
    if (orphaned()) {
        return kImportExitArguments;
    }
    prepareHeap(static_cast<std::size_t>(std::min(memory / 4, kHeapBytes)));  // counts towards the limit
    std::set_new_handler([] { ::_exit(kImportExitMemory); });
    if (image) {
        return sendRows({static_cast<const std::byte*>(pages), size});
    }
    const Result<TriangleMesh> raw = importRaw({quotedPath(path),
                                                path.filename().string(),
                                                lowerCase(path.extension().string().substr(1)),
                                                {static_cast<const std::byte*>(pages), size},
                                                folder,
                                                options,
                                                triangles,
                                                *kind});
    return sendMessage(raw);
}

}  // namespace
}  // namespace relief

int main(int argc, char** argv) {
    if (argc < 7) {
        return relief::kImportExitArguments;
    }
    mallopt(M_ARENA_MAX, 1);  // one heap, so that the limit is exact
    int code = relief::kImportExitMemory;
    try {
        code = relief::work({argv, static_cast<std::size_t>(argc)});
    } catch (...) {
        code = relief::kImportExitMemory;
    }
    ::_exit(code);  // without cleanup
}

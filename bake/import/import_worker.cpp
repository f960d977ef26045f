// SPDX-License-Identifier: Apache-2.0
// importMeshInWorker: starts relief-import, waits for it, and checks its answer.
#include <dlfcn.h>
#include <fcntl.h>
#include <poll.h>
#include <signal.h>
#include <sys/mman.h>
#include <sys/resource.h>
#include <sys/stat.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <cerrno>
#include <chrono>
#include <cstring>
#include <memory>
#include <string>
#include <utility>

#include "bake/import/import_fields.h"
#include "bake/import/import_message.h"
#include "bake/import/import_protocol.h"
#include "bake/import/import_source.h"
#include "bake/import/level.h"
#include "bake/import/mesh_import.h"
#include "formats/base/descriptor.h"
#include "formats/base/file_io.h"
#include "formats/base/process.h"

namespace relief {
namespace {

namespace fs = std::filesystem;

constexpr const char* kWorkerName = "relief-import";
constexpr const char* kWorkerFolder = "../libexec/relief";
/// File sizes are signed.
constexpr std::uint64_t kMemoryMax = std::uint64_t{1} << 46;

/// Empty on failure, with errno.
Descriptor memoryFile(std::uint64_t size) {
    Descriptor file(::memfd_create("relief-import", MFD_CLOEXEC | MFD_ALLOW_SEALING));
    return file && ::ftruncate(file.get(), static_cast<off_t>(size)) == 0 ? std::move(file) : Descriptor();
}

/// The file size limit counts for memory, too.
std::uint64_t largestFile(std::uint64_t wanted) {
    rlimit limit{};
    return ::getrlimit(RLIMIT_FSIZE, &limit) == 0 && limit.rlim_cur != RLIM_INFINITY
               ? std::min<std::uint64_t>(wanted, limit.rlim_cur)
               : wanted;
}

/// A sealed copy of the mesh's bytes for the worker. Empty on failure, with errno.
Descriptor sharedBytes(std::span<const std::byte> bytes) {
    Descriptor file = memoryFile(0);
    if (!file) {
        return file;
    }
    errno = reserveMemory(file.get(), bytes.size());
    errno = errno != 0 ? errno : writeAll(file.get(), bytes);
    errno =
        errno != 0 ? errno : addSeals(file.get(), F_SEAL_SHRINK | F_SEAL_GROW | F_SEAL_WRITE | F_SEAL_SEAL);
    return errno == 0 ? std::move(file) : Descriptor();
}

/// The folder of the executable or shared library with this function.
fs::path ownFolder() {
    Dl_info info{};
    const bool found = ::dladdr(reinterpret_cast<const void*>(&ownFolder), &info) != 0;
    return found && info.dli_fname != nullptr ? fs::path(info.dli_fname).parent_path() : fs::path();
}

/// The program, beside this one, where an installation puts it, or beside the library with this function; "" if missing.
std::string workerProgram() {
    std::error_code error;
    const fs::path self = fs::read_symlink("/proc/self/exe", error);
    for (const fs::path& folder : {self.parent_path(), self.parent_path() / kWorkerFolder, ownFolder()}) {
        const std::string program = (folder / kWorkerName).string();
        if (!error && !folder.empty() && ::access(program.c_str(), X_OK) == 0) {
            return program;
        }
    }
    return "";
}

/// \return false if the other end is still open then.
bool closesWithin(int file, std::uint32_t seconds) {
    using Clock = std::chrono::steady_clock;
    const Clock::time_point end = Clock::now() + std::chrono::seconds(seconds);
    pollfd closing{file, 0, 0};
    int ready = -1;
    while (ready <= 0 && Clock::now() < end) {
        const auto left = std::chrono::ceil<std::chrono::milliseconds>(end - Clock::now()).count();
        ready = ::poll(&closing, 1, static_cast<int>(std::min<std::int64_t>(left, 1'000'000)));
    }
    return ready > 0;
}

std::string signalName(int number) {
    const char* const name = ::sigabbrev_np(number);
    return name != nullptr ? "SIG" + std::string(name) : "signal " + std::to_string(number);
}

class Import {
  public:
    Import(const fs::path& path, const ImportOptions& options, const ImportLimits& limits)
        : path_(path), options_(options), limits_(limits) {}

    Result<TriangleMesh> mesh() {
        ImportSource source = RELIEF_TRY(open());
        Result<TriangleMesh> raw = workOn(source, ImportKind::kMesh);
        return raw ? source.finish(std::move(*raw), options_.names.size()) : raw;
    }

    Result<Level> level() {
        ImportSource source = RELIEF_TRY(open());
        TriangleMesh raw = RELIEF_TRY(workOn(source, ImportKind::kLevel));
        return source.finishLevel(std::move(raw), options_.names.size(), options_.materials);
    }

    /// \param kind  kAnimated or kClips.
    Result<AnimatedImport> animated(ImportKind kind) {
        ImportSource source = RELIEF_TRY(open());
        TriangleMesh raw = RELIEF_TRY(workOn(source, kind));
        return source.finishAnimated(std::move(raw), kind);
    }

  private:
    [[nodiscard]] Result<ImportSource> open() const {
        if (limits_.memory == 0 || limits_.memory > kMemoryMax || limits_.seconds == 0 ||
            limits_.triangles == 0 || limits_.triangles > kTriangleMax) {
            return fail(ErrorCode::kUsage,
                        "the importer's limits must be 1 byte to 64 TB, at least 1 second, and 1 to " +
                            std::to_string(kTriangleMax) + " triangles");
        }
        return ImportSource::open(path_);
    }
    [[nodiscard]] tl::unexpected<Error> error(ErrorCode code, const std::string& what) const {
        return fail(code, "cannot read the mesh " + quotedPath(path_) + ": " + what);
    }
    /// \param what  "could not be …"
    [[nodiscard]] tl::unexpected<Error> shortOf(const char* what, int number) const {
        return error(
            ErrorCode::kFailure,
            std::string("the importer ") + what + " (" + std::strerror(number) +
                "); close files, end processes or free memory, or raise the limits (ulimit -n -u -v -f)");
    }
    [[nodiscard]] tl::unexpected<Error> notStarted(int number) const {
        return shortOf("could not be started", number);
    }

    Result<TriangleMesh> workOn(ImportSource& source, ImportKind kind) {
        const std::string program = workerProgram();
        if (program.empty()) {
            return error(ErrorCode::kFailure, std::string("the program ") + kWorkerName +
                                                  " is not beside this one; install it again");
        }
        Descriptor mesh = sharedBytes(source.bytes());
        if (!mesh) {
            return notStarted(errno);
        }
        source.dropBytes();
        const Descriptor result = memoryFile(largestFile(limits_.memory));
        if (!result) {
            return notStarted(errno);
        }
        Descriptor alive;
        Descriptor alive_end;
        if (const int failed = makePipe(alive, alive_end)) {
            return notStarted(failed);
        }
        Process worker;
        if (const int failed =
                start(program, kind, {mesh.get(), source.folder(), result.get(), alive_end.get()}, worker)) {
            return notStarted(failed);
        }
        alive_end.reset();
        if (!closesWithin(alive.get(), limits_.seconds)) {
            return timeIsUp();
        }
        const ProcessEnd end = worker.wait();
        std::byte begun{};
        if (::read(alive.get(), &begun, 1) != 1 && end.signal != SIGKILL &&
            end.exit_code <= kImportExitErrno) {
            return error(
                ErrorCode::kFailure,
                "the importer could not be started, as its libraries cannot be loaded; close files or "
                "raise their limit (ulimit -n), free memory, or install Relief again");
        }
        mesh.reset();
        return answer(end, result.get());
    }

    /// \param files  for kImportMeshFd and the numbers behind it; -1: none, /dev/null. \return 0 or an errno.
    [[nodiscard]] int start(const std::string& program, ImportKind kind, const std::array<int, 4>& files,
                            Process& worker) const {
        ProcessStart start;
        start.program = program;
        start.arguments = {kWorkerName,
                           path_.string(),
                           std::to_string(limits_.memory),
                           std::to_string(limits_.seconds),
                           std::to_string(limits_.triangles),
                           std::string(wordOf(kind))};
        for (const FieldWords& option : changedFields(options_)) {
            start.arguments.push_back(option.name);
            start.arguments.push_back(option.words.front());
        }
        start.arguments.emplace_back(kImportNamesFollow);
        start.arguments.insert(start.arguments.end(), options_.names.begin(), options_.names.end());
        start.files.assign(kImportMeshFd, -1);
        start.files.insert(start.files.end(), files.begin(), files.end());
        // The signals of the worker's limits must end it, even if this process ignores them.
        start.reset_ignored_signals = true;
        return worker.start(start);
    }

    [[nodiscard]] tl::unexpected<Error> timeIsUp() const {
        return error(ErrorCode::kLimit, "the importer did not end within " + std::to_string(limits_.seconds) +
                                            " s; simplify the mesh or raise --import-time");
    }

    Result<TriangleMesh> answer(const ProcessEnd& end, int result) const {
        if (end.signal != 0) {
            return ended(end.signal);
        }
        switch (end.exit_code) {
            case kImportExitMessage:
                return message(result);
            case kImportExitMemory:
                return error(ErrorCode::kLimit,
                             "the importer needs more than " + std::to_string(limits_.memory) +
                                 " bytes; repair or simplify the mesh, or raise --import-memory");
            case kImportExitArguments:
                return error(
                    ErrorCode::kFailure,
                    "the importer was started by another version, or left alone; install Relief again");
            case kImportExitTooLarge:
                return error(ErrorCode::kLimit,
                             "the mesh is too large to be handed over; simplify it, or raise "
                             "--import-memory and this process's file size limit (ulimit -f)");
            default:
                if (end.exit_code > kImportExitErrno) {
                    return shortOf("could not go on", end.exit_code - kImportExitErrno);
                }
                return error(ErrorCode::kInvalidInput, "the importer ended with exit code " +
                                                           std::to_string(end.exit_code) +
                                                           "; export the mesh again, in another format");
        }
    }

    [[nodiscard]] tl::unexpected<Error> ended(int number) const {
        switch (number) {
            case SIGXCPU:
                return timeIsUp();
            case SIGKILL:
            case SIGTERM:
            case SIGINT:
            case SIGHUP:
            case SIGQUIT:
                return error(ErrorCode::kFailure,
                             "the importer was ended by " + signalName(number) +
                                 " from outside (the system may be out of memory); try again");
            case SIGSYS:
                return error(
                    ErrorCode::kInvalidInput,
                    "the importer tried what it may not (SIGSYS), as a hostile file can make it; do not "
                    "trust the file, or report it if you do");
            case SIGBUS:  // its memory is no file that could have been truncated
                return shortOf("could not go on", ENOMEM);
            default:
                return error(ErrorCode::kInvalidInput, "the importer crashed on it (" + signalName(number) +
                                                           "); export the mesh again, in another format");
        }
    }

    Result<TriangleMesh> message(int result) const {
        constexpr int kSeals = F_SEAL_SHRINK | F_SEAL_GROW | F_SEAL_WRITE;
        struct stat status {};
        // Unsealed, it could change during the reading.
        const int seals = ::fcntl(result, F_GET_SEALS);
        if (seals < 0 || (seals & kSeals) != kSeals || ::fstat(result, &status) != 0 || status.st_size == 0) {
            return error(ErrorCode::kFailure,
                         "the importer gave no answer; try again, or export the mesh in another format");
        }
        const auto size = static_cast<std::size_t>(status.st_size);
        const auto unmap = [size](void* pages) { ::munmap(pages, size); };
        const std::unique_ptr<void, decltype(unmap)> pages(
            ::mmap(nullptr, size, PROT_READ, MAP_SHARED | MAP_POPULATE, result, 0), unmap);
        if (pages.get() == MAP_FAILED) {
            return error(ErrorCode::kLimit, std::string("its triangles do not fit into memory (") +
                                                std::strerror(errno) + "); simplify it, or free memory");
        }
        Result<TriangleMesh> raw =
            readImportMessage({static_cast<const std::byte*>(pages.get()), size}, limits_.triangles);
        if (!raw && raw.error().message.find(quotedPath(path_)) == std::string::npos) {
            return error(raw.error().code, raw.error().message + "; export the mesh again");
        }
        return raw;
    }

    const fs::path& path_;
    const ImportOptions& options_;
    const ImportLimits& limits_;
};

}  // namespace

Result<TriangleMesh> importMeshInWorker(const fs::path& path, const ImportOptions& options,
                                        const ImportLimits& limits) {
    return Import(path, options, limits).mesh();
}

Result<Level> importLevelInWorker(const fs::path& path, const ImportOptions& options,
                                  const ImportLimits& limits) {
    return Import(path, options, limits).level();
}

Result<AnimatedImport> importAnimatedFileInWorker(const fs::path& path, ImportKind kind,
                                                  const ImportOptions& options, const ImportLimits& limits) {
    return Import(path, options, limits).animated(kind);
}

}  // namespace relief

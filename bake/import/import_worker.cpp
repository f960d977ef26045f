// importMeshInWorker: starts relief-import, waits for it, and believes nothing that it says.
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
#include <string>
#include <utility>

#include "bake/import/import_message.h"
#include "bake/import/import_protocol.h"
#include "bake/import/import_source.h"
#include "bake/import/mesh_import.h"
#include "formats/base/descriptor.h"
#include "formats/base/file_io.h"
#include "formats/base/process.h"

namespace relief {
namespace {

namespace fs = std::filesystem;

constexpr const char* kWorkerName = "relief-import";
constexpr const char* kWorkerFolder = "../libexec/relief";
/// Sizes of files are signed.
constexpr std::uint64_t kMemoryMax = std::uint64_t{1} << 46;

/// Bytes of a file in memory, for as long as this lives.
class Mapping {
  public:
    Mapping(int file, std::size_t size, int protection)
        : size_(size),
          pages_(size == 0 ? MAP_FAILED
                           : ::mmap(nullptr, size, protection, MAP_SHARED | MAP_POPULATE, file, 0)) {}
    Mapping(const Mapping&) = delete;
    Mapping& operator=(const Mapping&) = delete;
    ~Mapping() {
        if (pages_ != MAP_FAILED) {
            ::munmap(pages_, size_);
        }
    }
    explicit operator bool() const { return pages_ != MAP_FAILED; }
    [[nodiscard]] std::span<std::byte> bytes() const { return {static_cast<std::byte*>(pages_), size_}; }

  private:
    std::size_t size_;
    void* pages_;
};

/// Empty where it cannot be had; errno then says why.
Descriptor memoryFile(std::uint64_t size) {
    Descriptor file(::memfd_create("relief-import", MFD_CLOEXEC | MFD_ALLOW_SEALING));
    if (file && ::ftruncate(file.get(), static_cast<off_t>(size)) != 0) {
        const int number = errno;
        file.reset();
        errno = number;
    }
    return file;
}

/// Memory counts as a file, of which this process may have been allowed little.
std::uint64_t largestFile(std::uint64_t wanted) {
    rlimit limit{};
    return ::getrlimit(RLIMIT_FSIZE, &limit) == 0 && limit.rlim_cur != RLIM_INFINITY
               ? std::min<std::uint64_t>(wanted, limit.rlim_cur)
               : wanted;
}

/// The mesh's bytes where the worker can read, and not change, them.
Descriptor sharedBytes(std::span<const std::byte> bytes) {
    Descriptor file = memoryFile(bytes.size());
    if (!file) {
        return file;
    }
    {
        const Mapping pages(file.get(), bytes.size(), PROT_READ | PROT_WRITE);
        if (!pages) {
            return Descriptor();
        }
        std::memcpy(pages.bytes().data(), bytes.data(), bytes.size());
    }
    constexpr int kSeals = F_SEAL_SHRINK | F_SEAL_GROW | F_SEAL_WRITE | F_SEAL_SEAL;
    return ::fcntl(file.get(), F_ADD_SEALS, kSeals) == 0 ? std::move(file) : Descriptor();
}

/// The program, beside this one or where an installation puts it; "" if it is nowhere.
std::string workerProgram() {
    std::error_code error;
    const fs::path self = fs::read_symlink("/proc/self/exe", error);
    for (const fs::path& folder : {self.parent_path(), self.parent_path() / kWorkerFolder}) {
        const std::string program = (folder / kWorkerName).string();
        if (!error && ::access(program.c_str(), X_OK) == 0) {
            return program;
        }
    }
    return "";
}

/// \return false if the other end is still open after so long.
bool closesWithin(int file, std::uint32_t seconds) {
    using Clock = std::chrono::steady_clock;
    const Clock::time_point end = Clock::now() + std::chrono::seconds(seconds);
    for (;;) {
        const auto left = std::chrono::ceil<std::chrono::milliseconds>(end - Clock::now()).count();
        if (left <= 0) {
            return false;
        }
        pollfd closing{file, 0, 0};
        const int ready = ::poll(&closing, 1, static_cast<int>(std::min<std::int64_t>(left, 1'000'000)));
        if (ready > 0) {
            return true;
        }
        if (ready < 0 && errno != EINTR) {
            return false;
        }
    }
}

std::string signalName(int number) {
    const char* const name = ::sigabbrev_np(number);
    return name != nullptr ? "SIG" + std::string(name) : "signal " + std::to_string(number);
}

class Import {
  public:
    Import(const fs::path& path, const ImportOptions& options, const ImportLimits& limits)
        : path_(path), options_(options), limits_(limits) {}

    Result<TriangleMesh> run() {
        if (limits_.memory == 0 || limits_.memory > kMemoryMax || limits_.seconds == 0) {
            return fail(ErrorCode::kUsage,
                        "the importer's limits must be 1 byte to 64 TB, and at least 1 second");
        }
        ImportSource source = RELIEF_TRY(ImportSource::open(path_));
        Result<TriangleMesh> raw = workOn(source);
        return raw ? source.finish(std::move(*raw), options_.names.size()) : raw;
    }

  private:
    [[nodiscard]] tl::unexpected<Error> error(ErrorCode code, const std::string& what) const {
        return fail(code, "cannot read the mesh " + quotedPath(path_) + ": " + what);
    }
    [[nodiscard]] tl::unexpected<Error> notStarted(int number) const {
        return error(ErrorCode::kFailure, "the importer could not be started (" +
                                              std::string(std::strerror(number)) +
                                              "); free memory or processes");
    }

    Result<TriangleMesh> workOn(ImportSource& source) {
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
        Descriptor alive;
        Descriptor alive_end;
        if (!result || makePipe(alive, alive_end) != 0) {
            return notStarted(errno);
        }
        Process worker;
        if (const int failed =
                start(program, {mesh.get(), source.folder(), result.get(), alive_end.get()}, worker)) {
            return notStarted(failed);
        }
        alive_end.reset();
        mesh.reset();
        if (!closesWithin(alive.get(), limits_.seconds)) {
            return timeIsUp();
        }
        return answer(worker.wait(), result.get());
    }

    /// \param files  for kImportMeshFd and the numbers behind it; -1: none, /dev/null. \return 0 or an errno.
    [[nodiscard]] int start(const std::string& program, const std::array<int, 4>& files,
                            Process& worker) const {
        ProcessStart start;
        start.program = program;
        start.arguments = {kWorkerName,
                           path_.string(),
                           options_.unit.empty() ? "-" : options_.unit,
                           options_.up ? std::string(upAxisName(*options_.up)) : "-",
                           std::to_string(limits_.memory),
                           std::to_string(limits_.seconds)};
        start.arguments.insert(start.arguments.end(), options_.names.begin(), options_.names.end());
        start.files.assign(kImportMeshFd, -1);
        start.files.insert(start.files.end(), files.begin(), files.end());
        // Whatever this process ignores, the worker's limits must be able to end it.
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
            case kImportExitNoSandbox:
                return error(
                    ErrorCode::kFailure,
                    "the importer cannot limit itself, and so does not begin; raise the limits of this "
                    "process (ulimit -a)");
            case kImportExitNoMessage:
                return error(ErrorCode::kLimit,
                             "the mesh is too large to be handed over; simplify it, or raise "
                             "--import-memory and this process's file size limit (ulimit -f)");
            default:
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
            default:
                return error(ErrorCode::kInvalidInput, "the importer crashed on it (" + signalName(number) +
                                                           "); export the mesh again, in another format");
        }
    }

    Result<TriangleMesh> message(int result) const {
        constexpr int kSeals = F_SEAL_SHRINK | F_SEAL_GROW | F_SEAL_WRITE;
        struct stat status {};
        // Unsealed, it could change under our eyes.
        if ((::fcntl(result, F_GET_SEALS) & kSeals) != kSeals || ::fstat(result, &status) != 0) {
            return error(ErrorCode::kInvalidInput, "the importer gave no answer; export the mesh again");
        }
        const Mapping pages(result, static_cast<std::size_t>(status.st_size), PROT_READ);
        if (!pages) {
            return error(ErrorCode::kLimit, "its triangles do not fit into memory; simplify it");
        }
        Result<TriangleMesh> raw = readImportMessage(pages.bytes());
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
    return Import(path, options, limits).run();
}

}  // namespace relief

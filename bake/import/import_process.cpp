// SPDX-License-Identifier: Apache-2.0
#include "bake/import/import_process.h"

#include <dlfcn.h>
#include <fcntl.h>
#include <poll.h>
#include <signal.h>
#include <sys/mman.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <cstring>
#include <filesystem>
#include <system_error>

#include "bake/import/import_protocol.h"

namespace relief {
namespace {

namespace fs = std::filesystem;

constexpr const char* kWorkerName = "relief-import";
constexpr const char* kWorkerFolder = "../libexec/relief";
/// Below the maximum file size, which is signed.
constexpr std::uint64_t kMemoryMax = std::uint64_t{1} << 46;

/// Returns the folder of the executable or shared library that contains this function.
fs::path ownFolder() {
    Dl_info info{};
    const bool found = ::dladdr(reinterpret_cast<const void*>(&ownFolder), &info) != 0;
    return found && info.dli_fname != nullptr ? fs::path(info.dli_fname).parent_path() : fs::path();
}

/// Returns the path of relief-import: beside this program, in an installation's libexec, or beside the library that
/// contains this function; "" if missing.
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

std::string signalName(int number) {
    const char* const name = ::sigabbrev_np(number);
    return name != nullptr ? "SIG" + std::string(name) : "signal " + std::to_string(number);
}

/// Returns the error of a failed system call. \param what  "could not be …"
tl::unexpected<Error> systemError(const char* what, int number) {
    return fail(ErrorCode::kFailure,
                std::string("the importer ") + what + " (" + std::strerror(number) +
                    "); close files, end processes or free memory, or raise the limits (ulimit -n -u -v -f)");
}

}  // namespace

Descriptor memoryFile(std::uint64_t size) {
    Descriptor file(::memfd_create(kWorkerName, MFD_CLOEXEC | MFD_ALLOW_SEALING));
    return file && ::ftruncate(file.get(), static_cast<off_t>(size)) == 0 ? std::move(file) : Descriptor();
}

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

tl::unexpected<Error> ImportProcess::notStarted(int number) {
    return systemError("could not be started", number);
}

Result<void> ImportProcess::checkLimits() const {
    if (limits_.memory == 0 || limits_.memory > kMemoryMax || limits_.seconds == 0 ||
        limits_.triangles == 0 || limits_.triangles > kTriangleMax) {
        return fail(ErrorCode::kUsage,
                    "the importer's limits must be 1 byte to 64 TB, at least 1 second, and 1 to " +
                        std::to_string(kTriangleMax) + " triangles");
    }
    return {};
}

Result<void> ImportProcess::start(const std::string& path, std::string_view kind,
                                  const std::vector<std::string>& more, const std::array<int, 4>& files) {
    ProcessStart start;
    start.program = workerProgram();
    if (start.program.empty()) {
        return fail(ErrorCode::kFailure,
                    std::string("the program ") + kWorkerName + " is not beside this one; reinstall Relief");
    }
    start.arguments = {kWorkerName,
                       path,
                       std::to_string(limits_.memory),
                       std::to_string(limits_.seconds),
                       std::to_string(limits_.triangles),
                       std::string(kind)};
    start.arguments.insert(start.arguments.end(), more.begin(), more.end());
    start.files.assign(kImportMeshFd, -1);
    start.files.insert(start.files.end(), files.begin(), files.end());
    // The worker's limits raise signals that must end it, even if this process ignores them.
    start.reset_ignored_signals = true;
    const int failed = worker_.start(start);
    return failed == 0 ? Result<void>() : notStarted(failed);
}

tl::unexpected<Error> ImportProcess::timeoutError() const {
    return fail(ErrorCode::kLimit, "the importer did not finish within " + std::to_string(limits_.seconds) +
                                       " s; " + smaller_ + " or raise --import-timeout");
}

Result<void> ImportProcess::await(int pipe, short events) {
    using Clock = std::chrono::steady_clock;
    const Clock::time_point begin = Clock::now();
    pollfd ready{pipe, events, 0};
    int found = ::poll(&ready, 1, 0);
    while (found <= 0 && Clock::now() < begin + left_) {
        const auto left = std::chrono::ceil<std::chrono::milliseconds>(begin + left_ - Clock::now()).count();
        found = ::poll(&ready, 1, static_cast<int>(std::clamp<std::int64_t>(left, 0, 1'000'000)));
    }
    left_ -= Clock::now() - begin;
    return found > 0 ? Result<void>() : timeoutError();
}

Result<void> ImportProcess::finish(bool begun) {
    const ProcessEnd end = worker_.wait();
    if (!begun && end.signal != SIGKILL && end.exit_code <= kImportExitErrno) {
        return fail(
            ErrorCode::kFailure,
            "the importer could not be started, because its libraries cannot be loaded; close files or "
            "raise their limit (ulimit -n), free memory, or reinstall Relief");
    }
    if (end.signal != 0) {
        return ended(end.signal);
    }
    switch (end.exit_code) {
        case kImportExitMessage:
            return {};
        case kImportExitMemory:
            return fail(ErrorCode::kLimit, "the importer needs more than " + std::to_string(limits_.memory) +
                                               " bytes; " + smaller_ + ", or raise --max-import-memory");
        case kImportExitArguments:
            return fail(ErrorCode::kFailure,
                        "the importer was started by another version, or its parent ended; reinstall Relief");
        case kImportExitTooLarge:
            return fail(ErrorCode::kLimit, std::string("the ") + noun_ + " is too large to transfer; " +
                                               smaller_ +
                                               ", or raise --max-import-memory and this process's file size "
                                               "limit (ulimit -f)");
        default:
            return end.exit_code > kImportExitErrno
                       ? systemError("could not continue", end.exit_code - kImportExitErrno)
                       : unreadable("ended with exit code " + std::to_string(end.exit_code));
    }
}

tl::unexpected<Error> ImportProcess::unreadable(const std::string& what) const {
    return invalidInput("the importer " + what + "; export the " + noun_ + " again, in another format");
}

tl::unexpected<Error> ImportProcess::ended(int number) const {
    switch (number) {
        case SIGXCPU:
            return timeoutError();
        case SIGKILL:
        case SIGTERM:
        case SIGINT:
        case SIGHUP:
        case SIGQUIT:
            return fail(ErrorCode::kFailure,
                        "the importer was ended by " + signalName(number) +
                            " from outside (the system may be out of memory); try again");
        case SIGSYS:
            return invalidInput(
                "the importer made a forbidden system call (SIGSYS), which suggests a hostile file; do not "
                "use the file; if you trust it, report a bug");
        case SIGBUS:  // not a truncated file: its memory is anonymous
            return systemError("could not continue", ENOMEM);
        default:
            return unreadable("crashed on it (" + signalName(number) + ")");
    }
}

}  // namespace relief

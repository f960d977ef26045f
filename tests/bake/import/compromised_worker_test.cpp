// SPDX-License-Identifier: Apache-2.0
// A worker controlled by a hostile file. A process with the worker's descriptors enters the worker's sandbox and then
// attempts every harmful system call.
#include <fcntl.h>
#include <linux/landlock.h>
#include <linux/openat2.h>
#include <linux/seccomp.h>
#include <pthread.h>
#include <sched.h>
#include <sys/mman.h>
#include <sys/prctl.h>
#include <sys/resource.h>
#include <sys/stat.h>
#include <sys/syscall.h>
#include <sys/uio.h>
#include <sys/wait.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <csignal>
#include <cstdint>
#include <filesystem>
#include <fstream>
#include <functional>
#include <iterator>
#include <set>
#include <string>
#include <utility>
#include <vector>

#include "bake/import/import_protocol.h"
#include "bake/import/import_sandbox.h"
#include "tests/bake/meshes.h"

namespace relief::test {
namespace {

namespace fs = std::filesystem;

constexpr std::uint64_t kMemory = std::uint64_t{256} << 20;
constexpr std::size_t kPage = 4096;
constexpr int kLeakedFd = 7;  ///< a file open for writing; the real worker has none
constexpr int kFiles = 8;
constexpr int kSeals = F_SEAL_SHRINK | F_SEAL_GROW | F_SEAL_WRITE | F_SEAL_SEAL;

constexpr int kDone = 0;     // exit code: the attempt succeeded
constexpr int kRefused = 1;  // exit code: the attempt failed
constexpr int kNoSandbox = 2;

/// The environment of the worker, as in import_protocol.h.
class Place {
  public:
    /// \param rows  if true, the result is a pipe
    explicit Place(bool rows = false) {
        fs::create_directory(folder_.path() / "in");
        folder_.write("in/inside", std::string(kPage, 'i'));
        folder_.write("outside", std::string(kPage, 'o'));
        folder_.write("leaked", std::string(kPage, 'l'));
        files_[kImportMeshFd] = ::memfd_create("mesh", MFD_CLOEXEC | MFD_ALLOW_SEALING);
        files_[kImportFolderFd] = ::open((folder_.path() / "in").c_str(), O_PATH | O_DIRECTORY | O_CLOEXEC);
        files_[kImportResultFd] = ::memfd_create("result", MFD_CLOEXEC | MFD_ALLOW_SEALING);
        int ends[2] = {-1, -1};
        ready_ = ::pipe2(ends, O_CLOEXEC) == 0 && ::ftruncate(files_[kImportMeshFd], kPage) == 0 &&
                 ::ftruncate(files_[kImportResultFd], kPage) == 0 &&
                 ::fcntl(files_[kImportMeshFd], F_ADD_SEALS, kSeals) == 0;
        alive_ = ends[0];
        files_[kImportAliveFd] = ends[1];
        files_[kLeakedFd] = ::open((folder_.path() / "leaked").c_str(), O_RDWR | O_CLOEXEC);
        if (rows) {
            ::close(std::exchange(files_[kImportResultFd], ::fcntl(ends[1], F_DUPFD_CLOEXEC, 0)));
        }
        for (int file = 0; file < kImportMeshFd; ++file) {
            files_[static_cast<std::size_t>(file)] = ::open("/dev/null", O_RDWR | O_CLOEXEC);
        }
    }
    Place(const Place&) = delete;
    Place& operator=(const Place&) = delete;
    ~Place() {
        for (const int file : files_) {
            ::close(file);
        }
        ::close(alive_);
    }

    [[nodiscard]] bool ready() const {
        return ready_ && *std::min_element(files_.begin(), files_.end()) >= 0;
    }
    [[nodiscard]] fs::path path(const char* name) const { return folder_.path() / name; }
    [[nodiscard]] int result() const { return files_[kImportResultFd]; }
    [[nodiscard]] std::set<fs::path> names() const {
        std::set<fs::path> names;
        for (const fs::directory_entry& entry : fs::recursive_directory_iterator(folder_.path())) {
            names.insert(entry.path());
        }
        return names;
    }
    [[nodiscard]] std::string contents(const char* name) const {
        std::ifstream file(path(name));
        return {std::istreambuf_iterator<char>(file), {}};
    }

    /// Called in the child: moves the descriptors to their numbers and closes all others.
    void become() const {
        std::array<int, kFiles> raised{};
        for (std::size_t i = 0; i < kFiles; ++i) {
            raised[i] = ::fcntl(files_[i], F_DUPFD, 100);
        }
        for (std::size_t i = 0; i < kFiles; ++i) {
            ::dup2(raised[i], static_cast<int>(i));
        }
        ::closefrom(kFiles);
    }

  private:
    TemporaryFolder folder_;
    std::array<int, kFiles> files_{};
    int alive_ = -1;
    bool ready_ = false;
};

struct End {
    int code = -1;   ///< exit code of the worker; -1 if a signal killed it
    int signal = 0;  ///< the signal that killed it
    bool refused() const { return code == kRefused || signal == SIGSYS; }
};

/// Makes an attempt in a child process, inside or outside the sandbox.
End ask(const Place& place, bool sandbox, const std::function<bool()>& what) {
    const pid_t child = ::fork();
    if (child == 0) {
        place.become();
        ::alarm(20);
        if (sandbox && !enterSandbox({kMemory, 5}, kImportFolderFd, kImportResultFd)) {
            ::_exit(kNoSandbox);
        }
        ::_exit(what() ? kDone : kRefused);
    }
    int status = 0;
    ::waitpid(child, &status, 0);
    return WIFEXITED(status) ? End{WEXITSTATUS(status), 0} : End{-1, WTERMSIG(status)};
}

template <class... Arguments>
long raw(long call, Arguments... arguments) {
    return ::syscall(call, arguments...);
}

struct Attempt {
    const char* name;
    std::function<bool()> what;  ///< returns true if it succeeded
    bool alone = true;           ///< succeeds outside the sandbox, on any machine and for any user
};

void* mapped(std::uint64_t size, int protection) {
    return ::mmap(nullptr, size, protection, MAP_PRIVATE | MAP_ANONYMOUS, -1, 0);
}

bool sharesForWriting(int file) {
    auto* const pages =
        static_cast<char*>(::mmap(nullptr, kPage, PROT_READ | PROT_WRITE, MAP_SHARED, file, 0));
    if (pages == MAP_FAILED) {
        return false;
    }
    pages[0] = 'X';
    return true;
}

bool opens(const fs::path& path, std::uint64_t flags) {
    open_how how{};
    how.flags = flags;
    how.mode = (flags & O_CREAT) != 0 ? 0600 : 0;
    return raw(SYS_openat2, kImportFolderFd, path.c_str(), &how, sizeof(how)) >= 0;
}

std::vector<Attempt> attempts(const Place& place) {
    const fs::path inside = place.path("in/inside");
    const fs::path outside = place.path("outside");
    const fs::path fresh = place.path("in/fresh");
    const pid_t parent = ::getpid();
    static char byte = 'X';
    static iovec vector{&byte, 1};
    static rlimit limit{0, 0};
    static std::uint64_t how[11] = {0, 0, 0, 0, SIGCHLD};
    const auto forked = [](long child) {
        if (child == 0) {
            ::_exit(0);
        }
        return child > 0;
    };
    return {
        // open for reading or writing
        {"open", [=] { return raw(SYS_open, outside.c_str(), O_RDONLY) >= 0; }},
        {"open /etc/passwd", [=] { return raw(SYS_openat, AT_FDCWD, "/etc/passwd", O_RDONLY) >= 0; }},
        {"open to write", [=] { return raw(SYS_openat, AT_FDCWD, inside.c_str(), O_WRONLY) >= 0; }},
        {"openat from its folder", [=] { return raw(SYS_openat, kImportFolderFd, "inside", O_RDONLY) >= 0; }},
        {"openat2 outside", [=] { return opens(outside, O_RDONLY); }},
        {"openat2 above", [=] { return opens("../outside", O_RDONLY); }},
        {"openat2 to write", [=] { return opens("inside", O_WRONLY); }},
        {"openat2 to truncate", [=] { return opens("inside", O_WRONLY | O_TRUNC); }},
        {"openat2 to create", [=] { return opens("fresh", O_WRONLY | O_CREAT); }},
        {"openat2 a folder", [=] { return opens(".", O_RDONLY | O_DIRECTORY); }},
        {"openat2 a device", [=] { return opens("/dev/zero", O_RDONLY); }},
        {"openat2 itself", [=] { return opens("/proc/self/mem", O_RDWR); }},
        // write without permission: a leaked file, standard output, the mesh, the pipe
        {"write", [=] { return raw(SYS_write, kLeakedFd, &byte, 1) == 1; }},
        {"write to standard output", [=] { return raw(SYS_write, STDOUT_FILENO, &byte, 1) == 1; }},
        {"write to the pipe", [=] { return raw(SYS_write, kImportAliveFd, &byte, 1) == 1; }},
        {"writev", [=] { return raw(SYS_writev, kLeakedFd, &vector, 1) == 1; }},
        {"share the mesh", [=] { return sharesForWriting(kImportMeshFd); }, false},
        {"share a file", [=] { return sharesForWriting(kLeakedFd); }},
        {"ftruncate", [=] { return raw(SYS_ftruncate, kLeakedFd, 1) == 0; }},
        {"fallocate", [=] { return raw(SYS_fallocate, kLeakedFd, 0, 0, kPage) == 0; }},
        {"punch a hole", [=] { return raw(SYS_fallocate, kLeakedFd, 3, 0, kPage) == 0; }, false},
        {"fcntl dup", [=] { return raw(SYS_fcntl, kLeakedFd, F_DUPFD, 0) >= 0; }},
        {"memory to run", [=] { return mapped(kPage, PROT_READ | PROT_WRITE | PROT_EXEC) != MAP_FAILED; }},
        {"memory made to run",
         [=] {
             return raw(SYS_mprotect, mapped(kPage, PROT_READ | PROT_WRITE), kPage, PROT_READ | PROT_EXEC) ==
                    0;
         }},
        // run code or another process
        {"clone", [=] { return forked(raw(SYS_clone, SIGCHLD, 0, 0, 0, 0)); }},
        {"clone into a namespace",
         [=] { return forked(raw(SYS_clone, CLONE_NEWUSER | SIGCHLD, 0, 0, 0, 0)); }, false},
        {"clone3", [=] { return forked(raw(SYS_clone3, how, sizeof(how))); },
         false},  // unavailable in some containers
        // the parent and other processes
        {"tgkill the parent", [=] { return raw(SYS_tgkill, parent, parent, 0) == 0; }},
        {"the parent's limits", [=] { return raw(SYS_prlimit64, parent, RLIMIT_CPU, nullptr, &limit) == 0; }},
        // its own limits
        {"raise a limit", [=] { return raw(SYS_prlimit64, 0, RLIMIT_CORE, &limit, nullptr) == 0; }},
        {"become dumpable", [=] { return raw(SYS_prctl, PR_SET_DUMPABLE, 1) == 0; }},
        {"outlive the parent", [=] { return raw(SYS_prctl, PR_SET_PDEATHSIG, 0) == 0; }},
        {"terminal", [=] { return raw(SYS_ioctl, kLeakedFd, 0x5421, &byte) == 0; }},
    };
}

/// Most checks need seccomp, which every kernel that runs the tests supports.
bool kernelHasSeccomp() {
    return ::prctl(PR_SET_SECCOMP, SECCOMP_MODE_FILTER, nullptr) != 0 && errno == EFAULT;
}

/// Without Landlock, only ImportFiles restricts the worker to the folder.
bool kernelHasLandlock() {
    return ::syscall(SYS_landlock_create_ruleset, nullptr, 0, LANDLOCK_CREATE_RULESET_VERSION) >= 1;
}

/// System calls that the filter allows or fails. attempts() covers the harmful ones.
const std::vector<std::set<long>> kAnswered = {
    {SYS_brk, SYS_munmap, SYS_mremap, SYS_madvise, SYS_mmap, SYS_mprotect},
    {SYS_read, SYS_readv, SYS_pread64, SYS_lseek, SYS_close, SYS_fstat, SYS_poll, SYS_ppoll},
    {SYS_futex, SYS_set_robust_list, SYS_rseq, SYS_sched_yield, SYS_sched_getaffinity},
    {SYS_rt_sigaction, SYS_rt_sigprocmask, SYS_rt_sigreturn, SYS_restart_syscall},
    {SYS_getpid, SYS_gettid, SYS_exit, SYS_exit_group, SYS_clone3},
    {SYS_clock_gettime, SYS_gettimeofday, SYS_clock_nanosleep, SYS_nanosleep},
    {SYS_sysinfo, SYS_uname, SYS_getrandom, SYS_prlimit64, SYS_getrlimit},
    {SYS_open, SYS_openat, SYS_stat, SYS_lstat, SYS_statx, SYS_access, SYS_faccessat, SYS_faccessat2},
    {SYS_readlink, SYS_readlinkat, SYS_getcwd, SYS_ioctl, SYS_writev, SYS_write}};

bool isAnswered(long call) {
#ifdef RELIEF_SANITIZED
    if (std::set<long>{SYS_pipe, SYS_pipe2, SYS_sigaltstack, SYS_getrusage}.contains(call)) {
        return true;
    }
#endif
    return std::ranges::any_of(kAnswered, [&](const std::set<long>& calls) { return calls.contains(call); });
}

// Tests every other system call by number, such as file changes, sockets and processes.
TEST(CompromisedWorker, OtherSystemCallsEndIt) {
    ASSERT_TRUE(kernelHasSeccomp());
    const Place place;
    ASSERT_TRUE(place.ready());
    for (const long call : {SYS_unlink, SYS_socket, SYS_execve, SYS_fork, SYS_ptrace, SYS_kill, SYS_dup}) {
        ASSERT_FALSE(isAnswered(call));
    }
    constexpr long kEnd = 470;  // above the highest system call number
    for (long call = 0; call < kEnd; call = call == 334 ? 424 : call + 1) {
        if (!isAnswered(call)) {
            EXPECT_EQ(ask(place, true, [call] { return raw(call, 0, 0, 0, 0, 0, 0) >= 0; }).signal, SIGSYS)
                << call;
        }
    }
}

TEST(CompromisedWorker, ReachesNothing) {
    ASSERT_TRUE(kernelHasSeccomp());
    RecordProperty("landlock", kernelHasLandlock() ? "yes" : "no");
    const Place place;
    ASSERT_TRUE(place.ready());
    const std::set<fs::path> names = place.names();
    for (const Attempt& attempt : attempts(place)) {
        SCOPED_TRACE(attempt.name);
        if (!kernelHasLandlock() && std::string_view(attempt.name).starts_with("openat2 ")) {
            continue;
        }
#ifdef RELIEF_SANITIZED
        // Sanitizers write reports.
        if (std::string_view(attempt.name).starts_with("write to ") ||
            attempt.name == std::string_view("write")) {
            continue;
        }
#endif
        const End end = ask(place, true, attempt.what);
        EXPECT_TRUE(end.refused()) << "exit code " << end.code << ", signal " << end.signal;
        EXPECT_EQ(place.names(), names);
        EXPECT_EQ(place.contents("in/inside"), std::string(kPage, 'i'));
        EXPECT_EQ(place.contents("outside"), std::string(kPage, 'o'));
        EXPECT_EQ(place.contents("leaked"), std::string(kPage, 'l'));
    }
}

TEST(CompromisedWorker, CouldReachEverythingWithoutTheSandbox) {
    for (std::size_t i = 0; i < attempts(Place()).size(); ++i) {
        const Place place;
        ASSERT_TRUE(place.ready());
        const Attempt attempt = attempts(place)[i];
        if (attempt.alone) {
            EXPECT_EQ(ask(place, false, attempt.what).code, kDone) << attempt.name;
        }
    }
}

TEST(CompromisedWorker, CanDoItsWork) {
    const Place place;
    ASSERT_TRUE(place.ready());
    const auto can = [&](const std::function<bool()>& what) { return ask(place, true, what).code == kDone; };
    EXPECT_TRUE(can([] { return opens("inside", O_RDONLY); }));
    EXPECT_TRUE(can([] {
        pthread_t thread{};
        void* answer = nullptr;
        return ::pthread_create(
                   &thread, nullptr, [](void* self) { return self; }, &answer) == 0 &&
               ::pthread_join(thread, &answer) == 0 && answer == &answer;
    }));
    EXPECT_TRUE(can([] {
        return sharesForWriting(kImportResultFd) && ::fallocate(kImportResultFd, 0, 0, 16) == 0 &&
               ::ftruncate(kImportResultFd, 16) == 0;
    }));
    struct stat status {};
    EXPECT_EQ(::fstat(place.result(), &status), 0);
    EXPECT_EQ(status.st_size, 16);
    EXPECT_TRUE(can([] { return ::fcntl(kImportResultFd, F_ADD_SEALS, kSeals) == 0; }));
    const End aborted = ask(place, true, [] {
        ::abort();
        return false;
    });
    EXPECT_EQ(aborted.signal, SIGABRT);
}

TEST(CompromisedWorker, ImageWorkerWritesOnlyToItsPipe) {
    const Place place(true);
    ASSERT_TRUE(place.ready());
    static char byte = 'X';
    EXPECT_EQ(ask(place, true, [] { return raw(SYS_write, kImportResultFd, &byte, 1) == 1; }).code, kDone);
    for (const auto& what : std::vector<std::function<bool()>>{
             [] { return sharesForWriting(kLeakedFd); },
             [] { return raw(SYS_writev, kImportResultFd, nullptr, 0) == 0; },
             [] { return raw(SYS_ftruncate, kLeakedFd, 1) == 0; },
             [] { return raw(SYS_fcntl, kImportResultFd, F_SETFL, O_NONBLOCK) == 0; },
#ifndef RELIEF_SANITIZED
             [] { return raw(SYS_write, kLeakedFd, &byte, 1) == 1; },
             [] { return raw(SYS_write, STDOUT_FILENO, &byte, 1) == 1; },
#endif
         }) {
        EXPECT_TRUE(ask(place, true, what).refused());
    }
    EXPECT_EQ(place.contents("leaked"), std::string(kPage, 'l'));
}

TEST(CompromisedWorker, HasKernelLimits) {
    const Place place;
    ASSERT_TRUE(place.ready());
    const auto hard = [](__rlimit_resource resource) {
        rlimit limit{};
        ::getrlimit(resource, &limit);
        return limit.rlim_max;
    };
    const auto holds = [&](const std::function<bool()>& what) {
        return ask(place, true, what).code == kDone;
    };
    EXPECT_TRUE(holds([&] { return hard(RLIMIT_CORE) == 0 && hard(RLIMIT_FSIZE) == 0; }));
    EXPECT_TRUE(holds([&] { return hard(RLIMIT_CPU) <= 6; }));
    EXPECT_TRUE(holds([] {
        int number = 0;
        return ::prctl(PR_GET_DUMPABLE) == 0 && ::prctl(PR_GET_NO_NEW_PRIVS, 0, 0, 0, 0) == 1 &&
               ::prctl(PR_GET_PDEATHSIG, &number) == 0 && number == SIGKILL;
    }));
#ifndef RELIEF_SANITIZED
    const auto maps = [](std::uint64_t size) { return mapped(size, PROT_READ | PROT_WRITE) != MAP_FAILED; };
    EXPECT_TRUE(holds([&] { return maps(kMemory / 2); }));
    EXPECT_EQ(ask(place, true, [&] { return maps(kMemory + 4096); }).code, kRefused);
#endif
}

/// Unbounded recursion.
[[gnu::noinline]] std::size_t descend(std::size_t depth, volatile char* above) {
    volatile char here[kPage] = {};
    here[depth % kPage] = static_cast<char>(above[0] + 1);
    return depth * kPage > (std::size_t{64} << 20)
               ? depth
               : descend(depth + 1, here) + static_cast<std::size_t>(here[0]);
}

TEST(CompromisedWorker, HasASmallStack) {
    const Place place;
    ASSERT_TRUE(place.ready());
    const auto recurse = [] {
        volatile char top[1] = {};
        return descend(0, top) > 0;
    };
    rlimit before{};
    ASSERT_EQ(::getrlimit(RLIMIT_STACK, &before), 0);
    const auto deep = [&] {
        const rlimit unlimited{before.rlim_max, before.rlim_max};
        return ::setrlimit(RLIMIT_STACK, &unlimited) == 0;
    };
    if (before.rlim_max == RLIM_INFINITY) {
        EXPECT_EQ(ask(place, false, [&] { return deep() && recurse(); }).code, kDone);
    }
    EXPECT_EQ(ask(place, true,
                  [] {
                      rlimit limit{};
                      return ::getrlimit(RLIMIT_STACK, &limit) == 0 && limit.rlim_max <= kSandboxStack;
                  })
                  .code,
              kDone);
    const End end = ask(place, true, recurse);
#ifdef RELIEF_SANITIZED
    EXPECT_TRUE(end.signal != 0 || end.code == 1);  // reported by the sanitizer
#else
    EXPECT_EQ(end.signal, SIGSEGV);
#endif
}

}  // namespace
}  // namespace relief::test

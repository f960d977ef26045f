// SPDX-License-Identifier: Apache-2.0
#include "bake/import/import_sandbox.h"

#include <fcntl.h>
#include <linux/landlock.h>
#include <linux/seccomp.h>
#include <sched.h>
#include <seccomp.h>
#include <signal.h>
#include <sys/mman.h>
#include <sys/prctl.h>
#include <sys/resource.h>
#include <sys/stat.h>
#include <sys/syscall.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <cstring>
#include <fstream>
#include <initializer_list>
#include <memory>
#include <string>
#include <type_traits>
#include <utility>

#include "formats/base/descriptor.h"

namespace relief {
namespace {

// Missing from the kernel headers of Debian 12.
constexpr std::uint64_t kLandlockTruncate = std::uint64_t{1} << 14U;

tl::unexpected<Error> cannot(const char* what) {
    return fail(ErrorCode::kFailure,
                std::string("the importer cannot ") + what + " (" + std::strerror(errno) + ")");
}

/// Lowers a limit; keeps it if it is already lower.
bool lowerLimit(__rlimit_resource resource, std::uint64_t soft, std::uint64_t hard) {
    rlimit limit{};
    if (::getrlimit(resource, &limit) != 0) {
        return false;
    }
    limit.rlim_max = std::min<rlim_t>(limit.rlim_max, hard);
    limit.rlim_cur = std::min<rlim_t>({limit.rlim_cur, limit.rlim_max, soft});
    return ::setrlimit(resource, &limit) == 0;
}

/// Returns the size of this process's address space in bytes; 0 if it cannot be read.
[[maybe_unused]] std::uint64_t addressSpace() {  // unused under sanitizers
    std::ifstream file("/proc/self/statm");
    std::uint64_t pages = 0;
    file >> pages;
    return pages * static_cast<std::uint64_t>(::sysconf(_SC_PAGESIZE));
}

/// Applies Landlock. No effect on kernels without it; the importer opens files only through ImportFiles anyway.
Result<void> enterLandlock(int folder) {
    const long abi = ::syscall(SYS_landlock_create_ruleset, nullptr, 0, LANDLOCK_CREATE_RULESET_VERSION);
    if (abi < 1) {
        return {};
    }
    landlock_ruleset_attr rules{};
    rules.handled_access_fs =
        (std::uint64_t{LANDLOCK_ACCESS_FS_MAKE_SYM} << 1U) - 1U;  // all rights of ABI version 1
    rules.handled_access_fs |= abi >= 2 ? std::uint64_t{LANDLOCK_ACCESS_FS_REFER} : 0U;
    rules.handled_access_fs |= abi >= 3 ? kLandlockTruncate : 0U;
    const Descriptor ruleset(
        static_cast<int>(::syscall(SYS_landlock_create_ruleset, &rules, sizeof(rules), 0)));
    if (!ruleset) {
        return cannot("create Landlock rules");
    }
    if (folder >= 0) {
        landlock_path_beneath_attr beneath{};
        beneath.allowed_access = LANDLOCK_ACCESS_FS_READ_FILE;
        beneath.parent_fd = folder;
        if (::syscall(SYS_landlock_add_rule, ruleset.get(), LANDLOCK_RULE_PATH_BENEATH, &beneath, 0) != 0) {
            return cannot("allow its folder in Landlock");
        }
    }
    if (::syscall(SYS_landlock_restrict_self, ruleset.get(), 0) != 0) {
        return cannot("enter Landlock");
    }
    return {};
}

// --- system calls ---

/// System calls that are harmless with any arguments.
constexpr int kAllowed[] = {
    // memory
    SCMP_SYS(brk), SCMP_SYS(munmap), SCMP_SYS(mremap), SCMP_SYS(madvise),
    // open descriptors
    SCMP_SYS(read), SCMP_SYS(readv), SCMP_SYS(pread64), SCMP_SYS(lseek), SCMP_SYS(close), SCMP_SYS(fstat),
    SCMP_SYS(poll), SCMP_SYS(ppoll),
    // threads and signals
    SCMP_SYS(futex), SCMP_SYS(set_robust_list), SCMP_SYS(rseq), SCMP_SYS(sched_yield),
    SCMP_SYS(sched_getaffinity), SCMP_SYS(rt_sigaction), SCMP_SYS(rt_sigprocmask), SCMP_SYS(rt_sigreturn),
    SCMP_SYS(restart_syscall), SCMP_SYS(getpid), SCMP_SYS(gettid), SCMP_SYS(exit), SCMP_SYS(exit_group),
    // clocks, and the machine's size, which libc's sort queries
    SCMP_SYS(clock_gettime), SCMP_SYS(gettimeofday), SCMP_SYS(clock_nanosleep), SCMP_SYS(nanosleep),
    SCMP_SYS(sysinfo), SCMP_SYS(uname), SCMP_SYS(getrandom),
#ifdef RELIEF_SANITIZED
    // The sanitizers probe memory through pipes, give each thread a signal stack, and write reports.
    SCMP_SYS(pipe), SCMP_SYS(pipe2), SCMP_SYS(write), SCMP_SYS(sigaltstack), SCMP_SYS(getrusage)
#endif
};

struct Refused {
    int call;
    int error;
};

/// Libraries try these calls and work without them. If clone3 fails, glibc uses clone, whose flags a filter can check.
constexpr Refused kRefused[] = {
    {SCMP_SYS(clone3), ENOSYS},   {SCMP_SYS(open), EACCES},       {SCMP_SYS(openat), EACCES},
    {SCMP_SYS(stat), EACCES},     {SCMP_SYS(lstat), EACCES},      {SCMP_SYS(statx), EACCES},
    {SCMP_SYS(access), EACCES},   {SCMP_SYS(faccessat), EACCES},  {SCMP_SYS(faccessat2), EACCES},
    {SCMP_SYS(readlink), EACCES}, {SCMP_SYS(readlinkat), EACCES}, {SCMP_SYS(getcwd), EACCES},
    {SCMP_SYS(ioctl), ENOTTY},    {SCMP_SYS(writev), EPERM},
};

constexpr auto kThread = static_cast<scmp_datum_t>(CLONE_VM | CLONE_SIGHAND | CLONE_THREAD);
/// Further thread flags of glibc and musl.
constexpr auto kThreadOptional =
    static_cast<scmp_datum_t>(CLONE_FS | CLONE_FILES | CLONE_SYSVSEM | CLONE_SETTLS | CLONE_PARENT_SETTID |
                              CLONE_CHILD_SETTID | CLONE_CHILD_CLEARTID | CLONE_DETACHED);

using Filter = std::unique_ptr<std::remove_pointer_t<scmp_filter_ctx>, void (*)(scmp_filter_ctx)>;

class Rules {
  public:
    explicit Rules(scmp_filter_ctx filter) : filter_(filter) {}

    /// Matches if argument `index`, masked, equals `value`.
    static scmp_arg_cmp masked(unsigned index, scmp_datum_t mask, scmp_datum_t value) {
        return {index, SCMP_CMP_MASKED_EQ, mask, value};
    }
    static scmp_arg_cmp is(unsigned index, scmp_datum_t value) { return {index, SCMP_CMP_EQ, value, 0}; }

    void allow(int call, std::initializer_list<scmp_arg_cmp> where = {}) { add(SCMP_ACT_ALLOW, call, where); }
    void refuse(const Refused& refused, std::initializer_list<scmp_arg_cmp> where = {}) {
        add(SCMP_ACT_ERRNO(static_cast<unsigned>(refused.error)), refused.call, where);
    }
    /// Returns 0, or the errno of the first rule that could not be added.
    [[nodiscard]] int failure() const { return failure_; }

  private:
    void add(std::uint32_t action, int call, std::initializer_list<scmp_arg_cmp> where) {
        const int code = ::seccomp_rule_add_array(filter_, action, call, static_cast<unsigned>(where.size()),
                                                  where.begin());
        if (code != 0 && failure_ == 0) {
            failure_ = -code;
        }
    }

    scmp_filter_ctx filter_;
    int failure_ = 0;
};

void addRules(Rules& rules, int folder, int result) {
    for (const int call : kAllowed) {
        rules.allow(call);
    }
    for (const Refused& refused : kRefused) {
        rules.refuse(refused);
    }
    // Memory is readable and writable, never executable. Only the result may be shared.
    const auto shared = static_cast<scmp_datum_t>(MAP_SHARED);
    rules.allow(SCMP_SYS(mmap), {Rules::masked(2, PROT_EXEC, 0), Rules::masked(3, shared, 0)});
    rules.allow(SCMP_SYS(mprotect), {Rules::masked(2, PROT_EXEC, 0)});
    if (folder >= 0) {
        // A filter cannot check the path; Landlock does.
        rules.allow(SCMP_SYS(openat2), {Rules::is(0, static_cast<scmp_datum_t>(folder))});
    }
    const auto file = static_cast<scmp_datum_t>(result);
    struct stat status {};
    const bool pipe = ::fstat(result, &status) == 0 && S_ISFIFO(status.st_mode);
#ifndef RELIEF_SANITIZED
    if (pipe) {
        rules.allow(SCMP_SYS(write), {Rules::is(0, file)});
        rules.refuse({SCMP_SYS(write), EPERM}, {{0, SCMP_CMP_NE, file, 0}});
    } else {
        rules.refuse({SCMP_SYS(write), EPERM});
    }
#endif
    if (result >= 0 && !pipe) {
        rules.allow(SCMP_SYS(mmap),
                    {Rules::masked(2, PROT_EXEC, 0), Rules::masked(3, shared, shared), Rules::is(4, file)});
        rules.allow(SCMP_SYS(ftruncate), {Rules::is(0, file)});
        rules.allow(SCMP_SYS(fallocate), {Rules::is(0, file), Rules::is(1, 0)});
        rules.allow(SCMP_SYS(fcntl), {Rules::is(0, file), Rules::is(1, F_ADD_SEALS)});
    }
    // For glibc's fstat().
    rules.allow(SCMP_SYS(newfstatat), {Rules::is(3, AT_EMPTY_PATH)});
    // Only queries by prctl() and prlimit64().
    for (const int query : {PR_GET_DUMPABLE, PR_GET_NO_NEW_PRIVS, PR_GET_PDEATHSIG}) {
        rules.allow(SCMP_SYS(prctl), {Rules::is(0, static_cast<scmp_datum_t>(query))});
    }
    rules.allow(SCMP_SYS(prlimit64), {Rules::is(0, 0), Rules::is(2, 0)});
    rules.allow(SCMP_SYS(getrlimit));
    rules.allow(SCMP_SYS(clone), {Rules::masked(0, ~kThreadOptional, kThread)});
    // For abort(), in this process only.
    rules.allow(SCMP_SYS(tgkill), {Rules::is(0, static_cast<scmp_datum_t>(::getpid()))});
}

/// Blocks all system calls that reading a mesh does not need. Allows non-executable memory, threads, reading from
/// descriptors, openat2 (which Landlock restricts to reading below a folder), clocks, and exit. Optional calls of
/// libraries return an error (kRefused); all others end the process with SIGSYS. Requires PR_SET_NO_NEW_PRIVS. No effect
/// on kernels without seccomp.
Result<void> enterSeccomp(int folder, int result) {
    // EFAULT means that the kernel supports filters and rejects this null pointer.
    if (::prctl(PR_SET_SECCOMP, SECCOMP_MODE_FILTER, nullptr) == 0 || errno != EFAULT) {
        return {};
    }
    const Filter filter(::seccomp_init(SCMP_ACT_KILL_PROCESS), ::seccomp_release);
    if (filter == nullptr) {
        errno = ENOMEM;
        return cannot("limit its system calls");
    }
    // Report the kernel's errno, and kill calls of other architectures.
    for (const auto& [attribute, value] : {std::pair{SCMP_FLTATR_API_SYSRAWRC, 1U},
                                           std::pair{SCMP_FLTATR_ACT_BADARCH, SCMP_ACT_KILL_PROCESS}}) {
        errno = -::seccomp_attr_set(filter.get(), attribute, value);
        if (errno != 0) {
            return cannot("limit its system calls");
        }
    }
    Rules rules(filter.get());
    addRules(rules, folder, result);
    errno = rules.failure() != 0 ? rules.failure() : -::seccomp_load(filter.get());
    return errno == 0 ? Result<void>() : cannot("limit its system calls");
}

}  // namespace

Result<void> enterSandbox(const SandboxLimits& limits, int folder, int result) {
    if (::prctl(PR_SET_PDEATHSIG, SIGKILL) != 0) {
        return cannot("set its parent-death signal");
    }
#ifndef RELIEF_SANITIZED  // the sanitizers' shadow memory needs terabytes of address space
    const std::uint64_t taken = addressSpace();
    if (taken == 0 || !lowerLimit(RLIMIT_AS, taken + limits.memory, taken + limits.memory)) {
        return cannot("limit its memory");
    }
#endif
    // SIGXCPU first; SIGKILL one second later, if SIGXCPU is caught.
    if (!lowerLimit(RLIMIT_CPU, limits.seconds, std::uint64_t{limits.seconds} + 1U) ||
        !lowerLimit(RLIMIT_STACK, kSandboxStack, kSandboxStack) || !lowerLimit(RLIMIT_CORE, 0, 0) ||
        !lowerLimit(RLIMIT_FSIZE, 0, 0)) {
        return cannot("lower its limits");
    }
    if (::prctl(PR_SET_NO_NEW_PRIVS, 1, 0, 0, 0) != 0 || ::prctl(PR_SET_DUMPABLE, 0) != 0) {
        return cannot("give up privileges");
    }
    RELIEF_TRY(enterLandlock(folder));
    return enterSeccomp(folder, result);
}

}  // namespace relief

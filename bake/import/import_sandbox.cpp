#include "bake/import/import_sandbox.h"

#include <linux/landlock.h>
#include <signal.h>
#include <sys/prctl.h>
#include <sys/resource.h>
#include <sys/syscall.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <cstring>
#include <fstream>
#include <string>

#include "bake/import/import_seccomp.h"
#include "formats/base/descriptor.h"

namespace relief {
namespace {

// Rights that the kernel's header of Debian 12 does not name yet.
constexpr std::uint64_t kLandlockTruncate = std::uint64_t{1} << 14U;

tl::unexpected<Error> cannot(const char* what) {
    return fail(ErrorCode::kFailure,
                std::string("the importer cannot ") + what + " (" + std::strerror(errno) + ")");
}

/// Lowers a limit; one that is lower already stays.
bool lowerLimit(__rlimit_resource resource, std::uint64_t soft, std::uint64_t hard) {
    rlimit limit{};
    if (::getrlimit(resource, &limit) != 0) {
        return false;
    }
    limit.rlim_max = std::min<rlim_t>(limit.rlim_max, hard);
    limit.rlim_cur = std::min<rlim_t>({limit.rlim_cur, limit.rlim_max, soft});
    return ::setrlimit(resource, &limit) == 0;
}

/// Address space of this process, in bytes; 0 if it cannot be read.
[[maybe_unused]] std::uint64_t addressSpace() {  // not asked for under the sanitizers
    std::ifstream file("/proc/self/statm");
    std::uint64_t pages = 0;
    file >> pages;
    return pages * static_cast<std::uint64_t>(::sysconf(_SC_PAGESIZE));
}

/// Kernels without Landlock are left as they are: what the importer opens goes through ImportFiles anyway.
Result<void> enterLandlock(int folder) {
    const long abi = ::syscall(SYS_landlock_create_ruleset, nullptr, 0, LANDLOCK_CREATE_RULESET_VERSION);
    if (abi < 1) {
        return {};
    }
    landlock_ruleset_attr rules{};
    rules.handled_access_fs =
        (std::uint64_t{LANDLOCK_ACCESS_FS_MAKE_SYM} << 1U) - 1U;  // all of the first version
    rules.handled_access_fs |= abi >= 2 ? std::uint64_t{LANDLOCK_ACCESS_FS_REFER} : 0U;
    rules.handled_access_fs |= abi >= 3 ? kLandlockTruncate : 0U;
    const Descriptor ruleset(
        static_cast<int>(::syscall(SYS_landlock_create_ruleset, &rules, sizeof(rules), 0)));
    if (!ruleset) {
        return cannot("make Landlock rules");
    }
    if (folder >= 0) {
        landlock_path_beneath_attr beneath{};
        beneath.allowed_access = LANDLOCK_ACCESS_FS_READ_FILE;
        beneath.parent_fd = folder;
        if (::syscall(SYS_landlock_add_rule, ruleset.get(), LANDLOCK_RULE_PATH_BENEATH, &beneath, 0) != 0) {
            return cannot("allow its folder by Landlock");
        }
    }
    if (::syscall(SYS_landlock_restrict_self, ruleset.get(), 0) != 0) {
        return cannot("enter Landlock");
    }
    return {};
}

}  // namespace

Result<void> enterSandbox(const SandboxLimits& limits, int folder, int result) {
    if (::prctl(PR_SET_PDEATHSIG, SIGKILL) != 0) {
        return cannot("ask to end with its parent");
    }
#ifndef __SANITIZE_ADDRESS__  // the address sanitizer's shadow takes terabytes of address space
    const std::uint64_t taken = addressSpace();
    if (taken == 0 || !lowerLimit(RLIMIT_AS, taken + limits.memory, taken + limits.memory)) {
        return cannot("limit its memory");
    }
#endif
    // SIGXCPU first; SIGKILL a second later, should that be caught.
    if (!lowerLimit(RLIMIT_CPU, limits.seconds, std::uint64_t{limits.seconds} + 1U) ||
        !lowerLimit(RLIMIT_STACK, kSandboxStack, kSandboxStack) || !lowerLimit(RLIMIT_CORE, 0, 0) ||
        !lowerLimit(RLIMIT_FSIZE, 0, 0)) {
        return cannot("limit itself");
    }
    if (::prctl(PR_SET_NO_NEW_PRIVS, 1, 0, 0, 0) != 0 || ::prctl(PR_SET_DUMPABLE, 0) != 0) {
        return cannot("give up privileges");
    }
    RELIEF_TRY(enterLandlock(folder));
    return enterSeccomp(folder, result);
}

}  // namespace relief

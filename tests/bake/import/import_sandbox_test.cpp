// What the kernel lets a process do once it is in the sandbox: asked in a child, by system calls of its own.
#include "bake/import/import_sandbox.h"

#include <fcntl.h>
#include <gtest/gtest.h>
#include <linux/landlock.h>
#include <linux/openat2.h>
#include <sys/mman.h>
#include <sys/prctl.h>
#include <sys/resource.h>
#include <sys/syscall.h>
#include <sys/wait.h>
#include <unistd.h>

#include <csignal>
#include <functional>

#include "tests/bake/meshes.h"

namespace relief::test {
namespace {

constexpr std::uint64_t kMemory = std::uint64_t{256} << 20;

int folder_file = -1;  // of the child

/// \return the exit code of a child that enters the sandbox and then asks; -1 if a signal ended it.
int inSandbox(const std::filesystem::path& folder, const std::function<bool()>& ask) {
    const pid_t child = ::fork();
    if (child == 0) {
        folder_file = ::open(folder.c_str(), O_PATH | O_DIRECTORY | O_CLOEXEC);
        if (!enterSandbox({kMemory, 5}, folder_file, -1)) {
            ::_exit(2);
        }
        ::_exit(ask() ? 0 : 1);
    }
    int status = 0;
    ::waitpid(child, &status, 0);
    return WIFEXITED(status) ? WEXITSTATUS(status) : -1;
}

/// By the one call that seccomp leaves, so that Landlock judges.
bool opens(const std::filesystem::path& path, int flags) {
    open_how how{};
    how.flags = static_cast<std::uint64_t>(flags);
    how.mode = (flags & O_CREAT) != 0 ? 0600 : 0;
    return ::syscall(SYS_openat2, folder_file, path.c_str(), &how, sizeof(how)) >= 0;
}

TEST(ImportSandbox, OnlyFilesBelowTheFolderAndOnlyForReading) {
    const TemporaryFolder folder;
    std::filesystem::create_directory(folder.path() / "in");
    const std::filesystem::path inside = folder.write("in/inside", "1");
    const std::filesystem::path outside = folder.write("outside", "1");
    const std::filesystem::path in = folder.path() / "in";
    EXPECT_EQ(inSandbox(in, [&] { return opens(inside, O_RDONLY); }), 0);
    const bool landlock =
        ::syscall(SYS_landlock_create_ruleset, nullptr, 0, LANDLOCK_CREATE_RULESET_VERSION) >= 1;
    RecordProperty("landlock", landlock ? "yes" : "no");
    if (landlock) {  // where the kernel has none, ImportFiles alone keeps to the folder
        EXPECT_EQ(inSandbox(in, [&] { return opens(outside, O_RDONLY); }), 1);
        EXPECT_EQ(inSandbox(in, [&] { return opens("/etc/passwd", O_RDONLY); }), 1);
        EXPECT_EQ(inSandbox(in, [&] { return opens(inside, O_WRONLY); }), 1);
        EXPECT_EQ(inSandbox(in, [&] { return opens(in / "new", O_CREAT | O_WRONLY); }), 1);
        EXPECT_NE(inSandbox(in, [&] { return ::unlink(inside.c_str()) == 0; }), 0);
        EXPECT_NE(inSandbox(in, [&] { return ::execl("/bin/true", "true", nullptr) == 0; }), 0);
    }
    EXPECT_TRUE(std::filesystem::exists(inside));
}

TEST(ImportSandbox, LimitsAreTheKernels) {
    const TemporaryFolder folder;
    const auto hard = [](__rlimit_resource resource) {
        rlimit limit{};
        ::getrlimit(resource, &limit);
        return limit.rlim_max;
    };
    EXPECT_EQ(inSandbox(folder.path(), [&] { return hard(RLIMIT_CORE) == 0 && hard(RLIMIT_FSIZE) == 0; }), 0);
    EXPECT_EQ(inSandbox(folder.path(), [&] { return hard(RLIMIT_CPU) <= 6; }), 0);
    EXPECT_EQ(
        inSandbox(
            folder.path(),
            [] { return ::prctl(PR_GET_DUMPABLE) == 0 && ::prctl(PR_GET_NO_NEW_PRIVS, 0, 0, 0, 0) == 1; }),
        0);
    EXPECT_EQ(inSandbox(folder.path(),
                        [] {
                            int number = 0;
                            return ::prctl(PR_GET_PDEATHSIG, &number) == 0 && number == SIGKILL;
                        }),
              0);
#ifndef RELIEF_SANITIZED
    const auto maps = [](std::uint64_t size) {
        return ::mmap(nullptr, size, PROT_READ | PROT_WRITE, MAP_PRIVATE | MAP_ANONYMOUS, -1, 0) !=
               MAP_FAILED;
    };
    EXPECT_EQ(inSandbox(folder.path(), [&] { return maps(kMemory / 2); }), 0);
    EXPECT_EQ(inSandbox(folder.path(), [&] { return maps(kMemory + 4096); }), 1);
#endif
}

}  // namespace
}  // namespace relief::test

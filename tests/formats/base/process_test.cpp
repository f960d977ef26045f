// SPDX-License-Identifier: Apache-2.0
// Child processes: what they inherit, and how their exit is reported.
#include "formats/base/process.h"
#include "formats/base/descriptor.h"

#include <fcntl.h>
#include <gtest/gtest.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <csignal>
#include <string>

namespace relief {
namespace {

/// Runs a shell script.
/// \return its output.
std::string outputOf(const std::string& script, ProcessStart start = {}) {
    Descriptor reading;
    Descriptor writing;
    EXPECT_EQ(makePipe(reading, writing), 0);
    start.program = "sh";
    start.arguments = {"sh", "-c", script};
    start.files = {-1, writing.get(), -1};
    Process process;
    EXPECT_EQ(process.start(start), 0);
    EXPECT_TRUE(process.running());
    writing.reset();
    std::string text;
    char buffer[4096];
    for (ssize_t got = 0; (got = ::read(reading.get(), buffer, sizeof(buffer))) > 0;) {
        text.append(buffer, static_cast<std::size_t>(got));
    }
    const ProcessEnd end = process.wait();
    EXPECT_EQ(end.exit_code, 0);
    EXPECT_EQ(end.signal, 0);
    EXPECT_FALSE(process.running());
    return text;
}

int started(const std::string& program, Process& process) {
    ProcessStart start;
    start.program = program;
    start.arguments = {program, "-c", "exec sleep 100"};
    start.files = {-1, -1, -1};
    return process.start(start);
}

TEST(Process, InheritsOnlyItsDescriptors) {
    const Descriptor inheritable(::open("/dev/zero", O_RDONLY));
    ASSERT_TRUE(inheritable);
    EXPECT_EQ(outputOf("readlink /proc/$$/fd/0 /proc/$$/fd/2; ls /proc/$$/fd"),
              "/dev/null\n/dev/null\n0\n1\n2\n");
}

// Each descriptor's number is the target of another, so none may be overwritten before it is moved.
TEST(Process, DescriptorsMaySwap) {
    Process process;
    ProcessStart start;
    Descriptor reading;
    Descriptor writing;
    ASSERT_EQ(makePipe(reading, writing), 0);
    const Descriptor zero(::open("/dev/zero", O_RDONLY | O_CLOEXEC));
    start.program = "/bin/sh";
    start.arguments = {"sh", "-c", "readlink /proc/$$/fd/0 /proc/$$/fd/3 >&1"};
    start.files = {zero.get(), writing.get(), 1, 0};
    start.files.resize(static_cast<std::size_t>(zero.get()) + 1, writing.get());
    ASSERT_EQ(process.start(start), 0);
    writing.reset();
    std::string text(4096, '\0');
    text.resize(
        static_cast<std::size_t>(std::max<ssize_t>(0, ::read(reading.get(), text.data(), text.size()))));
    EXPECT_TRUE(text.starts_with("/dev/zero\n")) << text;
    EXPECT_EQ(process.wait().exit_code, 0);
}

TEST(Process, SignalsFollowTheOptions) {
    const auto lines = [](const ProcessStart& start) {
        // posix_spawn of glibc ignores its two internal signals, 32 and 33.
        return outputOf("grep -E 'Sig(Blk|Ign)' /proc/$$/status | cut -f2 | sed s/0000000180/0000000000/",
                        start);
    };
    for (const int number : {SIGHUP, SIGINT, SIGQUIT}) {
        std::signal(number, SIG_DFL);  // shells may ignore signals for background jobs
    }
    // SIGPIPE is 13 and SIGUSR1 10: bits 12 and 9.
    const auto pipe_before = std::signal(SIGPIPE, SIG_IGN);
    const auto user_before = std::signal(SIGUSR1, SIG_IGN);
    ProcessStart start;
    sigset_t old;
    sigset_t blocked;
    ::sigemptyset(&blocked);
    ::sigaddset(&blocked, SIGUSR2);
    ::sigprocmask(SIG_BLOCK, &blocked, &old);
    EXPECT_EQ(lines(start), "0000000000000000\n0000000000000200\n");
    start.reset_ignored_signals = true;
    start.blocked_signals = blocked;
    EXPECT_EQ(lines(start), "0000000000000800\n0000000000000000\n");
    ::sigprocmask(SIG_SETMASK, &old, nullptr);
    std::signal(SIGPIPE, pipe_before);
    std::signal(SIGUSR1, user_before);
}

TEST(Process, LeadsAGroup) {
    ProcessStart start;
    start.own_group = true;
    EXPECT_EQ(outputOf("test $(cut -d' ' -f5 /proc/$$/stat) = $$ && echo leads", start), "leads\n");
}

TEST(Process, UnrunnableProgramsAreErrors) {
    Process process;
    EXPECT_EQ(started("relief-no-such-program", process), ENOENT);
    EXPECT_EQ(started("/nonexistent/program", process), ENOENT);
    EXPECT_EQ(started("/etc/passwd", process), EACCES);
    EXPECT_FALSE(process.running());
}

TEST(Process, IsKilledWithItsOwner) {
    pid_t pid = 0;
    {
        Process process;
        ASSERT_EQ(started("sh", process), 0);
        pid = process.pid();
        EXPECT_EQ(::kill(pid, 0), 0);
    }
    EXPECT_EQ(::kill(pid, 0), -1);
    EXPECT_EQ(errno, ESRCH);
    Process process;
    ASSERT_EQ(started("sh", process), 0);
    process.kill(SIGTERM);
    EXPECT_EQ(process.wait().signal, SIGTERM);
}

}  // namespace
}  // namespace relief

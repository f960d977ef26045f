// SPDX-License-Identifier: Apache-2.0
#include <fcntl.h>
#include <gtest/gtest.h>
#include <sys/resource.h>
#include <sys/stat.h>
#include <sys/wait.h>
#include <unistd.h>
#include <algorithm>
#include <cerrno>
#include <csignal>
#include <filesystem>
#include <functional>
#include <set>
#include <string>
#include <thread>

#include "formats/base/descriptor.h"
#include "formats/base/file_io.h"
#include "formats/base/process.h"
#include "tests/formats/sample_colliders.h"
#include "tests/results.h"
#include "tests/temporary_folder.h"

namespace relief::test {
namespace {

namespace fs = std::filesystem;
using test::toBytes;

class FileIo : public testing::Test {
  protected:
    [[nodiscard]] fs::path in(const std::string& name) const { return folder_.path() / name; }

    [[nodiscard]] std::set<std::string> names() const {
        std::set<std::string> found;
        for (const fs::directory_entry& entry : fs::directory_iterator(folder_.path())) {
            found.insert(entry.path().filename());
        }
        return found;
    }

  private:
    test::TemporaryFolder folder_;
};

/// Runs f in a forked child, which protects the limits and descriptors of this process.
/// \return the child's exit code.
int inChild(const std::function<int()>& f) {
    const pid_t child = ::fork();
    if (child == 0) {
        ::_exit(f());
    }
    int status = 0;
    ::waitpid(child, &status, 0);
    return WIFEXITED(status) ? WEXITSTATUS(status) : -1;
}

/// kIo, with a one-line message that contains these words: the path, or the error of the system.
template <class T>
bool failsWith(const Result<T>& result, const std::string& words) {
    return !result && result.error().code == ErrorCode::kIo &&
           result.error().message.find(words) != std::string::npos &&
           result.error().message.find('\n') == std::string::npos;
}

mode_t modeOf(const fs::path& path) {
    struct stat status {};
    EXPECT_EQ(::lstat(path.c_str(), &status), 0);
    return status.st_mode & 07777;
}

std::vector<std::byte> pattern(std::size_t size) {
    std::vector<std::byte> bytes(size);
    for (std::size_t i = 0; i < size; ++i) {
        bytes[i] = static_cast<std::byte>(i * 131 + (i >> 13));
    }
    return bytes;
}

TEST_F(FileIo, RoundTripsFilesOfManySizes) {
    const std::size_t mib = std::size_t{1} << 20;
    for (const std::size_t size :
         {std::size_t{0}, std::size_t{1}, std::size_t{4096}, mib - 1, mib, mib + 1, 5 * mib}) {
        ASSERT_TRUE(writeFile(in("a"), pattern(size)));
        const auto read = required(readFile(in("a"), size));
        ASSERT_EQ(read, pattern(size));
    }
    EXPECT_EQ(names(), std::set<std::string>{"a"});
}

TEST_F(FileIo, ReplacesTheFile) {
    ASSERT_TRUE(writeFile(in("a"), toBytes("old")));
    // An open descriptor of the old file keeps its content: the file is replaced, never overwritten.
    const int old_file = ::open(in("a").c_str(), O_RDONLY);
    ASSERT_TRUE(writeFile(in("a"), toBytes("a newer one")));
    char buffer[16] = {};
    EXPECT_EQ(::read(old_file, buffer, sizeof(buffer)), 3);
    EXPECT_STREQ(buffer, "old");
    ::close(old_file);
    EXPECT_EQ(*readFile(in("a")), toBytes("a newer one"));
}

TEST_F(FileIo, RelativePathsStartAtTheWorkingFolder) {
    const int code = inChild([&] {
        return ::chdir(in("").c_str()) == 0 && writeFile("plain", toBytes("x")) &&
                       writeFile("./dot", toBytes("y"))
                   ? 0
                   : 1;
    });
    EXPECT_EQ(code, 0);
    EXPECT_EQ(names(), (std::set<std::string>{"plain", "dot"}));
}

TEST_F(FileIo, NewFilesFollowTheUmaskAndReplacedFilesKeepTheirMode) {
    const mode_t before = ::umask(027);
    ASSERT_TRUE(writeFile(in("new"), toBytes("x")));
    EXPECT_EQ(modeOf(in("new")), 0640U);
    for (const mode_t mode : {0600U, 0444U, 0755U, 0666U}) {
        ASSERT_EQ(::chmod(in("new").c_str(), mode), 0);
        ASSERT_TRUE(writeFile(in("new"), toBytes("y")));
        EXPECT_EQ(modeOf(in("new")), mode);
    }
    ::umask(before);
}

TEST_F(FileIo, SymbolicLinksStayAndTheirTargetsAreReplaced) {
    fs::create_directory(in("deep"));
    ASSERT_TRUE(writeFile(in("deep/target"), toBytes("old")));
    fs::create_symlink("deep/target", in("link"));
    fs::create_symlink("link", in("link-to-link"));
    fs::create_symlink(in("deep/target"), in("absolute"));
    for (const char* link : {"link", "link-to-link", "absolute"}) {
        ASSERT_TRUE(writeFile(in(link), toBytes(link)));
        EXPECT_TRUE(fs::is_symlink(in(link)));
        EXPECT_FALSE(fs::is_symlink(in("deep/target")));
        EXPECT_EQ(*readFile(in("deep/target")), toBytes(link));
    }
    fs::create_symlink("deep/not-yet", in("dangling"));
    ASSERT_TRUE(writeFile(in("dangling"), toBytes("born")));
    EXPECT_TRUE(fs::is_symlink(in("dangling")));
    EXPECT_EQ(*readFile(in("deep/not-yet")), toBytes("born"));

    fs::create_symlink("circle", in("circle"));
    EXPECT_TRUE(failsWith(writeFile(in("circle"), toBytes("x")), "circle"));
}

TEST_F(FileIo, FailedWritesKeepTheOldFileAndLeaveNoTemporaryFile) {
    ASSERT_TRUE(writeFile(in("a"), toBytes("old")));
    const int full = inChild([&] {
        std::signal(SIGXFSZ, SIG_IGN);
        const rlimit limit{100'000, 100'000};
        ::setrlimit(RLIMIT_FSIZE, &limit);
        return failsWith(writeFile(in("a"), pattern(300'000)), "free some space") ? 0 : 1;
    });
    EXPECT_EQ(full, 0);
    const int no_descriptor = inChild([&] {
        const rlimit limit{3, 3};
        ::setrlimit(RLIMIT_NOFILE, &limit);
        return failsWith(writeFile(in("a"), toBytes("new")), "/a'") && failsWith(readFile(in("a")), "/a'")
                   ? 0
                   : 1;
    });
    EXPECT_EQ(no_descriptor, 0);
    EXPECT_EQ(*readFile(in("a")), toBytes("old"));
    EXPECT_EQ(names(), std::set<std::string>{"a"});
}

TEST_F(FileIo, DescriptorsAreClosed) {
    const auto next = [] {
        const int fd = ::open("/dev/null", O_RDONLY);
        ::close(fd);
        return fd;
    };
    const int before = next();
    for (int i = 0; i < 20; ++i) {
        ASSERT_TRUE(writeFile(in("a"), toBytes("x")));
        ASSERT_TRUE(readFile(in("a")));
        ASSERT_FALSE(readFile(in("")));
        ASSERT_FALSE(writeFile("/dev/full", toBytes("x")));
        ASSERT_FALSE(readFile(in("a"), 0));
    }
    EXPECT_EQ(next(), before);
}

TEST_F(FileIo, RejectsFoldersAndInvalidPaths) {
    ASSERT_TRUE(writeFile(in("a"), toBytes("x")));
    fs::create_directory(in("folder"));
    const fs::path paths[] = {in("folder"),
                              in("folder/"),
                              in("missing/b"),
                              in("a/b"),
                              in("b/"),
                              "",
                              in(std::string(300, 'n')),
                              in(std::string("a\0b", 3))};
    for (const fs::path& path : paths) {
        EXPECT_TRUE(failsWith(writeFile(path, toBytes("x")), "cannot write '")) << path;
        const auto read = readFile(path);
        EXPECT_TRUE(failsWith(read, "cannot read '")) << path;
        EXPECT_EQ(read.error().message.find("are not created"), std::string::npos) << read.error().message;
    }
    EXPECT_TRUE(failsWith(writeFile(in("missing/b"), toBytes("x")), "folders are not created"));
    EXPECT_EQ(names(), (std::set<std::string>{"a", "folder"}));
    EXPECT_TRUE(fs::is_empty(in("folder")));
    EXPECT_TRUE(writeFile(in(std::string(255, 'n')), toBytes("x")))
        << "the longest name, without room for a suffix";
}

TEST_F(FileIo, DevicesAreWrittenInPlace) {
    EXPECT_TRUE(writeFile("/dev/null", toBytes("x")));
    EXPECT_TRUE(fs::is_character_file("/dev/null"));
    EXPECT_TRUE(failsWith(writeFile("/dev/full", toBytes("x")), "No space left on device"));
    EXPECT_TRUE(fs::is_character_file("/dev/full"));
}

TEST_F(FileIo, ShellPipesAreStreamed) {
    const std::vector<std::byte> bytes = pattern(3'000'001);
    int ends[2];
    ASSERT_EQ(::pipe(ends), 0);
    const std::string reading = "/dev/fd/" + std::to_string(ends[0]);
    EXPECT_FALSE(mayBlock(reading));
    std::thread writer([&] {
        EXPECT_TRUE(writeFile("/dev/fd/" + std::to_string(ends[1]), bytes));
        ::close(ends[1]);
    });
    const auto read = readFile(reading);
    writer.join();
    ::close(ends[0]);
    ASSERT_TRUE(read) << read.error().message;
    EXPECT_EQ(*read, bytes);
}

TEST_F(FileIo, NamedPipesDoNotBlock) {
    ASSERT_EQ(::mkfifo(in("pipe").c_str(), 0600), 0);
    fs::create_symlink("pipe", in("link"));
    for (const char* name : {"pipe", "link"}) {
        EXPECT_TRUE(mayBlock(in(name)));
        EXPECT_TRUE(failsWith(readFile(in(name)), name));
        EXPECT_TRUE(failsWith(writeFile(in(name), toBytes("x")), name));
    }
    EXPECT_TRUE(fs::is_fifo(in("pipe")));
    EXPECT_EQ(names(), (std::set<std::string>{"pipe", "link"}));
}

TEST_F(FileIo, StandardInputAndOutput) {
    ASSERT_TRUE(writeFile(in("in"), pattern(2'500'000)));
    const int code = inChild([&] {
        const int input = ::open(in("in").c_str(), O_RDONLY);
        const int output = ::open(in("out").c_str(), O_WRONLY | O_CREAT, 0600);
        ::dup2(input, STDIN_FILENO);
        ::dup2(output, STDOUT_FILENO);
        const auto bytes = readFile("-");
        return bytes && writeFile("-", *bytes) ? 0 : 1;
    });
    EXPECT_EQ(code, 0);
    EXPECT_EQ(*readFile(in("out")), pattern(2'500'000));
    EXPECT_EQ(names(), (std::set<std::string>{"in", "out"}));
    const int full = inChild([] {
        ::dup2(::open("/dev/full", O_WRONLY), STDOUT_FILENO);
        return failsWith(writeFile("-", toBytes("x")), "standard output") ? 0 : 1;
    });
    EXPECT_EQ(full, 0);
}

TEST_F(FileIo, LimitIsInclusiveForFilesAndStreams) {
    ASSERT_TRUE(writeFile(in("a"), pattern(1000)));
    EXPECT_TRUE(readFile(in("a"), 1000));
    expectError(readFile(in("a"), 999), ErrorCode::kLimit);
    // The length of a stream is known only at its end.
    for (const std::uint64_t limit : {std::uint64_t{1000}, std::uint64_t{999}}) {
        int ends[2];
        ASSERT_EQ(::pipe(ends), 0);
        EXPECT_TRUE(writeFile("/dev/fd/" + std::to_string(ends[1]), pattern(1000)));
        ::close(ends[1]);
        const auto streamed = readFile("/dev/fd/" + std::to_string(ends[0]), limit);
        ::close(ends[0]);
        EXPECT_EQ(streamed.has_value(), limit == 1000);
    }
    expectError(readFile("/dev/zero", 5'000'000), ErrorCode::kLimit);
    EXPECT_FALSE(readFile("/dev/zero", 0));
    EXPECT_TRUE(readFile("/dev/null", 0));
    EXPECT_GT(readFile("/proc/self/status").value().size(), 100U) << "a file that reports no size";
}

TEST_F(FileIo, ConcurrentWritersLeaveOneCompleteFile) {
    std::vector<std::thread> threads;
    for (int i = 0; i < 8; ++i) {
        threads.emplace_back([&, i] {
            for (int k = 0; k < 10; ++k) {
                EXPECT_TRUE(writeFile(in("a"), std::vector<std::byte>(20'000, static_cast<std::byte>(i))));
            }
        });
    }
    for (std::thread& thread : threads) {
        thread.join();
    }
    const auto read = readFile(in("a"));
    ASSERT_TRUE(read);
    EXPECT_EQ(*read, std::vector<std::byte>(20'000, read->front()));
    EXPECT_EQ(names(), std::set<std::string>{"a"});
}

TEST_F(FileIo, PreflightFindsUnwritableOutputsAndCreatesFolders) {
    ASSERT_TRUE(writeFile(in("old.relief"), toBytes("old")));
    const auto refused = [](const Result<void>& result) {
        return !result && result.error().code == ErrorCode::kIo;
    };
    for (const fs::path& path :
         {in("new.relief"), in("old.relief"), fs::path("-"), fs::path("/dev/null"), fs::path("plain_name")}) {
        EXPECT_TRUE(preflightFile(path, "-o")) << path;
    }
    for (const fs::path& path : {fs::path(), in(""), in("missing/out.relief"), in("old.relief/out.relief")}) {
        EXPECT_TRUE(refused(preflightFile(path, "-o"))) << path;
    }
    EXPECT_FALSE(fs::exists(in("new.relief"))) << "preflight creates no file";
    EXPECT_TRUE(preflightFolder(in("a/b"), "-o"));
    EXPECT_TRUE(fs::is_directory(in("a/b")));
    EXPECT_TRUE(preflightFolder(in("a"), "-o"));
    EXPECT_TRUE(refused(preflightFolder(in("old.relief"), "-o")));
    if (::geteuid() != 0) {  // root may write anywhere
        ASSERT_EQ(::chmod(in("").c_str(), 0500), 0);
        EXPECT_TRUE(refused(preflightFile(in("new.relief"), "-o")));
        ASSERT_EQ(::chmod(in("").c_str(), 0700), 0);
    }
}

TEST(QuotedPath, StaysOneLine) {
    EXPECT_EQ(quotedPath("a b/ä.relief"), "'a b/ä.relief'");
    EXPECT_EQ(quotedPath("a\nb\x1b[2J\x7f"), "'a\\x0ab\\x1b[2J\\x7f'");
    EXPECT_EQ(quotedPath("x\xe2\x80\xaejbo.relief"), "'x\\xe2\\x80\\xaejbo.relief'") << "U+202E";
    EXPECT_EQ(quotedPath("\xe2\x81\xa6\xc2\x9b\xff"), "'\\xe2\\x81\\xa6\\xc2\\x9b\\xff'")
        << "U+2066, U+009B, no UTF-8";
}

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
}  // namespace relief::test

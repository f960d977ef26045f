// SPDX-License-Identifier: Apache-2.0
#include "formats/base/temporary_file.h"

#include <gtest/gtest.h>
#include <sys/file.h>
#include <sys/stat.h>
#include <sys/wait.h>

#include <csignal>
#include <fstream>
#include <set>
#include <string>

#include "formats/base/file_io.h"
#include "tests/temporary_folder.h"

namespace relief {
namespace {

namespace fs = std::filesystem;

class TemporaryFiles : public ::testing::Test {
  protected:
    [[nodiscard]] std::set<std::string> names() const {
        std::set<std::string> found;
        for (const auto& entry : fs::directory_iterator(folder_)) {
            found.insert(entry.path().filename());
        }
        return found;
    }

    test::TemporaryFolder temporary_;
    fs::path folder_ = temporary_.path();
};

TEST_F(TemporaryFiles, AreRemovedUnlessRenamed) {
    {
        TemporaryFile file;
        ASSERT_EQ(file.create(folder_, 0600), 0);
        EXPECT_EQ(names().size(), 1U);
    }
    EXPECT_TRUE(names().empty());
    TemporaryFile file;
    ASSERT_EQ(file.create(folder_, 0600), 0);
    ASSERT_EQ(file.fill(std::as_bytes(std::span("whole", 5)), std::nullopt), 0);
    // The file is locked, so a process that cannot see this PID does not remove it as a leftover.
    const Descriptor other(openRetry((folder_ / *names().begin()).c_str(), O_RDWR));
    EXPECT_NE(::flock(other.get(), LOCK_EX | LOCK_NB), 0);
    ASSERT_EQ(file.renameTo(folder_ / "a"), 0);
    EXPECT_EQ(names(), std::set<std::string>{"a"});
}

TEST_F(TemporaryFiles, AreRemovedByFatalSignals) {
    for (const int number : {SIGINT, SIGTERM, SIGHUP, SIGQUIT}) {
        const auto work = [&] {
            ::signal(number, SIG_DFL);
            endCleanlyOnSignals();
            TemporaryFile file;
            if (file.create(folder_, 0600) == 0 &&
                fs::directory_iterator(folder_) != fs::directory_iterator()) {
                ::raise(number);
            }
            ::_exit(1);
        };
        EXPECT_EXIT(work(), testing::KilledBySignal(number), "");
        EXPECT_TRUE(names().empty()) << number;
    }
}

TEST_F(TemporaryFiles, LeftoversOfAKilledProcessAreRemovedByTheNextOutput) {
    const pid_t killed = ::fork();
    if (killed == 0) {
        TemporaryFile file;
        ::_exit(file.create(folder_, 0600) == 0 ? ::raise(SIGKILL) : 1);
    }
    int status = 0;
    ::waitpid(killed, &status, 0);
    ASSERT_TRUE(WIFSIGNALED(status));
    ASSERT_EQ(names().size(), 1U);
    ASSERT_TRUE(writeFile(folder_ / "a", {}));
    EXPECT_EQ(names(), std::set<std::string>{"a"});

    // All other files stay: those of live processes, files that are still locked, links, folders, pipes, and other
    // names.
    const std::string dead = ".relief-" + std::to_string(killed) + "-";
    const fs::path other = folder_ / "other";
    fs::create_directory(other);
    std::set<std::string> kept = {".relief-" + std::to_string(::getpid()) + "-0-01234567.tmp",
                                  ".relief-" + std::to_string(::getppid()) + "-0-01234567.tmp",
                                  dead + "0-0123456.tmp",
                                  dead + "0-012345678.tmp",
                                  dead + "0-0123456G.tmp",
                                  dead + "0-01234567.tmp~",
                                  dead + "-01234567.tmp",
                                  dead + "0x0-01234567.tmp",
                                  ".relief-0" + std::to_string(killed) + "-0-01234567.tmp",
                                  ".relief-0-0-01234567.tmp",
                                  ".relief--1-0-01234567.tmp",
                                  ".relief-99999999999999999999-0-01234567.tmp",
                                  "x" + dead + "0-01234567.tmp",
                                  dead + "9-01234567.tmp"};
    for (const std::string& name : kept) {
        std::ofstream(other / name) << "kept";
    }
    const Descriptor locked(openRetry((other / (dead + "9-01234567.tmp")).c_str(), O_RDWR));
    ASSERT_EQ(::flock(locked.get(), LOCK_EX), 0);
    std::ofstream(other / "target") << "kept";
    fs::create_symlink("target", other / (dead + "1-01234567.tmp"));
    fs::create_directory(other / (dead + "2-01234567.tmp"));
    ASSERT_EQ(::mkfifo((other / (dead + "3-01234567.tmp")).c_str(), 0600), 0);
    std::ofstream(other / (dead + "4-01234567.tmp")) << "gone";
    std::ofstream(other / (dead + "4000000000-89abcdef.tmp")) << "gone";
    ASSERT_TRUE(writeFile(other / "a", {}));
    kept.insert({"a", "target", dead + "1-01234567.tmp", dead + "2-01234567.tmp", dead + "3-01234567.tmp"});
    std::set<std::string> found;
    for (const auto& entry : fs::directory_iterator(other)) {
        found.insert(entry.path().filename());
    }
    EXPECT_EQ(found, kept);
    EXPECT_EQ(fs::file_size(other / "target"), 4U);
}

TEST_F(TemporaryFiles, IgnoredSignalsStayIgnored) {
    const auto work = [] {
        ::signal(SIGHUP, SIG_IGN);
        endCleanlyOnSignals();
        ::raise(SIGHUP);
        ::_exit(7);
    };
    EXPECT_EXIT(work(), testing::ExitedWithCode(7), "");
}

TEST_F(TemporaryFiles, DescriptorNamesAreWrittenToTheDescriptor) {
    const int fd = ::open((folder_ / "log").c_str(), O_WRONLY | O_CREAT | O_APPEND, 0600);
    ASSERT_GE(fd, 0);
    ASSERT_EQ(::write(fd, "first ", 6), 6);
    ASSERT_TRUE(writeFile("/dev/fd/" + std::to_string(fd), std::as_bytes(std::span("second", 6))));
    ::close(fd);
    std::string text;
    std::getline(std::ifstream(folder_ / "log"), text);
    EXPECT_EQ(text, "first second");
    EXPECT_EQ(names(), std::set<std::string>{"log"});
    EXPECT_FALSE(writeFile("/dev/fd/" + std::to_string(fd), std::as_bytes(std::span("x", 1))));
}

}  // namespace
}  // namespace relief

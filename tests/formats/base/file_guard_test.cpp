// SPDX-License-Identifier: Apache-2.0
// Temporary files; and an output of a run may be neither an input nor another output, under any path or link.
#include <gtest/gtest.h>
#include <sys/file.h>
#include <sys/stat.h>
#include <sys/wait.h>
#include <csignal>
#include <filesystem>
#include <fstream>
#include <set>
#include <string>

#include "formats/base/file_guard.h"
#include "formats/base/file_io.h"
#include "formats/base/temporary_file.h"
#include "tests/results.h"
#include "tests/temporary_folder.h"

namespace relief::test {
namespace {

namespace fs = std::filesystem;

class FileGuardTest : public testing::Test {
  protected:
    void SetUp() override {
        fs::create_directory(folder_ / "real");
        fs::create_directory_symlink("real", folder_ / "linked");
        for (const char* file : {"scene", "real/input", "real/old"}) {
            std::ofstream(folder_ / file) << file;
        }
        fs::create_symlink("scene", folder_ / "symbolic");
        fs::create_hard_link(folder_ / "scene", folder_ / "hard");
    }

    [[nodiscard]] fs::path in(const std::string& name) const {
        return name == "-" ? fs::path(name) : folder_ / name;
    }
    void reads(const std::string& name) { ASSERT_TRUE(guard_.reads(in(name))) << name; }
    void writes(const std::string& name, const char* option) {
        const auto done = guard_.writes(in(name), option);
        ASSERT_TRUE(done) << done.error().message;
    }
    static void expectUsage(const Result<void>& done, const std::string& name, const std::string& says) {
        ASSERT_FALSE(done) << name;
        EXPECT_EQ(done.error().code, ErrorCode::kUsage) << done.error().message;
        EXPECT_NE(done.error().message.find(says), std::string::npos) << done.error().message;
    }
    void refuses(const std::string& name, const std::string& says) {
        expectUsage(guard_.writes(in(name), "--new"), name, says);
    }
    Result<void> frames(const std::string& folder) {
        return guard_.writes(NumberedFiles{in(folder), "frame_", ".png", 3}, "--frames");
    }
    Result<void> containers(const std::string& folder) {
        return guard_.writes(FilesByEnding{in(folder), ".relief"}, "--world");
    }
    void refusesFrames(const std::string& folder, const std::string& says) {
        expectUsage(frames(folder), folder, says);
    }

    test::TemporaryFolder temporary_;
    fs::path folder_ = temporary_.path();
    FileGuard guard_;
};

TEST_F(FileGuardTest, NoOutputIsAnInput) {
    reads("scene");
    reads("real/input");
    reads("scene");
    refuses("scene", "scene' is the input; choose another place for --new");
    refuses("real/../scene", "is the input '");
    refuses("symbolic", "symbolic' is the input '");
    refuses("hard", "hard' is the input '");
    refuses("linked/input", "is the input '");
    writes("real/old", "--dump");
    writes("new", "--stats");
    EXPECT_FALSE(guard_.reads(in("linked/old"))) << "an input added late";
    EXPECT_TRUE(guard_.reads(""));
    EXPECT_TRUE(guard_.writes("", "--events"));
}

TEST_F(FileGuardTest, FilesMayLieInAFolderThatIsCreatedLater) {
    const fs::path made = in("new/sub");
    for (const char* file : {"new/sub/a", "new/b", "linked/../new/sub/c", "d"}) {
        const auto done = guard_.writes(in(file), "--new", made);
        EXPECT_TRUE(done) << done.error().message;
    }
    for (const char* file : {"new", "new/sub", "linked", "missing/a", "new/sub/deeper/a"}) {
        expectError(guard_.writes(in(file), "--new", made), ErrorCode::kIo);
    }
    EXPECT_FALSE(fs::exists(in("new")));
}

TEST_F(FileGuardTest, OutputsAreDistinct) {
    fs::create_symlink("real/later", folder_ / "dangling");
    fs::create_symlink("dangling", folder_ / "twice");
    writes("scene", "--dump");
    refuses("scene", "--dump and --new would both write");
    refuses("symbolic", "--dump and --new would both write");
    refuses("hard", "--dump and --new would both write");
    writes("dangling", "--stats");
    refuses("linked/later", "--stats and --new would both write");
    refuses("twice", "--stats and --new would both write");
    writes("real/fresh", "--events");
    refuses("linked/fresh", "--events and --new");
    fs::create_symlink("/dev/null", folder_ / "null");
    for (const char* device : {"/dev/null", "null", "null"}) {
        writes(device, "--plan");
    }
    fs::create_symlink("circle", folder_ / "circle");
    writes("circle", "-o");  // writing it fails
}

TEST_F(FileGuardTest, StandardOutputIsAnOutput) {
    writes("-", "--dump");
    refuses("-", "--dump and --new would both write standard output");
    EXPECT_FALSE(guard_.writes("/dev/stdout", "--stats"));
    EXPECT_FALSE(guard_.writes("/dev/fd/1", "--stats"));
    EXPECT_TRUE(guard_.reads("-"));
}

TEST_F(FileGuardTest, FramesReplaceOnlyFrames) {
    std::ofstream(folder_ / "real/frame_0001.png") << "old";
    std::ofstream(folder_ / "real/frame_0003.png") << "beyond the last";
    std::ofstream(folder_ / "real/frame_00001.png") << "another name";
    for (const char* name : {"frame_0003.png", "frame_00001.png"}) {
        reads(std::string("real/") + name);
    }
    EXPECT_TRUE(frames("real"));
    refuses("real/frame_0000.png", "--frames and --new would both write");
    refuses("linked/frame_0002.png", "--frames and --new would both write");
    refuses("linked/frame_0001.png", "--frames and --new would both write");
    writes("real/frame_0004.png", "--dump");
    EXPECT_FALSE(guard_.reads(in("real/frame_0001.png")));
    EXPECT_FALSE(guard_.reads(in("real/frame_0000.png")));
}

TEST_F(FileGuardTest, FramesReplaceNoInput) {
    reads("scene");
    for (const char* kind : {"symbolic", "hard"}) {
        fs::remove(folder_ / "real/frame_0000.png");
        if (kind[0] == 's') {
            fs::create_symlink("../scene", folder_ / "real/frame_0000.png");
        } else {
            fs::create_hard_link(folder_ / "scene", folder_ / "real/frame_0000.png");
        }
        refusesFrames("real", "frame_0000.png' is the input '");
    }
    fs::rename(folder_ / "real/old", folder_ / "real/frame_0000.png");
    reads("real/frame_0000.png");
    refusesFrames("linked", "linked/frame_0000.png' is the input");
}

TEST_F(FileGuardTest, FramesReplaceNoOtherOutput) {
    writes("made", "--dump");
    refusesFrames("made", "--dump and --frames would both write");
    refusesFrames("made/deeper", "--dump and --frames would both write");
    EXPECT_TRUE(frames("fresh"));
    refuses("fresh", "--frames and --new would both write");
}

TEST_F(FileGuardTest, FilesByEndingIncludeExistingAndFutureFiles) {
    std::ofstream(folder_ / "real/a.relief") << "container";
    fs::create_symlink("real/a.relief", folder_ / "to_container");
    fs::create_hard_link(folder_ / "real/a.relief", folder_ / "same_container");
    fs::create_symlink("old", folder_ / "real/b.relief");
    ASSERT_TRUE(containers("linked/"));
    refuses("real/a.relief", "--world and --new would both write '");
    refuses("to_container", "to_container', which is '");
    refuses("to_container", "linked/a.relief'; choose another place for one of them");
    refuses("same_container", "same_container', which is '");
    refuses("real/later.relief", "--world and --new");
    refuses("real/old", "--world and --new");
    EXPECT_FALSE(guard_.reads(in("real/a.relief")));
    writes("real/deps.d", "--depfile");
    writes("real2.relief", "-o");
    EXPECT_TRUE(containers("missing"));
    refuses("missing", "--world and --new");
}

TEST_F(FileGuardTest, FilesByEndingReplaceNoOtherOutput) {
    writes("real/x.relief", "-o");
    expectUsage(containers("linked"), "real", "-o and --world would both write '");
    fs::create_directory(folder_ / "one");
    fs::create_directory(folder_ / "two");
    std::ofstream(folder_ / "one/a.relief") << "container";
    fs::create_hard_link(folder_ / "one/a.relief", folder_ / "two/a.relief");
    EXPECT_TRUE(containers("one"));
    EXPECT_TRUE(containers("two")) << "replacing one name does not change the other";
    fs::create_directory(folder_ / "three");
    fs::create_symlink("../one/a.relief", folder_ / "three/a.relief");
    EXPECT_FALSE(containers("three"));
}

TEST_F(FileGuardTest, LinksOutOfAnOutputFolderAreRejected) {
    fs::create_directory(folder_ / "out");
    for (const char* target : {"../real/old", "../real/later"}) {
        for (const char* name : {"a.relief", "frame_0001.png", "world.json"}) {
            fs::create_symlink(target, folder_ / "out" / name);
        }
        const std::string says = " is a link that leads out of its folder; remove it";
        expectUsage(containers("out"), "out", "out/a.relief' of --world" + says);
        refusesFrames("out", "out/frame_0001.png' of --frames" + says);
        expectUsage(FileGuard().writes(in("out/world.json"), "--world", in("out")), "out",
                    "out/world.json' of --world" + says);
        writes("out/world.json", "-o");  // names the link itself
        guard_ = FileGuard();
        for (const char* name : {"a.relief", "frame_0001.png", "world.json"}) {
            fs::remove(folder_ / "out" / name);
            fs::create_symlink("stays", folder_ / "out" / name);
        }
        EXPECT_TRUE(FileGuard().writes(FilesByEnding{in("out"), ".relief"}, "--world"));
        EXPECT_TRUE(FileGuard().writes(in("out/world.json"), "--world", in("out")));
        for (const char* name : {"a.relief", "frame_0001.png", "world.json"}) {
            fs::remove(folder_ / "out" / name);
        }
    }
}

TEST_F(FileGuardTest, KeptFilesAreSharedAndReplaceLinks) {
    fs::create_symlink("scene", folder_ / "cache");
    reads("scene");
    EXPECT_TRUE(guard_.keeps(in("cache"), "--world")) << "replaces the link, not the scene";
    EXPECT_TRUE(guard_.keeps(in("cache"), "--output")) << "two worlds may share a cache";
    refuses("cache", "--world and --new would both write '");
    EXPECT_FALSE(guard_.reads(in("cache")));
    expectUsage(guard_.keeps(in("scene"), "--world"), "scene", "is the input");
}

TEST_F(FileGuardTest, CreatedFoldersThatStayEmptyAreRemoved) {
    fs::create_directory(folder_ / "empty");
    const auto make = [&](bool keep) {
        FileGuard guard;
        for (const char* name : {"a/b/", "a/c", "d/e", "empty/f", "empty"}) {
            EXPECT_TRUE(guard.makes(in(name), "--new")) << name;
            EXPECT_TRUE(fs::is_directory(in(name))) << name;
        }
        std::ofstream(folder_ / "a/c/file") << "x";
        if (keep) {
            guard.keepFolders();
        }
        const FileGuard copy = guard;
    };
    make(false);
    EXPECT_TRUE(fs::exists(in("a/c/file")) && fs::exists(in("empty")));
    EXPECT_FALSE(fs::exists(in("a/b")) || fs::exists(in("d")) || fs::exists(in("empty/f")));
    make(true);
    EXPECT_TRUE(fs::exists(in("a/b")) && fs::exists(in("d/e")) && fs::exists(in("empty/f")));
    for (const char* name : {"scene", "scene/a", "real/input/b"}) {
        expectError(guard_.makes(in(name), "--new"), ErrorCode::kIo, "cannot create the folder '");
    }
}

TEST_F(FileGuardTest, NumbersHaveAtLeastFourDigits) {
    const NumberedFiles files{"f", "p_", ".ply", 20'000};
    EXPECT_EQ(files.path(7), "f/p_0007.ply");
    EXPECT_EQ(files.path(12'345), "f/p_12345.ply");
    for (const char* name : {"p_0000.ply", "p_9999.ply", "p_19999.ply"}) {
        EXPECT_TRUE(files.hold(name)) << name;
    }
    for (const char* name :
         {"p_20000.ply", "p_00001.ply", "p_7.ply", "p_.ply", "p_-001.ply", "q_0001.ply", "p_0001.png"}) {
        EXPECT_FALSE(files.hold(name)) << name;
    }
}

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
}  // namespace relief::test

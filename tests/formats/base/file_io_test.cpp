#include "formats/base/file_io.h"

#include <fcntl.h>
#include <gtest/gtest.h>
#include <sys/resource.h>
#include <sys/stat.h>
#include <sys/wait.h>
#include <unistd.h>

#include <csignal>
#include <cstdlib>
#include <filesystem>
#include <functional>
#include <set>
#include <string>
#include <thread>

#include "tests/formats/sample_colliders.h"

namespace relief {
namespace {

namespace fs = std::filesystem;
using test::toBytes;

/// A folder of its own for every test.
class FileIo : public testing::Test {
  protected:
    void SetUp() override {
        std::string name = testing::TempDir() + "/relief-file-io-XXXXXX";
        ASSERT_NE(::mkdtemp(name.data()), nullptr);
        folder_ = name;
    }
    void TearDown() override { fs::remove_all(folder_); }

    [[nodiscard]] fs::path in(const std::string& name) const { return folder_ / name; }

    [[nodiscard]] std::set<std::string> names() const {
        std::set<std::string> found;
        for (const fs::directory_entry& entry : fs::directory_iterator(folder_)) {
            found.insert(entry.path().filename());
        }
        return found;
    }

  private:
    fs::path folder_;
};

/// Runs f in a forked child, so that limits and descriptors of this process stay as they are.
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

bool says(const Error& error, const std::string& words) {
    if (error.message.find(words) != std::string::npos && error.message.find('\n') == std::string::npos) {
        return true;
    }
    std::fprintf(stderr, "message: %s\n", error.message.c_str());
    return false;
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

TEST_F(FileIo, RoundTripOfAllKindsOfSizes) {
    const std::size_t mib = std::size_t{1} << 20;
    for (const std::size_t size :
         {std::size_t{0}, std::size_t{1}, std::size_t{4096}, mib - 1, mib, mib + 1, 5 * mib}) {
        ASSERT_TRUE(writeFile(in("a"), pattern(size)));
        const auto read = readFile(in("a"), size);
        ASSERT_TRUE(read) << read.error().message;
        ASSERT_EQ(*read, pattern(size));
    }
    EXPECT_EQ(names(), std::set<std::string>{"a"});
}

TEST_F(FileIo, ReplacesTheFileByAnotherOne) {
    ASSERT_TRUE(writeFile(in("a"), toBytes("old")));
    // Whoever has the older file open keeps it whole: it is replaced, never overwritten.
    const int old_file = ::open(in("a").c_str(), O_RDONLY);
    ASSERT_TRUE(writeFile(in("a"), toBytes("a newer one")));
    char buffer[16] = {};
    EXPECT_EQ(::read(old_file, buffer, sizeof(buffer)), 3);
    EXPECT_STREQ(buffer, "old");
    ::close(old_file);
    EXPECT_EQ(*readFile(in("a")), toBytes("a newer one"));
}

TEST_F(FileIo, RelativePathsWriteIntoTheWorkingFolder) {
    const int code = inChild([&] {
        return ::chdir(in("").c_str()) == 0 && writeFile("plain", toBytes("x")) &&
                       writeFile("./dot", toBytes("y"))
                   ? 0
                   : 1;
    });
    EXPECT_EQ(code, 0);
    EXPECT_EQ(names(), (std::set<std::string>{"plain", "dot"}));
}

TEST_F(FileIo, NewFilesFollowTheUmaskAndOldOnesKeepTheirBits) {
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

TEST_F(FileIo, ASymbolicLinkStaysAndItsTargetIsReplaced) {
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
    const Result<void> circle = writeFile(in("circle"), toBytes("x"));
    ASSERT_FALSE(circle);
    EXPECT_TRUE(says(circle.error(), "Too many levels of symbolic links"));
}

TEST_F(FileIo, AFullDiskLeavesTheOlderFileAndNoTemporaryOne) {
    ASSERT_TRUE(writeFile(in("a"), toBytes("old")));
    const int code = inChild([&] {
        std::signal(SIGXFSZ, SIG_IGN);
        const rlimit limit{100'000, 100'000};
        ::setrlimit(RLIMIT_FSIZE, &limit);
        const Result<void> result = writeFile(in("a"), pattern(300'000));
        if (result) {
            return 1;
        }
        return result.error().code == ErrorCode::kIo && says(result.error(), "File too large") &&
                       says(result.error(), "/a'") && says(result.error(), "free some space")
                   ? 0
                   : 2;
    });
    EXPECT_EQ(code, 0);
    EXPECT_EQ(*readFile(in("a")), toBytes("old"));
    EXPECT_EQ(names(), std::set<std::string>{"a"});
}

TEST_F(FileIo, NoDescriptorLeftIsAnErrorAndLeavesTheOlderFile) {
    ASSERT_TRUE(writeFile(in("a"), toBytes("old")));
    const int code = inChild([&] {
        const rlimit limit{3, 3};
        ::setrlimit(RLIMIT_NOFILE, &limit);
        const Result<void> written = writeFile(in("a"), toBytes("new"));
        const auto read = readFile(in("a"));
        return !written && says(written.error(), "Too many open files") && !read &&
                       says(read.error(), "Too many open files")
                   ? 0
                   : 1;
    });
    EXPECT_EQ(code, 0);
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

TEST_F(FileIo, RefusesFoldersByName) {
    fs::create_directory(in("folder"));
    const Result<void> written = writeFile(in("folder"), toBytes("x"));
    ASSERT_FALSE(written);
    EXPECT_EQ(written.error().code, ErrorCode::kIo);
    EXPECT_TRUE(says(written.error(), "Is a directory"));
    EXPECT_TRUE(says(written.error(), "folder'"));
    EXPECT_FALSE(writeFile(in("folder/"), toBytes("x")));
    const auto read = readFile(in("folder"));
    ASSERT_FALSE(read);
    EXPECT_EQ(read.error().code, ErrorCode::kIo);
    EXPECT_TRUE(says(read.error(), "Is a directory"));
    EXPECT_EQ(names(), std::set<std::string>{"folder"});
    EXPECT_TRUE(fs::is_empty(in("folder")));
}

TEST_F(FileIo, RefusesPathsThatLeadNowhere) {
    ASSERT_TRUE(writeFile(in("a"), toBytes("x")));
    const fs::path paths[] = {in("missing/b"),           in("a/b"), in("b/"), "", in(std::string(300, 'n')),
                              in(std::string("a\0b", 3))};
    for (const fs::path& path : paths) {
        const Result<void> written = writeFile(path, toBytes("x"));
        ASSERT_FALSE(written) << path;
        EXPECT_EQ(written.error().code, ErrorCode::kIo);
        EXPECT_TRUE(says(written.error(), "cannot write '"));
        const auto read = readFile(path);
        ASSERT_FALSE(read) << path;
        EXPECT_EQ(read.error().code, ErrorCode::kIo);
        EXPECT_TRUE(says(read.error(), "cannot read '"));
    }
    EXPECT_EQ(names(), std::set<std::string>{"a"});
}

TEST_F(FileIo, LongNamesNeedNoLongerOnes) {
    const std::string name(255, 'n');  // the longest that Linux takes: a suffix would not fit
    ASSERT_TRUE(writeFile(in(name), toBytes("x")));
    EXPECT_EQ(names(), std::set<std::string>{name});
}

TEST_F(FileIo, DevicesAreWrittenInPlace) {
    EXPECT_TRUE(writeFile("/dev/null", toBytes("x")));
    EXPECT_TRUE(fs::is_character_file("/dev/null"));
    const Result<void> full = writeFile("/dev/full", toBytes("x"));
    ASSERT_FALSE(full);
    EXPECT_TRUE(says(full.error(), "No space left on device"));
    EXPECT_TRUE(fs::is_character_file("/dev/full"));
}

TEST_F(FileIo, PipesOfTheShellAreStreamed) {
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

TEST_F(FileIo, NobodyWaitsForAPipeThatHasAName) {
    ASSERT_EQ(::mkfifo(in("pipe").c_str(), 0600), 0);
    fs::create_symlink("pipe", in("link"));
    for (const char* name : {"pipe", "link"}) {
        EXPECT_TRUE(mayBlock(in(name)));
        const auto read = readFile(in(name));
        ASSERT_FALSE(read);
        EXPECT_EQ(read.error().code, ErrorCode::kIo);
        EXPECT_TRUE(says(read.error(), "it is a pipe"));
        const Result<void> written = writeFile(in(name), toBytes("x"));
        ASSERT_FALSE(written);
        EXPECT_TRUE(says(written.error(), "it is a pipe"));
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
        const Result<void> result = writeFile("-", toBytes("x"));
        return !result && says(result.error(), "standard output: No space left on device") ? 0 : 1;
    });
    EXPECT_EQ(full, 0);
}

TEST_F(FileIo, TheLimitIsInclusiveForFilesAndStreams) {
    ASSERT_TRUE(writeFile(in("a"), pattern(1000)));
    EXPECT_TRUE(readFile(in("a"), 1000));
    const auto beyond = readFile(in("a"), 999);
    ASSERT_FALSE(beyond);
    EXPECT_EQ(beyond.error().code, ErrorCode::kLimit);
    EXPECT_TRUE(says(beyond.error(), "1000 bytes"));
    // A stream tells its length only by ending.
    for (const std::uint64_t limit : {std::uint64_t{1000}, std::uint64_t{999}}) {
        int ends[2];
        ASSERT_EQ(::pipe(ends), 0);
        EXPECT_TRUE(writeFile("/dev/fd/" + std::to_string(ends[1]), pattern(1000)));
        ::close(ends[1]);
        const auto streamed = readFile("/dev/fd/" + std::to_string(ends[0]), limit);
        ::close(ends[0]);
        EXPECT_EQ(streamed.has_value(), limit == 1000);
    }
    const auto endless = readFile("/dev/zero", 5'000'000);
    ASSERT_FALSE(endless);
    EXPECT_EQ(endless.error().code, ErrorCode::kLimit);
    EXPECT_FALSE(readFile("/dev/zero", 0));
    EXPECT_TRUE(readFile("/dev/null", 0));
}

TEST_F(FileIo, FilesThatDoNotTellTheirSizeAreReadToTheEnd) {
    const auto read = readFile("/proc/self/status");
    ASSERT_TRUE(read);
    EXPECT_GT(read->size(), 100U);
}

TEST_F(FileIo, WritersAtOnceLeaveOneWholeFile) {
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

TEST(QuotedPath, StaysOneLine) {
    EXPECT_EQ(quotedPath("a b/ä.relief"), "'a b/ä.relief'");
    EXPECT_EQ(quotedPath("a\nb\x1b[2J\x7f"), "'a\\x0ab\\x1b[2J\\x7f'");
}

}  // namespace
}  // namespace relief

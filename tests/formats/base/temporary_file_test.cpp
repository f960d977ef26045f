// SPDX-License-Identifier: Apache-2.0
#include "formats/base/temporary_file.h"

#include <gtest/gtest.h>

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

TEST_F(TemporaryFiles, AreRemovedUnlessTheyAreRenamed) {
    {
        TemporaryFile file;
        ASSERT_EQ(file.create(folder_, 0600), 0);
        EXPECT_EQ(names().size(), 1U);
    }
    EXPECT_TRUE(names().empty());
    TemporaryFile file;
    ASSERT_EQ(file.create(folder_, 0600), 0);
    ASSERT_EQ(file.fill(std::as_bytes(std::span("whole", 5)), std::nullopt), 0);
    ASSERT_EQ(file.renameTo(folder_ / "a"), 0);
    EXPECT_EQ(names(), std::set<std::string>{"a"});
}

TEST_F(TemporaryFiles, ASignalThatEndsTheProgramRemovesThem) {
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

TEST_F(TemporaryFiles, AnIgnoredSignalStaysIgnored) {
    const auto work = [] {
        ::signal(SIGHUP, SIG_IGN);
        endCleanlyOnSignals();
        ::raise(SIGHUP);
        ::_exit(7);
    };
    EXPECT_EXIT(work(), testing::ExitedWithCode(7), "");
}

TEST_F(TemporaryFiles, ADescriptorsNameIsWrittenToTheDescriptor) {
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

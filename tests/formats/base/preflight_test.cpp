// Whether an output can be written shows before the work.
#include "formats/base/file_io.h"

#include <gtest/gtest.h>
#include <sys/stat.h>
#include <unistd.h>

#include <cstdlib>
#include <filesystem>
#include <fstream>

namespace relief {
namespace {

namespace fs = std::filesystem;

class Preflight : public testing::Test {
  protected:
    void SetUp() override {
        std::string name = testing::TempDir() + "/relief-preflight-XXXXXX";
        ASSERT_NE(::mkdtemp(name.data()), nullptr);
        folder_ = name;
        std::ofstream(folder_ / "old.relief") << "old";
    }
    void TearDown() override { fs::remove_all(folder_); }

    fs::path folder_;
};

int codeOf(const Result<void>& result) {
    return result ? 0 : static_cast<int>(result.error().code);
}

TEST_F(Preflight, FindsOutputsThatCannotBeWritten) {
    EXPECT_EQ(codeOf(preflightFile(folder_ / "new.relief", "-o")), 0);
    EXPECT_EQ(codeOf(preflightFile(folder_ / "old.relief", "-o")), 0);
    EXPECT_EQ(codeOf(preflightFile("-", "-o")), 0);
    EXPECT_EQ(codeOf(preflightFile("/dev/null", "-o")), 0);
    EXPECT_EQ(codeOf(preflightFile("plain_name", "-o")), 0);
    EXPECT_EQ(codeOf(preflightFile("", "-o")), 2);
    EXPECT_EQ(codeOf(preflightFile(folder_, "-o")), 2);
    EXPECT_EQ(codeOf(preflightFile(folder_ / "missing" / "out.relief", "-o")), 2);
    EXPECT_EQ(codeOf(preflightFile(folder_ / "old.relief" / "out.relief", "-o")), 2);
    EXPECT_FALSE(fs::exists(folder_ / "new.relief")) << "it only looks";
    if (::geteuid() != 0) {  // root may write anywhere
        ASSERT_EQ(::chmod(folder_.c_str(), 0500), 0);
        EXPECT_EQ(codeOf(preflightFile(folder_ / "new.relief", "-o")), 2);
        ASSERT_EQ(::chmod(folder_.c_str(), 0700), 0);
    }
}

TEST_F(Preflight, MakesFolders) {
    EXPECT_EQ(codeOf(preflightFolder(folder_ / "a" / "b", "-o")), 0);
    EXPECT_TRUE(fs::is_directory(folder_ / "a" / "b"));
    EXPECT_EQ(codeOf(preflightFolder(folder_ / "a", "-o")), 0);
    EXPECT_EQ(codeOf(preflightFolder(folder_ / "old.relief", "-o")), 2);
}

}  // namespace
}  // namespace relief

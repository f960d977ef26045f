// Response files: quoting as a shell has it, files within files, and nothing that has no end.
#include "bake/cli/response_file.h"

#include <gtest/gtest.h>
#include <stdlib.h>

#include <filesystem>
#include <fstream>

namespace relief::test {
namespace {

namespace fs = std::filesystem;
using Words = std::vector<std::string>;

TEST(ResponseFile, SplitsAsAShell) {
    const std::vector<std::pair<std::string, Words>> cases = {
        {"", {}},
        {" \t\r\n", {}},
        {"a b\nc\r\nd", {"a", "b", "c", "d"}},
        {"--map\ncube:size=8\n", {"--map", "cube:size=8"}},
        {"'a b'\"c d\"e", {"a bc de"}},
        {"'' \"\"", {"", ""}},
        {R"(a\ b \'c "d\"e\\" 'f\g')", {"a b", "'c", "d\"e\\", "f\\g"}},
        {"# all of it\na # the rest\nb#c '#d'", {"a", "b#c", "#d"}},
        {"a\\\nb", {"a\nb"}},
        {"\xc3\xa4", {"\xc3\xa4"}},
    };
    for (const auto& [text, wanted] : cases) {
        const Result<Words> words = responseWords(text, "r");
        ASSERT_TRUE(words) << text << words.error().message;
        EXPECT_EQ(*words, wanted) << text;
    }
}

TEST(ResponseFile, SaysWhatHasNoEnd) {
    for (const auto& [text, says] : std::vector<std::pair<std::string, const char*>>{
             {"a\n'b\nc\n", "r:2: the quote '"},
             {"\"", "r:1: the quote \""},
             {"a\nb\\", "r:2: a backslash"},
             {std::string("a\0b", 3), "r:1: a zero byte"},
         }) {
        const Result<Words> words = responseWords(text, "r");
        ASSERT_FALSE(words) << text;
        EXPECT_EQ(words.error().code, ErrorCode::kInvalidInput);
        EXPECT_EQ(words.error().message.find(says), 0U) << words.error().message;
    }
}

class ResponseFiles : public testing::Test {
  protected:
    void SetUp() override {
        std::string name = (fs::temp_directory_path() / "relief_response_XXXXXX").string();
        ASSERT_NE(::mkdtemp(name.data()), nullptr);
        folder_ = name;
    }
    void TearDown() override { fs::remove_all(folder_); }
    /// \return "@" and its path.
    [[nodiscard]] std::string put(const char* name, const std::string& text) const {
        std::ofstream(folder_ / name) << text;
        return "@" + (folder_ / name).string();
    }

    fs::path folder_;
    FileGuard files_;
};

TEST_F(ResponseFiles, AreNoOutputs) {
    const std::string inner = put("inner", "x");
    const std::string outer = put("outer", inner);
    ASSERT_TRUE(expandArguments({outer}, files_));
    for (const std::string& file : {inner, outer}) {
        EXPECT_FALSE(files_.writes(file.substr(1), "-o")) << file;
    }
}

TEST_F(ResponseFiles, StandWhereTheyAreNamed) {
    const std::string inner = put("inner", "2 3");
    const std::string outer = put("outer", "1 " + inner + " 4 @@5");
    EXPECT_EQ(*expandArguments({"bake", outer, "6", "@@7", "@", "a@b"}, files_),
              (Words{"bake", "1", "2", "3", "4", "@5", "6", "@7", "@", "a@b"}));
    EXPECT_EQ(*expandArguments({inner, "--", inner, "@@x"}, files_), (Words{"2", "3", "--", inner, "@@x"}));
}

TEST_F(ResponseFiles, EndSomewhere) {
    const std::string circle = put("circle", "@" + (folder_ / "circle").string());
    const auto deep = expandArguments({circle}, files_);
    ASSERT_FALSE(deep);
    EXPECT_EQ(deep.error().code, ErrorCode::kLimit);
    EXPECT_NE(deep.error().message.find("circle"), std::string::npos);
    // Small files that name the one before twice: 256 times 500 words.
    std::string words;
    for (int i = 0; i < 500; ++i) {
        words += "w ";
    }
    std::string last = put("0", words);
    for (int i = 1; i < 9; ++i) {
        last = put(std::to_string(i).c_str(), last + " " + last);
    }
    const auto many = expandArguments({last}, files_);
    ASSERT_FALSE(many);
    EXPECT_EQ(many.error().code, ErrorCode::kLimit);
    EXPECT_NE(many.error().message.find("100000"), std::string::npos) << many.error().message;
    const auto large = expandArguments({put("large", std::string(kResponseBytesMax + 1, ' '))}, files_);
    EXPECT_EQ(large.error().code, ErrorCode::kLimit);
    const auto gone = expandArguments({"@" + (folder_ / "gone").string()}, files_);
    EXPECT_EQ(gone.error().code, ErrorCode::kIo);
    EXPECT_NE(gone.error().message.find("gone"), std::string::npos);
}

}  // namespace
}  // namespace relief::test

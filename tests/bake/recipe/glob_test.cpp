// SPDX-License-Identifier: Apache-2.0
// File patterns: matches, mismatches, and bounded matching time.
#include "bake/recipe/glob.h"

#include <gtest/gtest.h>

#include <filesystem>

#include "tests/results.h"
#include "tests/temporary_folder.h"

namespace relief::test {
namespace {

namespace fs = std::filesystem;

bool matches(const std::string& pattern, const std::string& path) {
    const Result<GlobPattern> parsed = GlobPattern::parse(pattern);
    EXPECT_TRUE(parsed) << pattern << ": " << parsed.error().message;
    return parsed && parsed->matches(path);
}

/// \param pair  a pattern and a path, separated by a space
bool matchesPair(const std::string& pair) {
    const std::size_t space = pair.find(' ');
    return matches(pair.substr(0, space), pair.substr(space + 1));
}

TEST(Glob, MatchesPartByPart) {
    // Two stars match any number of folders.
    for (const std::string pair :
         {"a.obj a.obj", "./a.obj a.obj", "*.obj a.obj", ".*.obj .a.obj", "x/?.o*j x/a.obj",
          "[a-c].obj b.obj", "\\[a\\].obj [a].obj", "**/*.obj a.obj", "**/*.obj x/y/a.obj",
          "x/**/a.obj x/a.obj", "x/**/y/**/a.obj x/1/y/2/3/a.obj", "**/**/a.obj a.obj"}) {
        EXPECT_TRUE(matchesPair(pair)) << pair;
    }
    // One star does not cross folders. Names that start with a dot are hidden. Two stars within a part act as one.
    for (const std::string pair :
         {"a.obj b/a.obj", "a.obj A.obj", "*.obj x/a.obj", "*.obj .a.obj", "[!a-c].obj b.obj",
          "[a].obj [a].obj", "x/* x", "x x/y", "x/**/y/**/a.obj x/1/2/3/a.obj", "**/a.obj .git/a.obj",
          "x**/a.obj x/y/a.obj"}) {
        EXPECT_FALSE(matchesPair(pair)) << pair;
    }
}

// 64 times ** against 2,000 folders: backtracking would never end.
TEST(Glob, MatchingTimeIsBounded) {
    std::string pattern;
    std::string path;
    for (int i = 0; i < 31; ++i) {
        pattern += "**/a*a*a*a*/";
    }
    for (int i = 0; i < 2000; ++i) {
        path += "aaaaaaaaaaaa/";
    }
    EXPECT_FALSE(matches(pattern + "b", path + "c"));
    EXPECT_TRUE(matches(pattern + "b", path + "b"));
}

TEST(Glob, RejectsInvalidPatterns) {
    for (const auto& [text, says] :
         std::vector<std::pair<std::string, const char*>>{{"", "names no file"},
                                                          {"./", "names no file"},
                                                          {"x/**/", "ends with **"},
                                                          {"x/**", "ends with **"},
                                                          {"/x", "absolute"},
                                                          {"x/../y", "leaves the recipe's folder"},
                                                          {{"a\0b", 3}, "zero byte"}}) {
        expectError(GlobPattern::parse(text), ErrorCode::kInvalidInput, says);
    }
    std::string deep;
    for (int i = 0; i < 65; ++i) {
        deep += "a/";
    }
    EXPECT_EQ(GlobPattern::parse(deep + "b").error().code, ErrorCode::kLimit);
}

TEST(Glob, WalksFoldersOnceInOrder) {
    const TemporaryFolder temporary;
    const fs::path& folder = temporary.path();
    for (const char* file : {"b.obj", "a.obj", "x/a.obj", "x/y/a.obj", "x.obj/no", ".h/a.obj", "x-/a.obj"}) {
        fs::create_directories((folder / file).parent_path());
        temporary.write(file, "x");
    }
    fs::create_symlink("a.obj", folder / "link.obj");
    fs::create_symlink("gone.obj", folder / "dangling.obj");
    fs::create_symlink("..", folder / "x/up.d");  // a cycle if links are followed
    const GlobResult found = required(globFiles(folder, *GlobPattern::parse("**/*.obj")));
    EXPECT_EQ(found.files,
              (std::vector<std::string>{"a.obj", "b.obj", "link.obj", "x-/a.obj", "x/a.obj", "x/y/a.obj"}));
    EXPECT_EQ(found.folders, (std::vector<std::string>{"", "x", "x-", "x.obj", "x/y"}));
    EXPECT_EQ(required(globFiles(folder, *GlobPattern::parse("x/up.d/*.obj"))).files.size(), 3U)
        << "must follow a link that is named";
    const GlobResult folders = required(globFiles(folder, *GlobPattern::parse("**/x*/")));
    EXPECT_EQ(folders.files, (std::vector<std::string>{"x", "x-", "x.obj"})) << "with a trailing slash";
    EXPECT_TRUE(globFiles(folder, *GlobPattern::parse("a.obj/"))->files.empty());
    EXPECT_EQ(globFiles(folder / "gone", *GlobPattern::parse("*")).error().code, ErrorCode::kIo);
}

}  // namespace
}  // namespace relief::test

// SPDX-License-Identifier: Apache-2.0
// Words and lines of text files, for every line ending and layout.
#include "formats/base/text_scanner.h"

#include <gtest/gtest.h>

#include <string>
#include <vector>

namespace relief::test {
namespace {

using Words = std::vector<std::string>;

/// The words of each line.
std::vector<Words> linesOf(std::string_view text, TextRules rules = {'#', true}) {
    TextScanner scanner(text, rules);
    std::vector<Words> lines;
    do {
        lines.emplace_back();
        for (std::string_view word = scanner.word(); !word.empty(); word = scanner.word()) {
            lines.back().emplace_back(word);
        }
    } while (scanner.nextLine());
    return lines;
}

TEST(TextScanner, LinesEndInThreeWays) {
    const std::vector<Words> truth{{"a", "b"}, {}, {"c"}};
    for (const char* text : {"a b\n\nc", "a b\r\n\r\nc\r\n", "a b\r\rc\r", "\xef\xbb\xbf\ta\v b \n\r\n c\f\n",
                             "a b\n\r\nc\n\x1a"}) {
        EXPECT_EQ(linesOf(text), truth) << text;
    }
    EXPECT_EQ(linesOf(std::string("a b\n\nc\n") + std::string(9, '\0')), truth) << "padded with zeros";
    EXPECT_EQ(linesOf(""), std::vector<Words>{{}});
}

TEST(TextScanner, CommentsAndContinuedLinesFollowTheRules) {
    EXPECT_EQ(linesOf("a b#c d\n# e\n#"), (std::vector<Words>{{"a", "b"}, {}, {}}));
    EXPECT_EQ(linesOf("a \\\n b\\\r\nc\\d \\ \t\re\\"), (std::vector<Words>{{"a", "b", "c\\d", "e"}}));
    EXPECT_EQ(linesOf("a#b\\\nc", {}), (std::vector<Words>{{"a#b\\"}, {"c"}}));
    EXPECT_EQ(linesOf("a # b \\\nc"), (std::vector<Words>{{"a"}, {"c"}})) << "a comment is not continued";
}

TEST(TextScanner, NextLineSkipsTheRestOfALine) {
    TextScanner scanner("v 0 0 # C:\\tmp\\\nv 1 1 \\\n1\nlast", {'#', true});
    EXPECT_EQ(scanner.word(), "v");
    EXPECT_TRUE(scanner.nextLine());
    EXPECT_EQ(scanner.word(), "v");
    EXPECT_EQ(scanner.line(), 2U);
    EXPECT_TRUE(scanner.nextLine());
    EXPECT_EQ(scanner.word(), "last");
    EXPECT_EQ(scanner.line(), 4U);
}

TEST(TextScanner, WordsHaveTheirLineNumber) {
    TextScanner scanner("one \\\ntwo\r\n\rname # of it \nlast", {'#', true});
    EXPECT_EQ(scanner.word(), "one");
    EXPECT_EQ(scanner.line(), 1U);
    EXPECT_EQ(scanner.word(), "two");
    EXPECT_EQ(scanner.line(), 2U);
    EXPECT_TRUE(scanner.atLineEnd());
    EXPECT_EQ(scanner.word(), "");
    EXPECT_TRUE(scanner.nextLine());
    EXPECT_TRUE(scanner.nextLine());
    EXPECT_EQ(scanner.restOfLine(), "name # of it");
    EXPECT_EQ(scanner.line(), 4U);
    EXPECT_EQ(scanner.anyWord(), "last");
    EXPECT_EQ(scanner.line(), 5U);
    EXPECT_EQ(scanner.anyWord(), "");
    EXPECT_EQ(scanner.line(), 5U) << "line of the last word";
    EXPECT_FALSE(scanner.nextLine());
}

TEST(CsvReader, SkipsEmptyLines) {
    CsvReader reader("\xef\xbb\xbf# a comment\r\n\n a ,\tb,,\r\n  \nlast");
    ASSERT_TRUE(reader.next());
    EXPECT_EQ(reader.number(), 3U);
    EXPECT_EQ(reader.line(), "a ,\tb,,");
    ASSERT_EQ(reader.fields().size(), 4U);
    EXPECT_EQ(reader.fields()[1], "b");
    EXPECT_EQ(reader.fields()[3], "");
    ASSERT_TRUE(reader.next());
    EXPECT_EQ(reader.number(), 5U);
    EXPECT_EQ(reader.fields()[0], "last");
    EXPECT_FALSE(reader.next());
    EXPECT_FALSE(CsvReader("").next());
}

TEST(CsvReader, ReadsClassicMacLineEndings) {
    CsvReader reader("x,y\r1,2\r\r3,4\n5,6\r");
    for (const char* first : {"x", "1", "3", "5"}) {
        ASSERT_TRUE(reader.next());
        ASSERT_EQ(reader.fields().size(), 2U);
        EXPECT_EQ(reader.fields()[0], first);
    }
    EXPECT_EQ(reader.number(), 5U);
    EXPECT_FALSE(reader.next());
}

TEST(CsvReader, LinesWithMillionsOfFieldsAreTruncated) {
    const std::string commas(1 << 20, ',');
    CsvReader reader(commas);
    ASSERT_TRUE(reader.next());
    EXPECT_EQ(reader.fields().size(), CsvReader::kFieldsMax + 1);
}

}  // namespace
}  // namespace relief::test

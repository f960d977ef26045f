#include "formats/base/text_scanner.h"

#include <gtest/gtest.h>

#include <string>

namespace relief {
namespace {

TEST(CsvReader, PassesOverWhatHoldsNothing) {
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

TEST(CsvReader, LinesOfOldMacs) {
    CsvReader reader("x,y\r1,2\r\r3,4\n5,6\r");
    for (const char* first : {"x", "1", "3", "5"}) {
        ASSERT_TRUE(reader.next());
        ASSERT_EQ(reader.fields().size(), 2U);
        EXPECT_EQ(reader.fields()[0], first);
    }
    EXPECT_EQ(reader.number(), 5U);
    EXPECT_FALSE(reader.next());
}

TEST(CsvReader, ALineOfMillionsOfFieldsIsCutShort) {
    const std::string commas(1 << 20, ',');
    CsvReader reader(commas);
    ASSERT_TRUE(reader.next());
    EXPECT_EQ(reader.fields().size(), CsvReader::kFieldsMax + 1);
}

}  // namespace
}  // namespace relief

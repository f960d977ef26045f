// SPDX-License-Identifier: Apache-2.0
#include "formats/base/text.h"

#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <limits>

namespace relief {
namespace {

TEST(Numbers, ShortestTextReadsBackExactly) {
    EXPECT_EQ(shortest(0.1F), "0.1");
    EXPECT_EQ(shortest(-2.0F), "-2");
    EXPECT_EQ(shortest(glm::vec3(1, 0.5F, -3)), "1/0.5/-3");
    std::uint32_t state = 1;
    for (int i = 0; i < 2000; ++i) {
        state = state * 1664525U + 1013904223U;
        const float value = std::bit_cast<float>(state);
        if (std::isfinite(value)) {
            EXPECT_EQ(parseFloat(shortest(value)), value);
        }
    }
}

TEST(Numbers, ParsersRejectInvalidNumbers) {
    EXPECT_EQ(parseFloat("+1.5e2"), 150.0F);
    EXPECT_EQ(parseFloat("-.5"), -0.5F);
    for (const char* text :
         {"", "+", "-", "+-1", "1.0 ", " 1", "1,5", "0x10", "nan", "inf", "-infinity", "1e39", "1f"}) {
        EXPECT_FALSE(parseFloat(text)) << text;
    }
    EXPECT_EQ(parseUnsigned("007"), 7U);
    EXPECT_EQ(parseUnsigned("99999999999999999999"), std::numeric_limits<std::uint64_t>::max());
    for (const char* text : {"", "-1", "+1", "1.0", "1 ", "a"}) {
        EXPECT_FALSE(parseUnsigned(text)) << text;
    }
}

TEST(Numbers, TinyNumbersBecomeZero) {
    EXPECT_EQ(parseFloat("1e-40"), 1e-40F) << "a subnormal";
    for (const char* text : {"1e-320", "0.1e-320", "1e-99999999999999999999999", "12345e-400", "+7.5E-60"}) {
        EXPECT_EQ(parseFloat(text), 0.0F) << text;
        EXPECT_FALSE(std::signbit(*parseFloat(text))) << text;
    }
    EXPECT_TRUE(std::signbit(parseFloat("-1e-320").value_or(1.0F)));
    EXPECT_EQ(parseFloat("0." + std::string(500, '0') + "1"), 0.0F);
    EXPECT_EQ(parseFloat("0." + std::string(50, '0') + "1e51"), 1.0F);
    EXPECT_EQ(parseDouble("1e-320"), 1e-320);
    EXPECT_EQ(parseDouble("-4e-400"), 0.0);
    for (const std::string& large :
         {std::string("1e400"), "1" + std::string(500, '0') + "e-2", std::string("0.1e500")}) {
        EXPECT_FALSE(parseFloat(large)) << large;
        EXPECT_FALSE(parseDouble(large)) << large;
    }
    for (const char* text : {"1e-320x", "1e-320 ", "1e-", "e-320"}) {
        EXPECT_FALSE(parseFloat(text)) << text;
    }
}

TEST(Words, SuggestsSimilarWords) {
    constexpr std::array<std::string_view, 4> kKnown = {"resolution", "threads", "map", "json"};
    EXPECT_EQ(didYouMean("resolutoin", kKnown), "; did you mean 'resolution'?");
    EXPECT_EQ(didYouMean("thread", kKnown), "; did you mean 'threads'?");
    EXPECT_EQ(didYouMean("reso", kKnown), "; did you mean 'resolution'?");
    EXPECT_EQ(didYouMean("mpa", kKnown), "; did you mean 'map'?");
    EXPECT_EQ(didYouMean("banana", kKnown), "");
    EXPECT_EQ(didYouMean("", kKnown), "");
    EXPECT_EQ(didYouMean(std::string(100000, 'x'), kKnown), "");
}

TEST(Utf8, InvalidSequencesAreReplaced) {
    EXPECT_EQ(cleanUtf8("h\xc3\xa4se.obj"), "h\xc3\xa4se.obj");
    EXPECT_EQ(cleanUtf8("a\x1b\n\x7f\xc2\x85z"), "a\xef\xbf\xbd\xef\xbf\xbd\xef\xbf\xbd\xef\xbf\xbdz");
    for (const std::string bad : {"\xff", "\xc0", "\xed\xa0", "\xf5"}) {
        EXPECT_EQ(cleanUtf8(bad).substr(0, 3), "\xef\xbf\xbd") << bad;
    }
    EXPECT_EQ(cleanUtf8("a\xe2\x80\xae\xe2\x81\xa6z"), "a\xef\xbf\xbd\xef\xbf\xbdz")
        << "bidirectional controls";
    EXPECT_EQ(cleanUtf8("a\xe2\x80\xaf\xe2\x81\xa5z"), "a\xe2\x80\xaf\xe2\x81\xa5z");
    EXPECT_EQ(cleanUtf8("a\xe2\x80\xaez", 9, Bidi::kKeep), "a\xe2\x80\xaez");
    EXPECT_EQ(cleanUtf8("\xc3\xa4\xc3\xa4", 3), "\xc3\xa4") << "no partial characters";
}

TEST(Split, KeepsEmptyParts) {
    EXPECT_EQ(split("a,,b", ',').size(), 3U);
    EXPECT_EQ(split("", ',').size(), 1U);
    EXPECT_EQ(trimmed(" \t a b\r"), "a b");
    EXPECT_EQ(trimmed(" \r"), "");
}

TEST(Words, TakesLinesAndWords) {
    std::string_view text = "a b\r\n\n \tlast";
    EXPECT_EQ(takeLine(text), "a b");
    EXPECT_EQ(takeLine(text), "");
    EXPECT_EQ(takeWord(text), "last");
    EXPECT_EQ(takeWord(text), "");
    EXPECT_EQ(takeLine(text), "");
    EXPECT_EQ(lowerCase("\xc3\x84.OBJ-Z@[z"), "\xc3\x84.obj-z@[z");
    EXPECT_EQ(oneCleanLine(" a\nb\x1b \xff\t"), "a b  \xef\xbf\xbd");
    EXPECT_EQ(parseDouble("+1e300"), 1e300);
    EXPECT_EQ(parseDouble("-inf"), -std::numeric_limits<double>::infinity());
    for (const char* wrong : {"", "+", "+-1", " 1", "1x", "1e999"}) {
        EXPECT_FALSE(parseDouble(wrong)) << wrong;
    }
}

}  // namespace
}  // namespace relief

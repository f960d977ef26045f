// SPDX-License-Identifier: Apache-2.0
// Text, numbers and memory.
#include <gtest/gtest.h>
#include <sys/resource.h>
#include <unistd.h>
#include <array>
#include <bit>
#include <cmath>
#include <cstdint>
#include <cstring>
#include <fstream>
#include <functional>
#include <limits>
#include <memory>
#include <sstream>
#include <string>
#include <vector>

#include "formats/base/heap.h"
#include "formats/base/portable_math.h"
#include "formats/base/text.h"
#include "formats/base/text_scanner.h"

namespace relief::test {
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
    EXPECT_EQ(popLine(text), "a b");
    EXPECT_EQ(popLine(text), "");
    EXPECT_EQ(popWord(text), "last");
    EXPECT_EQ(popWord(text), "");
    EXPECT_EQ(popLine(text), "");
    EXPECT_EQ(lowerCase("\xc3\x84.OBJ-Z@[z"), "\xc3\x84.obj-z@[z");
    EXPECT_EQ(oneCleanLine(" a\nb\x1b \xff\t"), "a b  \xef\xbf\xbd");
    EXPECT_EQ(parseDouble("+1e300"), 1e300);
    EXPECT_EQ(parseDouble("-inf"), -std::numeric_limits<double>::infinity());
    for (const char* wrong : {"", "+", "+-1", " 1", "1x", "1e999"}) {
        EXPECT_FALSE(parseDouble(wrong)) << wrong;
    }
}

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

// Compares with libm in long double, and pins the exact bits, which must not depend on compiler or processor.

constexpr int kSamples = 20'000;

/// Values between low and high that are not multiples of a round number.
double sample(double low, double high, int i) {
    return low + (high - low) * ((i + 0.318309886183790672) / kSamples);
}

void expectNear(const std::function<double(double)>& ours,
                const std::function<long double(long double)>& truth, double low, double high,
                double relative, double absolute) {
    double worst = 0.0;
    double worst_at = low;
    for (int i = 0; i < kSamples; ++i) {
        const double x = sample(low, high, i);
        const long double expected = truth(x);
        const double error = static_cast<double>(std::abs(static_cast<long double>(ours(x)) - expected));
        const double share = error / (absolute + relative * static_cast<double>(std::abs(expected)));
        if (!(share <= worst)) {
            worst = share;
            worst_at = x;
        }
    }
    EXPECT_LE(worst, 1.0) << "at " << worst_at;
}

constexpr double kTwoUlp = 2.0 * std::numeric_limits<double>::epsilon();

TEST(PortableMath, KeepsItsErrorBounds) {
    const auto log = [](long double x) { return std::log(x); };
    const auto exp = [](long double x) { return std::exp(x); };
    const auto sin = [](long double x) { return std::sin(x); };
    const auto cos = [](long double x) { return std::cos(x); };
    const auto acos = [](long double x) { return std::acos(x); };
    expectNear(portable::log, log, 1e-9, 2.0, kTwoUlp, 1e-18);
    expectNear(portable::log, log, 0.5, 1e6, kTwoUlp, 1e-18);
    expectNear(portable::log, log, 1e-300, 1e300, kTwoUlp, 1e-18);
    expectNear(portable::exp, exp, -1.0, 1.0, kTwoUlp, 0.0);
    expectNear(portable::exp, exp, -700.0, 700.0, kTwoUlp, 0.0);
    for (const double reach : {1.0, 10.0, 1e5}) {
        expectNear(portable::sin, sin, -reach, reach, 0.0, 1e-15);
        expectNear(portable::cos, cos, -reach, reach, 0.0, 1e-15);
    }
    expectNear(portable::acos, acos, -1.0, 1.0, 0.0, 1e-15);
    for (const double y : {-3.0, -1e-9, 1e-300, 0.5, 1e9}) {
        expectNear([&](double x) { return portable::atan2(y, x); },
                   [&](long double x) { return std::atan2(static_cast<long double>(y), x); }, -2.0, 2.0, 0.0,
                   1e-15);
    }
    expectNear([](double x) { return portable::pow(x, 1.0 / 2.4); },
               [](long double x) { return std::pow(x, static_cast<long double>(1.0 / 2.4)); }, 0.0031308, 1.0,
               1e-13, 0.0);
}

TEST(PortableMath, EndsAndCorners) {
    EXPECT_EQ(portable::log(1.0), 0.0);
    EXPECT_EQ(portable::exp(0.0), 1.0);
    EXPECT_EQ(portable::exp(-1e6), 0.0);
    EXPECT_EQ(portable::exp(1e6), std::numeric_limits<double>::infinity());
    EXPECT_EQ(portable::sin(0.0), 0.0);
    EXPECT_EQ(portable::cos(0.0), 1.0);
    EXPECT_EQ(portable::acos(1.0), 0.0);
    EXPECT_EQ(portable::atan2(0.0, 0.0), 0.0);
    EXPECT_EQ(portable::atan2(0.0, -1.0), 0x1.921fb54442d18p+1);
    EXPECT_EQ(portable::atan2(-1.0, 0.0), -0x1.921fb54442d18p+0);
    EXPECT_TRUE(std::isnan(portable::sin(std::numeric_limits<double>::quiet_NaN())));
    EXPECT_TRUE(std::isnan(portable::cos(std::numeric_limits<double>::infinity())));
}

/// A hash of the bits of many results.
std::uint64_t bitsOf(const std::function<double(double)>& f, double low, double high) {
    std::uint64_t hash = 0xcbf29ce484222325U;
    for (int i = 0; i < kSamples; ++i) {
        hash = (hash ^ std::bit_cast<std::uint64_t>(f(sample(low, high, i)))) * 0x100000001b3U;
    }
    return hash;
}

// Taken from GCC 12 on x86-64 with -O2. A difference means that a compiler or processor rounds differently:
// look for contraction, x87 or -ffast-math before changing a number here.
TEST(PortableMath, BitsArePortable) {
    EXPECT_EQ(bitsOf(portable::log, 1e-6, 1e6), 0xc2c47b6f2235efc6U);
    EXPECT_EQ(bitsOf(portable::exp, -700.0, 700.0), 0x988ac3a66f2401ccU);
    EXPECT_EQ(bitsOf(portable::sin, -1e5, 1e5), 0x1c92c31377f1482cU);
    EXPECT_EQ(bitsOf(portable::cos, -1e5, 1e5), 0xc20115627a45004fU);
    EXPECT_EQ(bitsOf(portable::acos, -1.0, 1.0), 0x7cde6f4da17904ffU);
}

// The first part of the heap uses large pages if the system supports them, and freed memory is not returned to the
// system.

#if defined(RELIEF_SANITIZED) || defined(__SANITIZE_THREAD__)
constexpr bool kOwnHeap = false;  // a sanitizer replaces the heap
#else
constexpr bool kOwnHeap = true;
#endif

/// The kernel's flags of the mapping that contains an address, as " rd wr … "; "" if it is not mapped.
std::string flagsAt(const void* address) {
    const auto wanted = reinterpret_cast<std::uintptr_t>(address);
    std::ifstream maps("/proc/self/smaps");
    std::string line;
    bool here = false;
    while (std::getline(maps, line)) {
        std::istringstream words(line);
        std::uintptr_t begin = 0;
        std::uintptr_t end = 0;
        char dash = 0;
        if (words >> std::hex >> begin >> dash >> end && dash == '-') {
            here = begin <= wanted && wanted < end;
        } else if (here && line.starts_with("VmFlags:")) {
            return line.substr(8) + " ";
        }
    }
    return "";
}

long pageFaults() {
    rusage usage{};
    ::getrusage(RUSAGE_SELF, &usage);
    return usage.ru_minflt;
}

void touch(std::size_t bytes) {
    const std::unique_ptr<char[]> block(new char[bytes]);
    std::memset(block.get(), 1, bytes);
    EXPECT_EQ(block[bytes / 2], 1);
}

// Runs in its own process because the heap of this process is already in use.
TEST(Heap, RequestsLargePagesAndKeepsFreedMemory) {
    GTEST_FLAG_SET(death_test_style,
                   "threadsafe");  // restarts the program: a fork would inherit this heap
    const auto work = [] {
        prepareHeap(std::size_t{64} << 20);
        const std::unique_ptr<char[]> block(new char[24 << 20]);
        const bool large = flagsAt(block.get() + (12 << 20)).find(" hg ") != std::string::npos;
        constexpr std::size_t kBytes = 24 << 20;  // above a step of the heap, below its largest block
        touch(kBytes);
        const long before = pageFaults();
        touch(kBytes);
        const bool kept = pageFaults() - before < 64;  // 6144 new pages of 4 kB otherwise
        ::_exit(kOwnHeap ? (large ? 0 : 1) + (kept ? 0 : 2) : 0);
    };
    EXPECT_EXIT(work(), testing::ExitedWithCode(0), "")
        << "1: no large pages were requested; 2: freed memory was returned to the system";
}

// If less memory is available, as under ulimit -v, the heap stays unchanged and usable.
TEST(Heap, StaysWithinTheMemoryLimit) {
    const auto work = [] {
        std::ifstream sizes("/proc/self/statm");
        std::uint64_t pages = 0;
        sizes >> pages;
        const rlim_t limit = pages * static_cast<std::uint64_t>(::sysconf(_SC_PAGESIZE)) + (rlim_t{60} << 20);
        const rlimit some{limit, limit};
        const bool limited = !kOwnHeap || ::setrlimit(RLIMIT_AS, &some) == 0;
        const void* const end = ::sbrk(0);
        prepareHeap(std::size_t{1} << 30);
        const bool grown = kOwnHeap && ::sbrk(0) != end;
        void* volatile block = std::malloc(std::size_t{1} << 20);
        ::_exit((limited ? 0 : 1) + (grown ? 2 : 0) + (block != nullptr ? 0 : 4));
    };
    EXPECT_EXIT(work(), testing::ExitedWithCode(0), "")
        << "1: cannot set a limit; 2: the heap exceeded it; 4: allocations fail";
}

}  // namespace
}  // namespace relief::test

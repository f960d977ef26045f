// SPDX-License-Identifier: Apache-2.0
// Option values, and the errors of invalid ones.
#include "runtime/command_line/option_values.h"

#include <gtest/gtest.h>

#include <CLI/CLI.hpp>

#include "runtime/command_line/command_line.h"
#include "tests/results.h"

namespace relief {
namespace {

enum class Fruit { kApple, kPear, kPlum };

struct Values {
    std::uint32_t count = 0;
    float degrees = 0.0F;
    float share = 0.0F;
    ContainerLimits limits;
    std::string color;
    std::optional<Fruit> fruit;
    std::optional<char> letter;
    std::string text;
};

void define(CLI::App& app, Values& values) {
    app.add_option("--count", values.count)->transform(CLI::Validator(wholeNumber(1, 4'000'000'000), ""));
    app.add_option("--degrees", values.degrees)
        ->transform(CLI::Validator(number(0.0F, 360.0F, "degrees, 0 to 360"), ""));
    app.add_option("--share", values.share)->transform(CLI::Validator(percent(), ""));
    addMemoryOption(app, values.limits);
    app.add_option("--color", values.color)->check(CLI::Validator(oneOf(kWords<"red", "blue">), ""));
    addWords(app, "--fruit", values.fruit,
             WordsFor<Fruit>{{"apple", Fruit::kApple}, {"pear", Fruit::kPear}, {"plum", Fruit::kPlum}}, "");
    addParsed(
        app, "-l,--letter", values.letter,
        [](const std::string& word) { return word.size() == 1 ? std::optional(word[0]) : std::nullopt; },
        "a letter", "");
    app.add_option("--text", values.text);
}

Result<Values> parsed(const std::vector<std::string>& arguments) {
    CLI::App app("", "tool");
    Values values;
    define(app, values);
    const Result<bool> read = parseCommandLine(app, arguments);
    return read ? Result<Values>(values) : forward(read);
}

Values taken(const std::string& option, const std::string& word) {
    return required(parsed({option, word}));
}

/// The error message of a command line.
std::string error(const std::vector<std::string>& arguments) {
    const Result<Values> values = parsed(arguments);
    EXPECT_TRUE(values || values.error().code == ErrorCode::kUsage);
    return values ? "" : values.error().message;
}
std::string refused(const std::string& option, const std::string& word) {
    return error({option + "=" + word});
}

TEST(OptionValues, AreReadExactly) {
    EXPECT_EQ(taken("--count", "4000000000").count, 4'000'000'000U);
    EXPECT_EQ(taken("--count", "010").count, 10U) << "not octal";
    EXPECT_EQ(taken("--degrees", "0.1").degrees, 0.1F);
    EXPECT_EQ(taken("--degrees", "+1e-2").degrees, 0.01F);
    EXPECT_EQ(taken("--share", "1.5%").share, 1.5F);
    EXPECT_EQ(taken("--share", " 33.3333333 % ").share, 33.3333333F);
    EXPECT_EQ(taken("--max-memory", "1.5MB").limits.memory, 1'500'000U);
    EXPECT_EQ(taken("--max-memory", "1KiB").limits.memory, 1024U);
    EXPECT_EQ(taken("--color", "blue").color, "blue");
    EXPECT_EQ(taken("--fruit", "plum").fruit, Fruit::kPlum);
    EXPECT_EQ(taken("--letter", "x").letter, 'x');
}

TEST(OptionValues, ErrorsSuggestAFix) {
    const auto allRefused = [](const std::string& option, std::initializer_list<const char*> words,
                               const std::string& must) {
        for (const std::string word : words) {
            EXPECT_EQ(refused(option, word), option + " is '" + word + "' but must be " + must);
        }
    };
    allRefused("--count", {"0", "-1", "0x10", "1e3", " 1", "4000000001", "99999999999999999999999", "one"},
               "a whole number from 1 to 4000000000");
    allRefused("--degrees", {"nan", "inf", "-0.1", "361", "0x1p3", "1e39", "much"}, "degrees, 0 to 360");
    allRefused("--share", {"-1", "%", "nan%", "1%%", "few"}, "a percentage, such as 1.5");
    EXPECT_EQ(refused("--max-memory", "1XB"),
              "--max-memory is '1XB' but must be a number of bytes, such as 1MB or 512KiB");
    EXPECT_EQ(refused("--color", "green"), "--color is 'green' but must be red or blue");
    EXPECT_EQ(refused("--fruit", "aple"),
              "--fruit is 'aple' but must be one of apple, pear, plum; did you mean 'apple'?");
    EXPECT_EQ(refused("--fruit", "1"), "--fruit is '1' but must be one of apple, pear, plum");
    EXPECT_EQ(refused("--letter", "xy"), "--letter is 'xy' but must be a letter");
}

TEST(CommandLine, ErrorsNameTheArgumentAndSuggestAFix) {
    EXPECT_EQ(error({"--cuont", "1"}), "unknown option --cuont; did you mean '--count'?");
    EXPECT_EQ(error({"--nothing-like-it"}), "unknown option --nothing-like-it; see tool --help");
    EXPECT_EQ(error({"word"}), "unexpected argument 'word'; see tool --help");
    EXPECT_EQ(error({"--text", ""}), "--text has no value; add one, or remove the option");
    EXPECT_EQ(error({"--count", "1"}), "");
}

}  // namespace
}  // namespace relief

// SPDX-License-Identifier: Apache-2.0
// Validators and transformers of option values. CLI11's validators accept 0x10, nan, and -1 as a large number, and
// their messages suggest no fix. parseCommandLine() prefixes the messages with the option's name.
#pragma once

#include <cstddef>
#include <cstdint>
#include <functional>
#include <limits>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "formats/container_limits.h"
#include "formats/fields/text.h"

namespace CLI {
class App;
class Option;
}  // namespace CLI

namespace relief {

/// Converts a word to one that CLI11 parses. \return empty, or the error: "is 'x' but must be …"
using WordReader = std::function<std::string(std::string& word)>;

/// An option of a command line, for sources that do not include the CLI11 header, which takes seconds to compile.
class OptionRef {
  public:
    OptionRef(CLI::Option* option) : option_(option) {}  // NOLINT: implicit
    const OptionRef* operator->() const { return this; }

    OptionRef valueText(const std::string& text) const;  ///< the value's name in --help: "OUT.png"
    OptionRef typeName(const std::string& name) const;   ///< the same for a positional argument
    OptionRef required() const;                          ///< --help does not show this; the help text must
    OptionRef values(int count) const;                   ///< the number of values of a list
    OptionRef needs(OptionRef other) const;
    OptionRef needs(const std::string& name) const;
    OptionRef excludes(OptionRef other) const;
    OptionRef excludes(const std::string& name) const;
    OptionRef transform(const WordReader& read) const;
    OptionRef range(double least, double most) const;

  private:
    CLI::Option* option_;
};

/// Adds an option of a type that CLI11 parses; option_values.cpp lists the types.
template <class T>
OptionRef addOption(CLI::App& app, const std::string& names, T& field, const std::string& help);
OptionRef addFlag(CLI::App& app, const std::string& names, bool& field, const std::string& help);

/// Accepts decimal digits, with a value from `least` to `most`.
[[nodiscard]] WordReader wholeNumber(std::uint64_t least = 0,
                                     std::uint64_t most = std::numeric_limits<std::uint64_t>::max());
/// Accepts a finite float from `least` to `most`. \param must  follows "must be": "a number of degrees, 0 or more".
[[nodiscard]] WordReader number(float least, float most, const std::string& must);
/// Accepts "1.5" or "1.5%", 0 or more; both set a float field to 1.5.
[[nodiscard]] WordReader percent();
/// Accepts one of `words`, for a text field.
[[nodiscard]] WordReader oneOf(std::span<const std::string_view> words);

template <class Enum>
using WordsFor = std::vector<std::pair<std::string_view, Enum>>;

/// Returns words as the help shows them: a|b|c.
[[nodiscard]] std::string choices(std::span<const std::string_view> words);
/// Adds an option whose value is one of `words`; the help shows their choices(). \param set  gets the index of the word
OptionRef addWordOption(CLI::App& app, const std::string& names, std::vector<std::string_view> words,
                        std::function<void(std::size_t)> set, const std::string& help);
template <class Field, class Enum>
OptionRef addWords(CLI::App& app, const std::string& names, Field& field, const WordsFor<Enum>& words,
                   const std::string& help) {
    std::vector<std::string_view> known;
    std::vector<Enum> values;
    for (const auto& [word, value] : words) {
        known.push_back(word);
        values.push_back(value);
    }
    return addWordOption(
        app, names, std::move(known),
        [&field, values = std::move(values)](std::size_t i) { field = values[i]; }, help);
}

/// Adds an option with a custom format. \param read  returns false if the word is invalid
OptionRef addCustomOption(CLI::App& app, const std::string& names,
                          std::function<bool(const std::string&)> read, const std::string& must,
                          const std::string& help);
/// \param parse  converts std::string to std::optional<T>; nullopt: invalid
template <class T, class Parse>
OptionRef addParsed(CLI::App& app, const std::string& names, std::optional<T>& field, const Parse& parse,
                    const std::string& must, const std::string& help) {
    return addCustomOption(
        app, names,
        [&field, parse](const std::string& word) {
            field = parse(word);
            return field.has_value();
        },
        must, help);
}

/// Default of ContainerLimits::memory in the tools, bytes. More are accepted, up to 16 times the file size. One
/// map of 4096 x 4096 texels of eight bytes fits.
inline constexpr std::uint64_t kToolMemory = 160'000'000;

/// Sets limits.memory to kToolMemory, and adds --max-memory, which changes it. `limits` must outlive the app.
void addMemoryOption(CLI::App& app, ContainerLimits& limits);

/// Adds an option for each field of a struct or group, which must outlive the app: "max_error" becomes --max-error.
/// Messages are those of readWord(), prefixed with the option's name (parseCommandLine). \return the options, in the
/// order of the fields
std::vector<OptionRef> addFields(CLI::App& app, FieldRef target);

}  // namespace relief

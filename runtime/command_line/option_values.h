// SPDX-License-Identifier: Apache-2.0
// The values of options: validators and transformers for CLI11 that stand in front of a typed field. Those of CLI11
// would take 0x10, -1 for a large number, and nan, and their messages name no cure.
//
// parseCommandLine() puts the name of the option in front of the messages.
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

/// Turns a word into one that CLI11 converts. \return empty, or what is wrong: "is 'x' but must be …".
using WordReader = std::function<std::string(std::string& word)>;

/// An option of a command line, for sources that do without the header of CLI11, which takes seconds to compile.
class OptionRef {
  public:
    OptionRef(CLI::Option* option) : option_(option) {}  // NOLINT: implicit
    const OptionRef* operator->() const { return this; }

    OptionRef valueText(const std::string& text) const;  ///< stands for the value in --help: "OUT.png"
    OptionRef typeName(const std::string& name) const;   ///< the same of an argument without a name
    OptionRef required() const;
    OptionRef needs(OptionRef other) const;
    OptionRef needs(const std::string& name) const;
    OptionRef excludes(OptionRef other) const;
    OptionRef excludes(const std::string& name) const;
    OptionRef group(const std::string& heading) const;  ///< the section of --help that lists the option
    OptionRef transform(const WordReader& read) const;
    OptionRef range(double least, double most) const;

  private:
    CLI::Option* option_;
};

/// An option that CLI11 converts: a string, a path, a number or an optional of one; option_values.cpp lists the types.
template <class T>
OptionRef addOption(CLI::App& app, const std::string& names, T& field, const std::string& help);
OptionRef addFlag(CLI::App& app, const std::string& names, bool& field, const std::string& help);

/// Decimal digits alone, from `least` to `most`.
[[nodiscard]] WordReader wholeNumber(std::uint64_t least = 0,
                                     std::uint64_t most = std::numeric_limits<std::uint64_t>::max());
/// A finite float from `least` to `most`. \param must  "a number of degrees, 0 or more".
[[nodiscard]] WordReader number(float least, float most, const std::string& must);
/// "1.5" or "1.5%", 0 or more; for a float field.
[[nodiscard]] WordReader percent();
/// One of some words, as kWords, for a field that holds text.
[[nodiscard]] WordReader oneOf(std::span<const std::string_view> words);

template <class Enum>
using WordsFor = std::vector<std::pair<std::string_view, Enum>>;

/// An option that takes one of some words; the help shows them as a|b|c. \param set  gets the index of the word.
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

/// An option of a form of its own. \param read  whether the word has that form
OptionRef addFormOption(CLI::App& app, const std::string& names, std::function<bool(const std::string&)> read,
                        const std::string& must, const std::string& help);
/// \param parse  std::string to std::optional<T>; nullopt: not of this form.
template <class T, class Parse>
OptionRef addParsed(CLI::App& app, const std::string& names, std::optional<T>& field, const Parse& parse,
                    const std::string& must, const std::string& help) {
    return addFormOption(
        app, names,
        [&field, parse](const std::string& word) {
            field = parse(word);
            return field.has_value();
        },
        must, help);
}

/// Bytes that the tools unpack of a file that is smaller than a sixteenth of it: a map of 4096x4096 of eight bytes a
/// texel, and a little.
inline constexpr std::uint64_t kToolMemory = 160'000'000;

/// Lowers limits.memory to kToolMemory, and adds --max-memory, which sets it. `limits` must outlive the app.
OptionRef addMemoryOption(CLI::App& app, ContainerLimits& limits);

// The fields of a struct as options of a command line: "max_error" is --max-error.

/// Adds an option for each field of a struct, or of a group, which must outlive the app. Messages are those of readWord(),
/// with the name of the option in front (parseCommandLine). \return the options, in that order.
std::vector<OptionRef> addFields(CLI::App& app, FieldRef target);

}  // namespace relief

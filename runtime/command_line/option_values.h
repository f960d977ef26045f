// The values of options: validators and transformers for CLI11 that stand in front of a typed field. Those of CLI11
// would take 0x10, -1 for a large number, and nan, and their messages name no cure.
//
// Each turns the word into one that CLI11 converts, or says "is 'x' but must be …"; parseCommandLine() puts the name of
// the option in front.
#pragma once

#include <CLI/CLI.hpp>
#include <cstdint>
#include <functional>
#include <limits>
#include <optional>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "formats/container_limits.h"
#include "formats/fields/text.h"

namespace relief {

/// Decimal digits alone, from `least` to `most`.
[[nodiscard]] CLI::Validator wholeNumber(std::uint64_t least = 0,
                                         std::uint64_t most = std::numeric_limits<std::uint64_t>::max());
/// A finite float from `least` to `most`. \param must  "a number of degrees, 0 or more".
[[nodiscard]] CLI::Validator number(float least, float most, const std::string& must);
/// "1.5" or "1.5%", 0 or more; for a float field.
[[nodiscard]] CLI::Validator percent();
/// One of some words, as kWords, for a field that holds text.
[[nodiscard]] CLI::Validator oneOf(std::span<const std::string_view> words);

template <class Enum>
using WordsFor = std::vector<std::pair<std::string_view, Enum>>;

/// An option that takes one of some words; the help shows them as a|b|c.
template <class Field, class Enum>
CLI::Option* addWords(CLI::App& app, const std::string& names, Field& field, const WordsFor<Enum>& words,
                      const std::string& help) {
    std::string shown;
    for (const auto& [word, value] : words) {
        shown.append(shown.empty() ? "" : "|").append(word);
    }
    return app.add_option(names, field, help)
        ->option_text(shown)
        ->transform(CLI::Validator(
            [words](std::string& text) -> std::string {
                std::vector<std::string_view> known;
                for (const auto& [word, value] : words) {
                    if (text == word) {
                        text = std::to_string(static_cast<unsigned>(value));
                        return {};
                    }
                    known.push_back(word);
                }
                return butMustBeOneOf(text, known);
            },
            ""));
}

/// An option of a form of its own. \param parse  std::string to std::optional<T>; nullopt: not of this form.
template <class T, class Parse>
CLI::Option* addParsed(CLI::App& app, const std::string& names, std::optional<T>& field, const Parse& parse,
                       const std::string& must, const std::string& help) {
    const std::string name = names.substr(names.rfind(',') + 1);
    const CLI::callback_t read = [&field, parse, must, name](const CLI::results_t& words) {
        field = parse(words.back());
        if (!field) {
            throw CLI::ValidationError(name, butMustBe(words.back(), must));
        }
        return true;
    };
    return app.add_option(names, read, help);
}

/// Bytes that the tools unpack of a file that is smaller than a sixteenth of it: a map of 4096x4096 of eight bytes a
/// texel, and a little.
inline constexpr std::uint64_t kToolMemory = 160'000'000;

/// Lowers limits.memory to kToolMemory, and adds --max-memory, which sets it. `limits` must outlive the app.
void addMemoryOption(CLI::App& app, ContainerLimits& limits);

// The fields of a struct as options of a command line: "max_error" is --max-error.

/// A visitor of fields() that adds an option for each. The struct must outlive the app. Messages are those of readWord(), with
/// the name of the option in front (parseCommandLine).
class FieldOptions {
  public:
    explicit FieldOptions(CLI::App& app) : app_(app) {}

    template <class T>
    void operator()(std::string_view name, T& value, const FieldInfo& info) {
        if constexpr (std::same_as<T, bool>) {
            options_.push_back(app_.add_flag(optionName(name), value, std::string(info.help)));
        } else {
            FieldCollector described;
            described(name, value, info);
            add(described.take().front(),
                [&value, info](const std::string& word) { return readWord(word, info, value); });
        }
    }
    [[nodiscard]] const std::vector<CLI::Option*>& options() const { return options_; }

  private:
    void add(const FieldWords& field, const std::function<std::string(const std::string&)>& read);

    CLI::App& app_;
    std::vector<CLI::Option*> options_;
};

/// Adds the fields of a struct. \return the options, in that order.
template <class S>
std::vector<CLI::Option*> addFields(CLI::App& app, S& target) {
    FieldOptions visitor(app);
    fields(visitor, target);
    return visitor.options();
}

}  // namespace relief

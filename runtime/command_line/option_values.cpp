// SPDX-License-Identifier: Apache-2.0
#include "runtime/command_line/option_values.h"

#include <CLI/CLI.hpp>
#include <algorithm>
#include <filesystem>

#include "runtime/command_line/command_line.h"

namespace relief {
namespace {

/// Validates a word by readWord() for type T, and converts it to one that CLI11 parses.
template <class T>
WordReader fieldValue(const FieldInfo& info, const std::string& must = {}) {
    return [info, must](std::string& word) {
        FieldInfo named = info;
        named.must = must;
        T value{};
        std::string wrong = readWord(word, named, value);
        word = wrong.empty() ? wordsOf(value).front() : word;
        return wrong;
    };
}

/// The help, the default and the largest value of a count.
std::string helpOf(const FieldWords& field) {
    const std::string value = defaultText(field);
    std::string limits = value.empty() ? "" : "default: " + value;
    const FieldRange& range = field.info.range;
    if (field.number && field.info.must.empty() && range.high < 1e9) {
        limits += (limits.empty() ? "at most " : "; at most ") + numberWord(range.high);
    }
    return std::string(field.info.help) + (limits.empty() ? "" : " (" + limits + ")");
}

}  // namespace

OptionRef OptionRef::valueText(const std::string& text) const {
    return option_->option_text(text);
}

OptionRef OptionRef::typeName(const std::string& name) const {
    return option_->type_name(name);
}

OptionRef OptionRef::required() const {
    return option_->required();
}

OptionRef OptionRef::values(int count) const {
    return option_->expected(count);
}

OptionRef OptionRef::needs(OptionRef other) const {
    return option_->needs(other.option_);
}

OptionRef OptionRef::needs(const std::string& name) const {
    return option_->needs(name);
}

OptionRef OptionRef::excludes(OptionRef other) const {
    return option_->excludes(other.option_);
}

OptionRef OptionRef::excludes(const std::string& name) const {
    return option_->excludes(name);
}

OptionRef OptionRef::transform(const WordReader& read) const {
    return option_->transform(CLI::Validator(read, ""));
}

OptionRef OptionRef::range(double least, double most) const {
    return option_->check(CLI::Range(least, most));
}

template <class T>
OptionRef addOption(CLI::App& app, const std::string& names, T& field, const std::string& help) {
    return app.add_option(names, field, help);
}
template OptionRef addOption(CLI::App&, const std::string&, std::string&, const std::string&);
template OptionRef addOption(CLI::App&, const std::string&, std::vector<std::string>&, const std::string&);
template OptionRef addOption(CLI::App&, const std::string&, std::filesystem::path&, const std::string&);
template OptionRef addOption(CLI::App&, const std::string&, std::uint64_t&, const std::string&);
template OptionRef addOption(CLI::App&, const std::string&, std::optional<std::uint32_t>&,
                             const std::string&);
template OptionRef addOption(CLI::App&, const std::string&, std::optional<std::uint64_t>&,
                             const std::string&);
template OptionRef addOption(CLI::App&, const std::string&, std::optional<float>&, const std::string&);

OptionRef addFlag(CLI::App& app, const std::string& names, bool& field, const std::string& help) {
    return app.add_flag(names, field, help);
}

WordReader wholeNumber(std::uint64_t least, std::uint64_t most) {
    return fieldValue<std::uint64_t>({.range = {static_cast<double>(least), static_cast<double>(most)}});
}

WordReader number(float least, float most, const std::string& must) {
    return fieldValue<float>({.range = {double{least}, double{most}}}, must);
}

WordReader percent() {
    return fieldValue<float>({.unit = "%", .range = kFromZero});
}

WordReader oneOf(std::span<const std::string_view> words) {
    return fieldValue<std::string>({.words = words});
}

void addMemoryOption(CLI::App& app, ContainerLimits& limits) {
    limits.memory = kToolMemory;
    addOption(app, "--max-memory", limits.memory,
              "Memory limit for a collider's unpacked texels (default: 160MB, or 16 times the file "
              "size if larger)")
        ->valueText("BYTES")
        ->transform(fieldValue<std::uint64_t>({.unit = "bytes", .range = kFromOne}));
}

std::string choices(std::span<const std::string_view> words) {
    std::string text;
    for (const std::string_view word : words) {
        text.append(text.empty() ? "" : "|").append(word);
    }
    return text;
}

OptionRef addWordOption(CLI::App& app, const std::string& names, std::vector<std::string_view> words,
                        std::function<void(std::size_t)> set, const std::string& help) {
    const std::string shown = choices(words);
    const std::string name = names.substr(names.rfind(',') + 1);
    const CLI::callback_t read = [words = std::move(words), set = std::move(set),
                                  name](const CLI::results_t& given) {
        const auto found = std::find(words.begin(), words.end(), given.back());
        if (found == words.end()) {
            throw CLI::ValidationError(name, expectedOneOfMessage(given.back(), words));
        }
        set(static_cast<std::size_t>(found - words.begin()));
        return true;
    };
    return app.add_option(names, read, help)->option_text(shown);
}

OptionRef addCustomOption(CLI::App& app, const std::string& names,
                          std::function<bool(const std::string&)> read, const std::string& must,
                          const std::string& help) {
    const std::string name = names.substr(names.rfind(',') + 1);
    const CLI::callback_t callback = [read = std::move(read), must, name](const CLI::results_t& words) {
        if (!read(words.back())) {
            throw CLI::ValidationError(name, expectedMessage(words.back(), must));
        }
        return true;
    };
    return app.add_option(names, callback, help);
}

namespace {

class FieldOptions : public FieldVisitor {
  public:
    explicit FieldOptions(CLI::App& app) : app_(app) {}

    void operator()(std::string_view name, FieldRef value, const FieldInfo& info) override {
        if (value.form() == FieldForm::kBool) {
            options_.push_back(app_.add_flag(optionName(name), value.as<bool>(),
                                             withDetails(std::string(info.help), std::string(info.details))));
        } else {
            add(describeField(name, value, info),
                [value, info](const std::string& word) { return readWord(word, info, value); });
        }
    }
    [[nodiscard]] bool fills() const override { return true; }
    std::vector<OptionRef> take() { return std::move(options_); }

  private:
    void add(const FieldWords& field, const std::function<std::string(const std::string&)>& read);

    CLI::App& app_;
    std::vector<OptionRef> options_;
};

void FieldOptions::add(const FieldWords& field, const std::function<std::string(const std::string&)>& read) {
    const std::string name = optionName(field.name);
    const std::string letter = field.info.letter == '\0' ? "" : std::string{'-', field.info.letter, ','};
    CLI::Option* option = app_.add_option(
        letter + name,
        [name, read](const CLI::results_t& words) {
            for (const std::string& word : words) {
                const std::string wrong = read(word);
                if (!wrong.empty()) {
                    throw CLI::ValidationError(name, wrong);
                }
            }
            return true;
        },
        withDetails(helpOf(field), std::string(field.info.details)));
    option->option_text(valueText(field));
    if (field.kind == FieldKind::kList) {
        option->expected(1)->multi_option_policy(CLI::MultiOptionPolicy::TakeAll)->allow_extra_args(false);
    }
    options_.emplace_back(option);
}

}  // namespace

std::vector<OptionRef> addFields(CLI::App& app, FieldRef target) {
    FieldOptions options(app);
    target.visit(options);
    return options.take();
}

}  // namespace relief

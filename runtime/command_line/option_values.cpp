#include "runtime/command_line/option_values.h"

#include <CLI/CLI.hpp>
#include <algorithm>

namespace relief {
namespace {

/// The words that readWord() takes for a T, as words that CLI11 converts.
template <class T>
CLI::Validator fieldValue(const FieldInfo& info, const std::string& must = {}) {
    return {[info, must](std::string& word) {
                FieldInfo named = info;
                named.must = must;
                T value{};
                std::string wrong = readWord(word, named, value);
                word = wrong.empty() ? wordsOf(value).front() : word;
                return wrong;
            },
            ""};
}

/// The sentence, the default and the largest value of a count.
std::string helpOf(const FieldWords& field) {
    std::string help(field.info.help);
    if (const std::string value = defaultText(field); !value.empty()) {
        help += "; default: " + value;
    }
    const FieldRange& range = field.info.range;
    if (field.number && field.info.must.empty() && range.high < 1e9) {
        help += "; at most " + numberWord(range.high);
    }
    return help;
}

}  // namespace

CLI::Validator wholeNumber(std::uint64_t least, std::uint64_t most) {
    return fieldValue<std::uint64_t>({.range = {static_cast<double>(least), static_cast<double>(most)}});
}

CLI::Validator number(float least, float most, const std::string& must) {
    return fieldValue<float>({.range = {double{least}, double{most}}}, must);
}

CLI::Validator percent() {
    return fieldValue<float>({.unit = "%", .range = kFromZero});
}

CLI::Validator oneOf(std::span<const std::string_view> words) {
    return fieldValue<std::string>({.words = words});
}

void addMemoryOption(CLI::App& app, ContainerLimits& limits) {
    limits.memory = kToolMemory;
    app.add_option(
           "--max-memory", limits.memory,
           "Texels that a collider may unpack to; default 160MB, or 16 times its file if that is more")
        ->option_text("BYTES")
        ->transform(fieldValue<std::uint64_t>({.unit = "bytes", .range = kFromOne}));
}

CLI::Option* addWordOption(CLI::App& app, const std::string& names, std::vector<std::string_view> words,
                           std::function<void(std::size_t)> set, const std::string& help) {
    std::string shown;
    for (const std::string_view word : words) {
        shown.append(shown.empty() ? "" : "|").append(word);
    }
    const std::string name = names.substr(names.rfind(',') + 1);
    const CLI::callback_t read = [words = std::move(words), set = std::move(set),
                                  name](const CLI::results_t& given) {
        const auto found = std::find(words.begin(), words.end(), given.back());
        if (found == words.end()) {
            throw CLI::ValidationError(name, butMustBeOneOf(given.back(), words));
        }
        set(static_cast<std::size_t>(found - words.begin()));
        return true;
    };
    return app.add_option(names, read, help)->option_text(shown);
}

CLI::Option* addFormOption(CLI::App& app, const std::string& names,
                           std::function<bool(const std::string&)> read, const std::string& must,
                           const std::string& help) {
    const std::string name = names.substr(names.rfind(',') + 1);
    const CLI::callback_t callback = [read = std::move(read), must, name](const CLI::results_t& words) {
        if (!read(words.back())) {
            throw CLI::ValidationError(name, butMustBe(words.back(), must));
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
            options_.push_back(app_.add_flag(optionName(name), value.as<bool>(), std::string(info.help)));
        } else {
            add(describeField(name, value, info),
                [value, info](const std::string& word) { return readWord(word, info, value); });
        }
    }
    [[nodiscard]] bool fills() const override { return true; }
    std::vector<CLI::Option*> take() { return std::move(options_); }

  private:
    void add(const FieldWords& field, const std::function<std::string(const std::string&)>& read);

    CLI::App& app_;
    std::vector<CLI::Option*> options_;
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
        helpOf(field));
    option->option_text(valueText(field));
    if (field.kind == FieldKind::kList) {
        option->expected(1)->multi_option_policy(CLI::MultiOptionPolicy::TakeAll)->allow_extra_args(false);
    }
    options_.push_back(option);
}

}  // namespace

std::vector<CLI::Option*> addFields(CLI::App& app, FieldRef target) {
    FieldOptions options(app);
    target.visit(options);
    return options.take();
}

}  // namespace relief

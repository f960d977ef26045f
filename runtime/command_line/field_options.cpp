#include "runtime/command_line/field_options.h"

namespace relief {
namespace {

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

}  // namespace relief

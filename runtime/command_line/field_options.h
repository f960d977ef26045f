// The fields of a struct as options of a command line: "max_error" is --max-error.
#pragma once

#include <CLI/CLI.hpp>
#include <functional>
#include <string>
#include <string_view>
#include <vector>

#include "formats/fields/text.h"

namespace relief {

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

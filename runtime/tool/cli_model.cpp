#include "runtime/tool/cli_model.h"

#include <CLI/CLI.hpp>
#include <algorithm>
#include <sstream>
#include <string_view>

namespace relief {
namespace {

std::vector<std::string> linesOf(const std::string& text) {
    std::vector<std::string> lines;
    std::istringstream in(text);
    for (std::string line; std::getline(in, line);) {
        if (!line.empty()) {
            lines.push_back(line);
        }
    }
    return lines;
}

/// "x|y|z" as three words, "[NAME=]x|y" as two; nothing for "WxH" or "SCENE.toml|COLLIDER.relief", which are no words to
/// type.
std::vector<std::string> wordsOf(const std::string& value) {
    std::vector<std::string> words;
    std::istringstream in(value.substr(value.starts_with('[') ? value.find(']') + 1 : 0));
    for (std::string word; std::getline(in, word, '|');) {
        const bool literal = !word.empty() && std::ranges::all_of(word, [](char c) {
            return (c >= 'a' && c <= 'z') || (c >= '0' && c <= '9') || c == '-';
        });
        if (!literal) {
            return {};
        }
        words.push_back(word);
    }
    return words.size() > 1 ? words : std::vector<std::string>();
}

CliValue kindOf(const CliOption& option) {
    const auto is = [&](std::string_view name) { return option.value == name; };
    if (!option.words.empty()) {
        return CliValue::kWords;
    }
    if (is("DIR") || is("FOLDER")) {
        return CliValue::kFolder;
    }
    const bool named_file = option.value.find('.') != std::string::npos;
    return named_file || is("FILE") || is("MESH") || is("OUT") ? CliValue::kFile : CliValue::kNone;
}

CliOption readOption(const CLI::Option& option) {
    CliOption read;
    for (const std::string& name : option.get_snames()) {
        read.names.push_back("-" + name);
    }
    for (const std::string& name : option.get_lnames()) {
        read.names.push_back("--" + name);
    }
    read.positional = read.names.empty();
    if (read.positional) {
        read.names.push_back(option.get_name(true));
    }
    if (option.get_expected_max() > 0) {
        const std::string type =
            option.get_option_text().empty() ? option.get_type_name() : option.get_option_text();
        read.value = type.empty() ? read.names.front() : type;
    }
    read.description = option.get_description();
    read.words = wordsOf(read.value);
    read.kind = kindOf(read);
    read.required = option.get_required();
    read.repeatable = option.get_multi_option_policy() == CLI::MultiOptionPolicy::TakeAll;
    return read;
}

CliCommand readCommand(const CLI::App& app, const std::string& name) {
    CliCommand command;
    command.name = name;
    const std::string text = app.get_description();
    const std::size_t end = text.find('\n');
    command.summary = text.substr(0, end);
    if (end != std::string::npos) {
        command.description = text.substr(std::min(text.find_first_not_of('\n', end), text.size()));
    }
    command.examples = linesOf(app.get_footer());
    std::vector<CliOption> named;
    for (const CLI::Option* option : app.get_options()) {
        if (option->get_group().empty()) {
            continue;
        }
        CliOption read = readOption(*option);
        (read.positional ? command.options : named).push_back(std::move(read));
    }
    command.options.insert(command.options.end(), named.begin(), named.end());
    for (const CLI::App* verb : app.get_subcommands([](const CLI::App*) { return true; })) {
        command.verbs.push_back(readCommand(*verb, name + " " + verb->get_name()));
    }
    return command;
}

}  // namespace

CliProgram readProgram(const CLI::App& app, const std::string& version) {
    return {app.get_name(), version, readCommand(app, app.get_name())};
}

std::string joined(const std::vector<std::string>& words, const char* separator) {
    std::string text;
    for (const std::string& word : words) {
        text += (text.empty() ? "" : separator) + word;
    }
    return text;
}

}  // namespace relief

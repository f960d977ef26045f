#include "runtime/tool/cli_model.h"

#include <algorithm>
#include <nlohmann/json.hpp>
#include <sstream>
#include <string_view>

namespace relief {
namespace {

using Json = nlohmann::ordered_json;

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

/// "x|y|z" as three words; nothing for "WxH" or "SCENE.toml|COLLIDER.relief", which are no words to type.
std::vector<std::string> wordsOf(const std::string& value) {
    std::vector<std::string> words;
    std::istringstream in(value);
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

Json jsonOptions(const CliCommand& command) {
    Json options = Json::array();
    for (const CliOption& option : command.options) {
        options.push_back({{"names", option.names},
                           {"value", option.value.empty() ? Json(nullptr) : Json(option.value)},
                           {"words", option.words},
                           {"positional", option.positional},
                           {"required", option.required},
                           {"repeatable", option.repeatable},
                           {"description", option.description}});
    }
    return options;
}

}  // namespace

CliProgram readProgram(const CLI::App& app, const std::string& name, const std::string& version) {
    return {name, version, readCommand(app, name)};
}

std::string cliJson(const CliProgram& program) {
    Json verbs = Json::array();
    for (const CliCommand& verb : program.command.verbs) {
        verbs.push_back({{"name", verb.name.substr(program.name.size() + 1)},
                         {"summary", verb.summary},
                         {"options", jsonOptions(verb)}});
    }
    const Json json = {{"program", program.name},
                       {"version", program.version},
                       {"options", jsonOptions(program.command)},
                       {"verbs", verbs}};
    return json.dump(2, ' ', false, Json::error_handler_t::replace) + "\n";
}

std::optional<std::string> dumpedCommandLine(const CliProgram& program, int argc, const char* const* argv) {
    if (argc != 3 || std::string_view(argv[1]) != "--dump-cli") {
        return std::nullopt;
    }
    const std::string_view format = argv[2];
    if (format == "json") {
        return cliJson(program);
    }
    if (format == "man") {
        return manPage(program, nullptr);
    }
    for (const CliCommand& verb : program.command.verbs) {
        if (format == "man:" + verb.name.substr(program.name.size() + 1)) {
            return manPage(program, &verb);
        }
    }
    return format == "bash"   ? std::optional(bashCompletion(program))
           : format == "zsh"  ? std::optional(zshCompletion(program))
           : format == "fish" ? std::optional(fishCompletion(program))
                              : std::nullopt;
}

}  // namespace relief

// Completions for bash, zsh and fish.
#include <algorithm>

#include "runtime/tool/cli_model.h"

namespace relief {
namespace {

/// The first line: completions have no room for more.
std::string shortText(const std::string& description) {
    return description.substr(0, description.find('\n'));
}

/// In single quotes of a POSIX shell, which fish reads the same but for a backslash.
std::string quoted(const std::string& text, bool fish = false) {
    std::string out = "'";
    for (const char c : text) {
        if (c == '\'') {
            out += fish ? "\\'" : "'\\''";
        } else if (c == '\\' && fish) {
            out += "\\\\";
        } else {
            out += c;
        }
    }
    return out + "'";
}

std::string verbName(const CliProgram& program, const CliCommand& verb) {
    return verb.name.substr(program.name.size() + 1);
}

/// The program's own command and each verb, by its word; "" for the former.
std::vector<std::pair<std::string, const CliCommand*>> commandsOf(const CliProgram& program) {
    std::vector<std::pair<std::string, const CliCommand*>> commands = {{"", &program.command}};
    for (const CliCommand& verb : program.command.verbs) {
        commands.emplace_back(verbName(program, verb), &verb);
    }
    return commands;
}

std::string identifier(std::string name) {
    std::ranges::replace(name, '-', '_');
    return name;
}

std::string bashValue(const CliOption& option) {
    switch (option.kind) {
        case CliValue::kWords:
            return "mapfile -t COMPREPLY < <(compgen -W " + quoted(joined(option.words, " ")) +
                   " -- \"$cur\")";
        case CliValue::kFile:
            return "compopt -o filenames 2>/dev/null; mapfile -t COMPREPLY < <(compgen -f -- \"$cur\")";
        case CliValue::kFolder:
            return "compopt -o filenames 2>/dev/null; mapfile -t COMPREPLY < <(compgen -d -- \"$cur\")";
        case CliValue::kNone:
            break;
    }
    return "COMPREPLY=()";
}

/// Cases of $verb:$prev: what may follow an option.
std::string bashValues(const std::string& verb, const CliCommand& command) {
    std::string text;
    for (const CliOption& option : command.options) {
        if (option.positional || option.value.empty()) {
            continue;
        }
        std::vector<std::string> patterns;
        for (const std::string& name : option.names) {
            patterns.push_back(verb + ":" + name);
        }
        text += "    " + joined(patterns, " | ") + ")\n        " + bashValue(option) +
                "\n        return\n        ;;\n";
    }
    return text;
}

/// A case of $verb: its options, its verbs or files.
std::string bashNames(const std::string& verb, const CliCommand& command,
                      const std::vector<std::string>& verbs) {
    std::vector<std::string> names;
    bool positional = false;
    for (const CliOption& option : command.options) {
        positional = positional || option.positional;
        if (!option.positional) {
            names.insert(names.end(), option.names.begin(), option.names.end());
        }
    }
    std::string text =
        "    " + (verb.empty() ? "''" : verb) + ")\n        if [ \"${cur:0:1}\" = - ]; then\n" +
        "            mapfile -t COMPREPLY < <(compgen -W " + quoted(joined(names, " ")) + " -- \"$cur\")\n";
    if (verb.empty() && !verbs.empty()) {
        text += "        else\n            mapfile -t COMPREPLY < <(compgen -W " +
                quoted(joined(verbs, " ")) + " -- \"$cur\")\n";
    } else if (positional) {
        text +=
            "        else\n            compopt -o filenames 2>/dev/null\n"
            "            mapfile -t COMPREPLY < <(compgen -f -- \"$cur\")\n";
    }
    return text + "        fi\n        ;;\n";
}

/// One alternative of _arguments a name: "(-o --output)"{-o,--output}"[text]:value:action".
std::string zshOption(const CliOption& option) {
    const auto plain = [](const std::string& text) {  // what _arguments gives a meaning to
        std::string out;
        for (const char c : text) {
            out += c == ':' || c == '[' || c == ']' || c == '\\' ? std::string("\\") + c : std::string(1, c);
        }
        return out;
    };
    std::string action;
    switch (option.kind) {
        case CliValue::kWords:
            action = "(" + joined(option.words, " ") + ")";
            break;
        case CliValue::kFile:
            action = "_files";
            break;
        case CliValue::kFolder:
            action = "_files -/";
            break;
        case CliValue::kNone:
            action = " ";
            break;
    }
    if (option.positional) {
        return "        " + quoted(":" + plain(option.names.front()) + ":_files");
    }
    std::string text;
    const std::string value = option.value.empty() ? "" : ":" + plain(option.value) + ":" + action;
    for (const std::string& name : option.names) {
        const std::string others = option.repeatable ? "*" : "(" + joined(option.names, " ") + ")";
        const std::string spec = others + name + "[" + plain(shortText(option.description)) + "]" + value;
        text += (text.empty() ? "" : " \\\n") + std::string("        ") + quoted(spec);
    }
    return text;
}

std::string zshArguments(const CliCommand& command) {
    std::string text = "    _arguments -s -S";
    for (const CliOption& option : command.options) {
        text += " \\\n" + zshOption(option);
    }
    return text;
}

}  // namespace

std::string bashCompletion(const CliProgram& program) {
    const std::string function = "_" + identifier(program.name);
    std::string text =
        "# bash completion of " + program.name + " " + program.version + "\n" + function +
        "() {\n"
        "    local cur=${COMP_WORDS[COMP_CWORD]} prev=${COMP_WORDS[COMP_CWORD - 1]} verb= word\n"
        "    # bash takes --option=value for three words.\n"
        "    if [ \"$cur\" = = ]; then\n"
        "        cur=\n"
        "    elif [ \"$prev\" = = ] && [ \"$COMP_CWORD\" -ge 2 ]; then\n"
        "        prev=${COMP_WORDS[COMP_CWORD - 2]}\n"
        "    fi\n"
        "    COMPREPLY=()\n";
    const auto commands = commandsOf(program);
    std::vector<std::string> verbs;
    for (const auto& [verb, command] : commands) {
        if (!verb.empty()) {
            verbs.push_back(verb);
        }
    }
    if (!verbs.empty()) {
        text +=
            "    for word in \"${COMP_WORDS[@]:1:COMP_CWORD-1}\"; do\n"
            "        case $word in\n"
            "        " +
            joined(verbs, " | ") + ") verb=$word && break ;;\n        esac\n    done\n";
    }
    text += "    case $verb:$prev in\n";
    for (const auto& [verb, command] : commands) {
        text += bashValues(verb, *command);
    }
    text += "    esac\n    case $verb in\n";
    for (const auto& [verb, command] : commands) {
        text += bashNames(verb, *command, verbs);
    }
    return text + "    esac\n}\ncomplete -F " + function + " " + program.name + "\n";
}

std::string zshCompletion(const CliProgram& program) {
    std::string text =
        "#compdef " + program.name + "\n# zsh completion of " + program.name + " " + program.version + "\n";
    if (program.command.verbs.empty()) {
        return text + zshArguments(program.command).substr(4) + "\n";
    }
    const std::string function = "_" + identifier(program.name) + "_verb";
    text += function + "() {\n    local verb=$words[1]\n    case $verb in\n";
    for (const CliCommand& verb : program.command.verbs) {
        text += "    " + verbName(program, verb) + ")\n    " + zshArguments(verb) + "\n        ;;\n";
    }
    text += "    esac\n}\n";
    text += zshArguments(program.command).substr(4) + " \\\n        '1:verb:((";
    for (const CliCommand& verb : program.command.verbs) {
        std::string summary;
        for (const char c : verb.summary) {
            summary +=
                c == ' ' || c == ',' || c == '(' || c == ')' ? std::string("\\") + c : std::string(1, c);
        }
        text +=
            (&verb == &program.command.verbs.front() ? "" : " ") + verbName(program, verb) + "\\:" + summary;
    }
    return text + "))' \\\n        '*::arguments:" + function + "'\n";
}

std::string fishCompletion(const CliProgram& program) {
    std::string text = "# fish completion of " + program.name + " " + program.version + "\n";
    const std::string start = "complete -c " + program.name;
    if (!program.command.verbs.empty()) {
        text += start + " -f -n __fish_use_subcommand\n";
    }
    for (const auto& [verb, command] : commandsOf(program)) {
        const bool top = verb.empty();
        const std::string condition = program.command.verbs.empty() ? ""
                                      : top                         ? " -n __fish_use_subcommand"
                                            : " -n " + quoted("__fish_seen_subcommand_from " + verb, true);
        if (!top) {
            text += start + " -n __fish_use_subcommand -a " + verb + " -d " + quoted(command->summary, true) +
                    "\n";
        }
        for (const CliOption& option : command->options) {
            if (option.positional) {
                continue;  // files, as fish offers by itself
            }
            std::string line = start + condition;
            for (const std::string& name : option.names) {
                line += name.starts_with("--") ? " -l " + name.substr(2) : " -s " + name.substr(1);
            }
            switch (option.kind) {
                case CliValue::kWords:
                    line += " -x -a " + quoted(joined(option.words, " "), true);
                    break;
                case CliValue::kFile:
                    line += " -r -F";
                    break;
                case CliValue::kFolder:
                    line += " -x -a '(__fish_complete_directories)'";
                    break;
                case CliValue::kNone:
                    line += option.value.empty() ? "" : " -x";
                    break;
            }
            text += line + " -d " + quoted(shortText(option.description), true) + "\n";
        }
    }
    return text;
}

}  // namespace relief

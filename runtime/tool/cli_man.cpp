// Manual pages in man(7) macros.
#include <algorithm>

#include "formats/base/result.h"
#include "runtime/tool/cli_model.h"

namespace relief {
namespace {

/// Text as roff prints it: backslashes, and hyphens that can be copied as such; no line is taken for a
/// request.
std::string escaped(const std::string& text) {
    std::string out;
    bool line_start = true;
    for (const char c : text) {
        if (line_start && (c == '.' || c == '\'')) {
            out += "\\&";
        }
        line_start = c == '\n';
        if (c == '\\') {
            out += "\\e";
        } else if (c == '-') {
            out += "\\-";
        } else {
            out += c;
        }
    }
    return out;
}

/// An argument of a macro: quotes end it.
std::string argument(const std::string& text) {
    std::string out = "\"";
    for (const char c : escaped(text)) {
        out += c == '"' ? std::string("\\(dq") : std::string(1, c);
    }
    return out + "\"";
}

/// Paragraphs; lines of one are filled, as roff does.
std::string paragraphs(const std::string& text) {
    std::string out;
    std::size_t start = 0;
    while (start < text.size()) {
        const std::size_t end = std::min(text.find("\n\n", start), text.size());
        out += (start > 0 ? ".PP\n" : "") + escaped(text.substr(start, end - start)) + "\n";
        start = std::min(text.find_first_not_of('\n', end), text.size());
    }
    return out;
}

std::string optionEntry(const CliOption& option) {
    std::string head = ".BR " + argument(joined(option.names, ", "));
    if (!option.value.empty() && !option.positional) {
        head = ".BI " + argument(joined(option.names, ", ") + " ") + " " + argument(option.value);
    }
    std::string text = ".TP\n" + head + "\n";
    // Descriptions of several lines are tables for the terminal: their lines stay lines.
    const bool lines = option.description.find('\n') != std::string::npos;
    text += (lines ? ".nf\n" : "") + escaped(option.description) + "\n" + (lines ? ".fi\n" : "");
    return text;
}

std::string synopsis(const CliCommand& command) {
    std::string text = ".B " + escaped(command.name) + "\n";
    for (const CliOption& option : command.options) {
        if (option.positional) {
            const std::string name = "\\fI" + escaped(option.names.front()) + "\\fR";
            text += (option.required ? name : "[" + name + "]") + "\n";
        } else if (option.required) {
            text += ".BI " + argument(option.names.front() + " ") + " " + argument(option.value) + "\n";
        }
    }
    if (!command.verbs.empty()) {
        text += ".I VERB\n";
    }
    return text + "[\\fIOPTION\\fR...]\n";
}

std::string dashed(std::string name) {
    std::ranges::replace(name, ' ', '-');
    return name;
}

std::string seeAlso(const CliProgram& program, const CliCommand& command) {
    std::vector<std::string> pages;
    if (&command != &program.command) {
        pages.push_back(program.name);
    }
    for (const CliCommand& verb : program.command.verbs) {
        if (verb.name != command.name) {
            pages.push_back(dashed(verb.name));
        }
    }
    pages.emplace_back(program.name == "relief" ? "relief-sim" : "relief");
    std::string text;
    for (std::size_t i = 0; i < pages.size(); ++i) {
        text += ".BR " + escaped(pages[i]) + " (1)" + (i + 1 < pages.size() ? "," : "") + "\n";
    }
    return text;
}

std::string lowerFirst(std::string text) {
    if (!text.empty() && text[0] >= 'A' && text[0] <= 'Z') {
        text[0] = static_cast<char>(text[0] - 'A' + 'a');
    }
    return text;
}

std::string exitCodeEntries() {
    std::string text = ".TP\n.B 0\nsuccess\n";
    for (int code = 1; code <= static_cast<int>(ErrorCode::kDifference); ++code) {
        text += ".TP\n.B " + std::to_string(code) + "\n" +
                escaped(errorCodeName(static_cast<ErrorCode>(code))) + "\n";
    }
    return text + ".TP\n.B 128 + n\nended by signal n\n";
}

}  // namespace

std::string manPage(const CliProgram& program, const CliCommand* verb) {
    const CliCommand& command = verb != nullptr ? *verb : program.command;
    std::string upper = dashed(command.name);
    std::ranges::transform(upper, upper.begin(), [](char c) {
        return c >= 'a' && c <= 'z' ? static_cast<char>(c - 'a' + 'A') : c;
    });
    std::string text = ".TH " + argument(upper) + " 1 \"\" " +
                       argument(program.name + " " + program.version) + " \"Relief manual\"\n.SH NAME\n" +
                       escaped(dashed(command.name)) + " \\- " + escaped(lowerFirst(command.summary)) +
                       "\n.SH SYNOPSIS\n" + synopsis(command);
    text += ".SH DESCRIPTION\n" + escaped(command.summary) + ".\n";
    if (!command.description.empty()) {
        text += ".PP\n" + paragraphs(command.description);
    }
    if (!command.verbs.empty()) {
        text += ".SH VERBS\n";
        for (const CliCommand& one : command.verbs) {
            text += ".TP\n.BR " + escaped(dashed(one.name)) + " (1)\n" + escaped(one.summary) + "\n";
        }
    }
    text += ".SH OPTIONS\n";
    for (const CliOption& option : command.options) {
        text += optionEntry(option);
    }
    text += ".SH EXIT STATUS\n" + exitCodeEntries();
    if (!command.examples.empty()) {
        text += ".SH EXAMPLES\n.nf\n";
        for (const std::string& example : command.examples) {
            text += escaped(example) + "\n";
        }
        text += ".fi\n";
    }
    return text + ".SH SEE ALSO\n" + seeAlso(program, command);
}

}  // namespace relief

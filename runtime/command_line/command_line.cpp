// SPDX-License-Identifier: Apache-2.0
#include "runtime/command_line/command_line.h"

#include <spdlog/sinks/stdout_color_sinks.h>
#include <spdlog/spdlog.h>

#include <CLI/CLI.hpp>
#include <algorithm>
#include <cstdlib>
#include <exception>
#include <new>
#include <span>
#include <sstream>

#include "formats/base/file_io.h"
#include "formats/base/temporary_file.h"
#include "formats/base/text.h"

namespace relief {
namespace {

std::string exitCodes() {
    std::string text = "\nExit codes: 0 success";
    for (int code = 1; code <= static_cast<int>(ErrorCode::kDifference); ++code) {
        text += ", " + std::to_string(code) + " " + errorCodeName(static_cast<ErrorCode>(code));
    }
    return text + "\n";
}

constexpr std::size_t kHelpColumns = 120;

/// Wraps long lines at spaces. Continuation lines of an option are aligned with its description.
/// \param column  column where descriptions of options start.
std::string folded(const std::string& text, std::size_t column) {
    std::string out;
    for (std::string_view line : split(text, '\n')) {
        const std::string indent(line.starts_with("  ") ? column : 0, ' ');
        std::string before;
        while (before.size() + line.size() > kHelpColumns) {
            const std::size_t space = line.rfind(' ', kHelpColumns - before.size());
            // Do not break inside the indentation or the names.
            if (space == std::string_view::npos || before.size() + space <= column) {
                break;
            }
            out.append(before).append(line.substr(0, space)).append("\n");
            line.remove_prefix(space + 1);
            before = indent;
        }
        out.append(before).append(line).append("\n");
    }
    out.pop_back();  // the last line had no newline
    return out;
}

/// Help that starts with the examples: moves the footer of CLI11 to the top.
class ExampleFormatter : public CLI::Formatter {
  public:
    std::string make_help(const CLI::App* app, std::string name, CLI::AppFormatMode mode) const override {
        if (mode == CLI::AppFormatMode::Sub) {
            return Formatter::make_help(app, name, mode);
        }
        const std::string examples = app->get_footer();
        std::string text = "Examples:\n";
        for (const std::string_view line : split(examples, '\n')) {
            text.append("  ").append(line).append("\n");
        }
        return text + "\n" +
               folded(make_description(app) + make_usage(app, name) + make_positionals(app) +
                          make_groups(app, mode) + make_subcommands(app, mode) +
                          (app->get_parent() == nullptr ? exitCodes() : ""),
                      column_width_);
    }
    /// Leaves out "Needs" and "Excludes"; the parser reports them.
    std::string make_option_opts(const CLI::Option* option) const override {
        const std::string text = Formatter::make_option_opts(option);
        return text.substr(0, std::min(text.find(" Needs:"), text.find(" Excludes:")));
    }
    /// Lists verbs with the first line of their descriptions.
    std::string make_subcommand(const CLI::App* sub) const override {
        const std::string description = sub->get_description();
        std::stringstream out;
        CLI::detail::format_help(out, sub->get_name(), description.substr(0, description.find('\n')),
                                 column_width_);
        return out.str();
    }
};

/// Returns the verb that was given, or the program.
const CLI::App& activeApp(const CLI::App& app) {
    const std::vector<CLI::App*> called = app.get_subcommands();
    return called.empty() ? app : *called.front();
}

std::string helpText(const CLI::App& app) {
    const CLI::App& called = activeApp(app);
    return &called == &app ? app.help() : called.help(app.get_name());
}

std::vector<std::string> optionNames(const CLI::App& app) {
    std::vector<std::string> names;
    for (const CLI::Option* option : app.get_options()) {
        names.insert(names.end(), option->get_lnames().begin(), option->get_lnames().end());
    }
    return names;
}

std::vector<std::string> verbNames(const CLI::App& app) {
    std::vector<std::string> names;
    for (const CLI::App* verb : app.get_subcommands([](const CLI::App*) { return true; })) {
        names.push_back(verb->get_name());
    }
    return names;
}

std::string unknownOption(const CLI::App& app, const std::string& word, const std::string& help) {
    const std::size_t start = std::min(word.find_first_not_of('-'), word.size());
    const std::string_view name = std::string_view(word).substr(start);
    const std::vector<std::string> names = optionNames(app);
    const std::vector<std::string_view> known(names.begin(), names.end());
    const std::string guess(nearest(name.substr(0, name.find('=')), known));
    return "unknown option " + cleanUtf8(word) +
           (guess.empty() ? "; " + help : "; did you mean '--" + guess + "'?");
}

std::string noVerb(const CLI::App& app, const std::vector<std::string>& words, const std::string& help) {
    const std::vector<std::string> names = verbNames(app);
    const std::vector<std::string_view> known(names.begin(), names.end());
    if (words.empty()) {
        return "no verb; use one of " + listed(known) + ", or " + help;
    }
    const std::string guess = didYouMean(words.front(), known);
    return "unknown verb '" + cleanUtf8(words.front()) + "'" +
           (guess.empty() ? "; use one of " + listed(known) : guess);
}

/// Returns the message for a command line that CLI11 rejected.
std::string parseErrorMessage(const CLI::App& app, const CLI::ParseError& error) {
    const CLI::App& called = activeApp(app);
    const std::string name = app.get_name() + (&called == &app ? "" : " " + called.get_name());
    const std::string help = "see " + name + " --help";
    if (error.get_name() == "ValidationError") {
        // CLI11 writes "--option: message"; our messages are sentences that start with the option.
        std::string text = error.what();
        if (const std::size_t colon = text.find(": "); colon != std::string::npos) {
            text.replace(colon, 2, " ");
        }
        return text;
    }
    const std::vector<std::string> unknown = called.remaining();
    for (const std::string& word : unknown) {
        if (word.size() > 1 && word[0] == '-') {
            return unknownOption(called, word, help);
        }
    }
    if (&called == &app && !verbNames(app).empty()) {
        return noVerb(app, unknown, help);
    }
    if (!unknown.empty()) {
        return "unexpected argument '" + cleanUtf8(unknown.front()) + "'; " + help;
    }
    return cleanUtf8(error.what()) + "; " + help;
}

/// Rejects empty values, which usually come from unset variables of scripts, unless the value is optional.
Result<void> rejectEmptyValues(const CLI::App& app) {
    for (const CLI::Option* option : app.get_options()) {
        const std::vector<std::string>& words = option->results();
        if (option->get_expected_min() > 0 && std::ranges::find(words, "") != words.end()) {
            return fail(ErrorCode::kUsage,
                        option->get_name() + " has no value; add one, or remove the option");
        }
    }
    return {};
}

void startLog(const std::string& program) {
    auto sink = std::make_shared<spdlog::sinks::stderr_color_sink_mt>();
    if (const char* no_color = std::getenv("NO_COLOR"); no_color != nullptr && *no_color != '\0') {
        sink->set_color_mode(spdlog::color_mode::never);
    }
    auto logger = std::make_shared<spdlog::logger>(program, std::move(sink));
    logger->set_pattern(program + ": %^%l%$: %v");
    spdlog::set_default_logger(std::move(logger));
}

Result<bool> printAnswer(const std::string& text) {
    RELIEF_TRY(printOut(text));
    return false;
}

}  // namespace

void setUpHelp(CLI::App& app, const std::string& help) {
    app.formatter(std::make_shared<ExampleFormatter>());
    app.set_help_flag("-h,--help", help);
    app.set_version_flag("--version", app.get_name() + " " RELIEF_VERSION, "Print the version and exit");
}

void AppDeleter::operator()(CLI::App* app) const {
    delete app;
}

std::unique_ptr<CLI::App, AppDeleter> makeApp(const std::string& name) {
    return std::unique_ptr<CLI::App, AppDeleter>(new CLI::App("", name));
}

void describeApp(CLI::App& app, const std::string& description, const std::string& examples) {
    app.description(description);
    app.footer(examples);
}

void onVerb(CLI::App& verb, std::function<void()> parsed) {
    verb.callback(std::move(parsed));
}

std::vector<GivenOption> givenOptions(const CLI::App& parsed) {
    std::vector<GivenOption> given;
    for (const CLI::Option* option : parsed.get_options()) {
        if (option->count() > 0) {
            given.push_back({option->get_name(), option->get_lnames()});
        }
    }
    return given;
}

Result<bool> parseCommandLine(CLI::App& app, std::vector<std::string> arguments) {
    std::reverse(arguments.begin(), arguments.end());  // CLI11 expects reverse order
    try {
        app.parse(std::move(arguments));
    } catch (const CLI::CallForHelp&) {
        return printAnswer(helpText(app));
    } catch (const CLI::CallForVersion& version) {
        return printAnswer(std::string(version.what()) + "\n");
    } catch (const CLI::ParseError& error) {
        // Print help even if other arguments are invalid.
        const CLI::Option* help = activeApp(app).get_help_ptr();
        if (help != nullptr && help->count() > 0) {
            return printAnswer(helpText(app));
        }
        return fail(ErrorCode::kUsage, parseErrorMessage(app, error));
    }
    RELIEF_TRY(rejectEmptyValues(activeApp(app)));
    return true;
}

std::vector<std::string> argumentsOf(int argc, char** argv) {
    return {argv + std::min(argc, 1), argv + argc};
}

Result<void> printOut(const std::string& text) {
    return writeFile("-", std::as_bytes(std::span(text)));
}

void reportError(const Error& error) {
    spdlog::error(error.message);
}

int runProgram(const std::string& program, const std::function<Result<void>()>& run,
               const Error& out_of_memory) {
    endCleanlyOnSignals();
    startLog(program);
    Error error{ErrorCode::kFailure, ""};
    try {
        const Result<void> done = run();
        if (done) {
            return 0;
        }
        error = done.error();
    } catch (const std::bad_alloc&) {
        error = out_of_memory;
    } catch (const std::exception& thrown) {
        error.message = thrown.what();
    }
    reportError(error);
    return static_cast<int>(error.code);
}

}  // namespace relief

// SPDX-License-Identifier: Apache-2.0
#include "runtime/command_line/command_line.h"

#include <spdlog/sinks/stdout_color_sinks.h>
#include <spdlog/spdlog.h>

#include <CLI/CLI.hpp>
#include <algorithm>
#include <cstdlib>
#include <exception>
#include <new>
#include <optional>
#include <set>
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
constexpr const char* kManualOption = "--manual";
constexpr const char* kNoGroup = "Options";  // CLI11's default

/// Marks where the text that only --manual shows begins in a description.
constexpr char kManualMark = '\f';

/// The indentation of a line's continuation. \param column  where descriptions of options begin
std::size_t indentOf(std::string_view line, std::size_t column) {
    const std::size_t start = line.find_first_not_of(' ');
    const std::size_t end = line.find(' ', start);
    const std::size_t text = line.find_first_not_of(' ', end);
    const bool is_key = start != std::string_view::npos && start >= column &&
                        text != std::string_view::npos && text > end + 1;
    return !line.starts_with("  ") ? 0 : is_key ? text : column;
}

/// Breaks lines at spaces. The description of an option continues in the column of descriptions, and the text of a key
/// ("key      text") in its own column.
/// \param column  where descriptions of options begin
std::string folded(const std::string& text, std::size_t column) {
    std::string out;
    for (std::string_view line : split(text, '\n')) {
        const std::string indent(indentOf(line, column), ' ');
        std::string before;
        while (before.size() + line.size() > kHelpColumns) {
            const std::size_t space = line.rfind(' ', kHelpColumns - before.size());
            // Never breaks within the indentation or the names.
            if (space == std::string_view::npos || before.size() + space <= column) {
                break;
            }
            out.append(before).append(line.substr(0, space)).append("\n");
            line.remove_prefix(space + 1);
            before = indent;
        }
        out.append(before).append(line).append("\n");
    }
    out.pop_back();  // the text had no newline after its last line
    return out;
}

/// Lists the names in alphabetical order: CLI11's set is ordered by address.
std::string namesOf(const std::set<CLI::Option*>& options) {
    std::set<std::string> names;
    for (const CLI::Option* option : options) {
        names.insert(option->get_name());
    }
    return listed(std::vector<std::string_view>(names.begin(), names.end()));
}

/// Help that begins with the examples, which CLI11 stores as the footer.
class HelpFormatter : public CLI::Formatter {
  public:
    /// \param groups  headings, in their order; others follow.
    explicit HelpFormatter(std::vector<std::string> groups = {}) : groups_(std::move(groups)) {
        label("Positionals", "Arguments");
        label("SUBCOMMAND", "VERB");
    }
    void showManual() { manual_ = true; }

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
                          groupsText(*app) + make_subcommands(app, mode) +
                          (app->get_parent() == nullptr ? exitCodes() : manualNote(name)),
                      column_width_);
    }
    std::string make_description(const CLI::App* app) const override {
        const std::string text = shownPart(app->get_description(), "\n\n");
        return text.empty() ? text : text + "\n\n";
    }
    /// In the list of verbs: the first line of the description.
    std::string make_subcommand(const CLI::App* sub) const override {
        const std::string description = sub->get_description();
        std::stringstream out;
        CLI::detail::format_help(out, sub->get_name(), description.substr(0, description.find('\n')),
                                 column_width_);
        return out.str();
    }
    std::string make_option(const CLI::Option* option, bool is_positional) const override {
        return Formatter::make_option(option, is_positional) + (manual_ ? "\n" : "");
    }
    std::string make_option_opts(const CLI::Option* option) const override {
        if (!option->get_option_text().empty()) {
            return " " + option->get_option_text();
        }
        const bool has_type = option->get_type_size() != 0 && !option->get_type_name().empty();
        const bool several = option->get_expected_max() == CLI::detail::expected_max_vector_size;
        return (has_type ? " " + option->get_type_name() : "") + (several ? " ..." : "");
    }
    std::string make_option_desc(const CLI::Option* option) const override {
        std::string text = shownPart(option->get_description(), "\n");
        if (manual_ && !option->get_needs().empty()) {
            text += "\nNeeds " + namesOf(option->get_needs()) + ".";
        }
        if (manual_ && !option->get_excludes().empty()) {
            text += "\nExcludes " + namesOf(option->get_excludes()) + ".";
        }
        return text;
    }

  private:
    [[nodiscard]] std::string shownPart(const std::string& description, const char* gap) const {
        const std::size_t mark = description.find(kManualMark);
        const std::string help = description.substr(0, mark);
        return mark == std::string::npos || !manual_ ? help : help + gap + description.substr(mark + 1);
    }

    [[nodiscard]] std::string groupsText(const CLI::App& app) const {
        std::vector<std::string> groups = groups_;
        for (std::string& group : app.get_groups()) {
            if (std::ranges::find(groups, group) == groups.end()) {
                groups.push_back(std::move(group));
            }
        }
        std::string text;
        for (const std::string& group : groups) {
            const std::vector<const CLI::Option*> options = app.get_options([&](const CLI::Option* option) {
                return option->get_group() == group && option->nonpositional();
            });
            text += group.empty() || options.empty() ? "" : make_group(group, false, options);
        }
        return text;
    }

    /// \param verb  "relief bake"
    [[nodiscard]] std::string manualNote(const std::string& verb) const {
        std::string page = verb;
        std::ranges::replace(page, ' ', '-');
        return manual_
                   ? ""
                   : "\n`" + verb + " --manual` or `man " + page + "` describes every option in detail.\n";
    }

    std::vector<std::string> groups_;
    bool manual_ = false;
};

/// The verb on the command line, or the program if there is none.
const CLI::App& activeApp(const CLI::App& app) {
    const std::vector<CLI::App*> called = app.get_subcommands();
    return called.empty() ? app : *called.front();
}

std::string helpText(const CLI::App& app) {
    const CLI::App& called = activeApp(app);
    return &called == &app ? app.help() : called.help(app.get_name());
}

/// The text that the command line requests by --help or --manual, even if other arguments are wrong.
std::optional<std::string> requestedText(const CLI::App& app) {
    const CLI::App& called = activeApp(app);
    const CLI::Option* const help = called.get_help_ptr();
    if (help != nullptr && help->count() > 0) {
        return helpText(app);
    }
    const CLI::Option* const manual = called.get_option_no_throw(kManualOption);
    const auto formatter = std::dynamic_pointer_cast<HelpFormatter>(called.get_formatter());
    if (manual == nullptr || manual->count() == 0 || formatter == nullptr) {
        return std::nullopt;
    }
    formatter->showManual();
    return helpText(app);
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
        return "no verb given; use one of " + listed(known) + ", or " + help;
    }
    const std::string guess = didYouMean(words.front(), known);
    return "unknown verb '" + cleanUtf8(words.front()) + "'" +
           (guess.empty() ? "; use one of " + listed(known) : guess);
}

/// The message for a command line that CLI11 rejected.
std::string parseErrorMessage(const CLI::App& app, const CLI::ParseError& error) {
    const CLI::App& called = activeApp(app);
    const std::string name = app.get_name() + (&called == &app ? "" : " " + called.get_name());
    const std::string help = "see " + name + " --help";
    if (error.get_name() == "ValidationError") {
        // CLI11 writes "--option: message". Our messages continue the option's name as a sentence.
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

/// Rejects empty values, which usually come from unset variables in scripts. Options with an optional value are not checked.
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
    app.formatter(std::make_shared<HelpFormatter>());
    app.set_help_flag("-h,--help", help);
    app.set_version_flag("--version", app.get_name() + " " RELIEF_VERSION, "Print the version and exit");
}

void setUpVerbHelp(CLI::App& verb) {
    verb.set_help_flag("-h,--help", "Print this help and exit");
    verb.add_flag(kManualOption)->description("Print this help with every detail and exit");
}

std::string withDetails(const std::string& help, const std::string& details) {
    return details.empty() ? help : help + kManualMark + details;
}

void groupOptions(CLI::App& app, const std::vector<OptionGroup>& groups) {
    std::vector<std::string> titles;
    for (const OptionGroup& group : groups) {
        titles.push_back(group.title);
        for (const std::string& name : group.options) {
            CLI::Option* const option = app.get_option_no_throw(name);
            if (option != nullptr && option->get_group() == kNoGroup) {
                option->group(group.title);
            }
        }
    }
    app.formatter(std::make_shared<HelpFormatter>(std::move(titles)));
}

void addDetails(CLI::App& app, const std::string& name, const std::string& details) {
    if (CLI::Option* const option = app.get_option_no_throw(name)) {
        option->description(option->get_description() + details);
    }
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
    std::reverse(arguments.begin(), arguments.end());  // CLI11 expects the reverse order
    try {
        app.parse(std::move(arguments));
    } catch (const CLI::CallForHelp&) {
        return printAnswer(helpText(app));
    } catch (const CLI::CallForVersion& version) {
        return printAnswer(std::string(version.what()) + "\n");
    } catch (const CLI::ParseError& error) {
        if (const std::optional<std::string> text = requestedText(app)) {
            return printAnswer(*text);
        }
        return fail(ErrorCode::kUsage, parseErrorMessage(app, error));
    }
    if (const std::optional<std::string> text = requestedText(app)) {
        return printAnswer(*text);
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

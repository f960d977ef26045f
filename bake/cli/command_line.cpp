#include "bake/cli/command_line.h"

#include <spdlog/sinks/stdout_color_sinks.h>
#include <spdlog/spdlog.h>

#include <algorithm>
#include <cstdlib>
#include <sstream>
#include <vector>

#include "bake/cli/gl_options.h"
#include "bake/cli/response_file.h"
#include "formats/base/text.h"
#include "runtime/tool/cli_model.h"

namespace relief {
namespace {

/// Help that begins with examples (CLI11's footer, moved to the top).
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
        return text + "\n" + make_description(app) + make_usage(app, name) + make_positionals(app) +
               make_groups(app, mode) + make_subcommands(app, mode);
    }
    /// In the list of verbs: the first line of the description.
    std::string make_subcommand(const CLI::App* sub) const override {
        const std::string description = sub->get_description();
        std::stringstream out;
        CLI::detail::format_help(out, sub->get_name(), description.substr(0, description.find('\n')),
                                 column_width_);
        return out.str();
    }
};

void makeLogger() {
    auto sink = std::make_shared<spdlog::sinks::stderr_color_sink_mt>();
    if (const char* no_color = std::getenv("NO_COLOR"); no_color != nullptr && *no_color != '\0') {
        sink->set_color_mode(spdlog::color_mode::never);
    }
    auto logger = std::make_shared<spdlog::logger>("relief", std::move(sink));
    logger->set_pattern("relief: %^%l%$: %v");
    spdlog::set_default_logger(std::move(logger));
}

std::vector<std::string> optionNames(const CLI::App& app) {
    std::vector<std::string> names;
    for (const CLI::Option* option : app.get_options()) {
        for (const std::string& name : option->get_lnames()) {
            names.push_back(name);
        }
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

/// The message for a command line that CLI11 did not take.
std::string parseErrorMessage(const CLI::App& app, const CLI::ParseError& error) {
    const std::vector<CLI::App*> called = app.get_subcommands();
    const CLI::App& verb = called.empty() ? app : *called.front();
    const std::string help =
        "see " + (called.empty() ? std::string("relief") : "relief " + verb.get_name()) + " --help";
    const std::vector<std::string> unknown = verb.remaining();
    for (const std::string& word : unknown) {
        if (word.size() > 1 && word[0] == '-') {
            const std::size_t start = std::min(word.find_first_not_of('-'), word.size());
            const std::string_view name = std::string_view(word).substr(start);
            const std::vector<std::string> names = optionNames(verb);
            const std::vector<std::string_view> known(names.begin(), names.end());
            const std::string guess(nearest(name.substr(0, name.find('=')), known));
            return "unknown option " + cleanUtf8(word) +
                   (guess.empty() ? "; " + help : "; did you mean '--" + guess + "'?");
        }
    }
    if (called.empty()) {
        const std::vector<std::string> names = verbNames(app);
        const std::vector<std::string_view> known(names.begin(), names.end());
        if (unknown.empty()) {
            return "no verb; use one of " + listed(known) + ", or " + help;
        }
        const std::string guess = didYouMean(unknown.front(), known);
        return "unknown verb '" + cleanUtf8(unknown.front()) + "'" +
               (guess.empty() ? "; use one of " + listed(known) : guess);
    }
    if (!unknown.empty()) {
        return "unexpected argument '" + cleanUtf8(unknown.front()) + "'; " + help;
    }
    return cleanUtf8(error.what()) + "; " + help;
}

}  // namespace

Result<void> runCommandLine(int argc, char** argv) {
    makeLogger();
    CLI::App app("Bakes meshes into depth map colliders, and looks into them", "relief");
    app.formatter(std::make_shared<ExampleFormatter>());
    app.footer(
        "relief bake bunny.obj -o bunny.relief\nrelief info bunny.relief\n"
        "relief slice bunny.relief --axis z --at center -o slice.png");
    app.set_help_flag("-h,--help", "Print this help and exit; `relief VERB --help` explains a verb");
    app.set_version_flag("--version", std::string("relief ") + RELIEF_VERSION, "Print the version and exit");
    app.require_subcommand(1);
    Action action;
    addBake(app, action);
    addCheck(app, action);
    addDiff(app, action);
    addInfo(app, action);
    addQuery(app, action);
    addSlice(app, action);
    addExport(app, action);
    if (const auto dumped = dumpedCommandLine(readProgram(app, "relief", RELIEF_VERSION), argc, argv)) {
        return printOut(*dumped);
    }
    std::vector<std::string> arguments =
        RELIEF_TRY(expandArguments(std::vector<std::string>(argv + std::min(argc, 1), argv + argc)));
    std::reverse(arguments.begin(), arguments.end());  // as CLI11 takes them
    try {
        app.parse(std::move(arguments));
    } catch (const CLI::CallForHelp&) {
        const std::vector<CLI::App*> called = app.get_subcommands();
        return printOut(called.empty() ? app.help() : called.front()->help("relief"));
    } catch (const CLI::CallForVersion& version) {
        return printOut(std::string(version.what()) + "\n");
    } catch (const ListDevices& what) {
        return listDevices(what);
    } catch (const CLI::ParseError& error) {
        return fail(ErrorCode::kUsage, parseErrorMessage(app, error));
    }
    return action();
}

int reportError(const Error& error) {
    spdlog::error(error.message);
    return static_cast<int>(error.code);
}

}  // namespace relief

#include "bake/cli/command.h"

#include <spdlog/spdlog.h>

#include <CLI/CLI.hpp>
#include <filesystem>

#include "formats/base/file_io.h"
#include "formats/base/text.h"

namespace relief {

CLI::App& addVerb(CLI::App& app, CommonOptions& common, const std::string& name,
                  const std::string& description, const std::string& example) {
    CLI::App* verb = app.add_subcommand(name, description);
    verb->footer(example);
    verb->set_help_flag("-h,--help", "Print this help and exit");
    CLI::Option* quiet = verb->add_flag("-q,--quiet", common.quiet, "Print errors only");
    CLI::Option* verbose =
        verb->add_flag("-v,--verbose", common.verbose, "Print details too")->excludes(quiet);
    verb->add_flag_callback(
            "--warnings-only",
            [&common] {
                common.quiet = true;
                common.warnings = true;
            },
            "Print warnings and errors only")
        ->excludes(quiet)
        ->excludes(verbose);
    return *verb;
}

void startLogging(const CommonOptions& common) {
    spdlog::set_level(common.warnings  ? spdlog::level::warn
                      : common.quiet   ? spdlog::level::err
                      : common.verbose ? spdlog::level::debug
                                       : spdlog::level::info);
}

std::string shownInput(const std::string& file) {
    return file == "-" ? "standard input" : quotedPath(file);
}

std::string inputName(const std::string& file) {
    return file == "-" ? "standard input" : cleanUtf8(std::filesystem::path(file).filename().string());
}

}  // namespace relief

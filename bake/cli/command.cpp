#include "bake/cli/command.h"

#include <spdlog/spdlog.h>

#include <span>

#include "formats/base/file_io.h"
#include "formats/base/text.h"

namespace relief {

CLI::App& addVerb(CLI::App& app, CommonOptions& common, const std::string& name,
                  const std::string& description, const std::string& example) {
    CLI::App* verb = app.add_subcommand(name, description);
    verb->footer(example);
    verb->set_help_flag("-h,--help", "Print this help and exit");
    CLI::Option* quiet = verb->add_flag("-q,--quiet", common.quiet, "Print errors only");
    verb->add_flag("-v,--verbose", common.verbose, "Print details too")->excludes(quiet);
    return *verb;
}

void startLogging(const CommonOptions& common) {
    spdlog::set_level(common.quiet     ? spdlog::level::err
                      : common.verbose ? spdlog::level::debug
                                       : spdlog::level::info);
}

Result<std::uint64_t> parseCount(const std::string& text, const std::string& what) {
    const std::optional<std::uint64_t> value = parseUnsigned(text);
    if (!value) {
        return fail(ErrorCode::kUsage, what + " is '" + cleanUtf8(text) + "' but must be a whole number");
    }
    return *value;
}

Result<float> parsePercent(const std::string& text, const std::string& what) {
    std::string_view number = trimmed(text);
    if (number.ends_with('%')) {
        number = trimmed(number.substr(0, number.size() - 1));
    }
    const std::optional<float> percent = parseFloat(number);
    if (!percent || *percent < 0.0F) {
        return fail(ErrorCode::kUsage,
                    what + " is '" + cleanUtf8(text) + "' but must be a share in percent, such as 1.5");
    }
    return *percent;
}

Result<void> printOut(const std::string& text) {
    return writeFile("-", std::as_bytes(std::span(text)));
}

}  // namespace relief

#include "bake/cli/import_options.h"

#include <algorithm>

#include "formats/base/byte_count.h"
#include "formats/base/text.h"

namespace relief {
namespace {

constexpr std::uint64_t kMemoryMin = 64'000'000;         // bytes; a little mesh takes less
constexpr std::uint64_t kMemoryMax = 1'000'000'000'000;  // bytes
constexpr std::uint64_t kSecondsMax = 86'400;

struct Parsed {
    ImportOptions options;
    ImportLimits limits;
};

Result<Parsed> parse(const ImportArguments& arguments) {
    Parsed parsed;
    if (!arguments.unit.empty()) {
        if (!metresPer(arguments.unit)) {
            const std::vector<std::string_view> units = lengthUnits();
            return fail(ErrorCode::kUsage, "--unit is '" + cleanUtf8(arguments.unit) +
                                               "' but must be one of " + listed(units) +
                                               didYouMean(arguments.unit, units));
        }
        parsed.options.unit = arguments.unit;
    }
    if (!arguments.up.empty()) {
        const UpAxis up = RELIEF_TRY(parseUpAxis(arguments.up));
        parsed.options.up = up;
    }
    if (!arguments.memory.empty()) {
        const std::optional<std::uint64_t> memory = parseByteCount(arguments.memory);
        if (!memory || *memory < kMemoryMin || *memory > kMemoryMax) {
            return fail(ErrorCode::kUsage, "--import-memory is '" + cleanUtf8(arguments.memory) +
                                               "' but must be 64MB to 1000GB");
        }
        parsed.limits.memory = *memory;
    }
    if (!arguments.seconds.empty()) {
        const std::optional<std::uint64_t> seconds = parseUnsigned(arguments.seconds);
        if (!seconds || *seconds < 1 || *seconds > kSecondsMax) {
            return fail(ErrorCode::kUsage, "--import-time is '" + cleanUtf8(arguments.seconds) +
                                               "' but must be 1 to " + std::to_string(kSecondsMax) +
                                               " seconds");
        }
        parsed.limits.seconds = static_cast<std::uint32_t>(*seconds);
    }
    return parsed;
}

}  // namespace

void addImportOptions(CLI::App& verb, ImportArguments& arguments) {
    const std::vector<std::string_view> units = lengthUnits();
    verb.add_option("--unit", arguments.unit,
                    "Of the mesh's lengths: " + listed(units) + "; they become metres.\n" +
                        "Default: what the file says, or as they are")
        ->option_text("UNIT");
    verb.add_option("--up", arguments.up,
                    "The mesh's axis that points upwards: +x -x +y -y +z -z; it becomes +y.\n"
                    "Default: what the file says, or as it is")
        ->option_text("AXIS");
    verb.add_option("--import-memory", arguments.memory, "Memory that reading the mesh may take; default 4GB")
        ->option_text("BYTES");
    verb.add_option("--import-time", arguments.seconds, "Seconds that reading the mesh may take; default 60")
        ->option_text("SECONDS");
}

Result<void> checkImportArguments(const ImportArguments& arguments) {
    const Result<Parsed> parsed = parse(arguments);
    return parsed ? Result<void>{} : forward(parsed);
}

Result<TriangleMesh> importByArguments(const std::string& path, const ImportArguments& arguments) {
    const Parsed parsed = RELIEF_TRY(parse(arguments));
    return importMeshInWorker(path, parsed.options, parsed.limits);
}

std::string importProvenance(const ImportArguments& arguments) {
    std::string text = arguments.unit.empty() ? "" : " --unit " + arguments.unit;
    if (const Result<UpAxis> up = parseUpAxis(arguments.up); up) {
        text.append(" --up ").append(upAxisName(*up));
    }
    return text;
}

}  // namespace relief

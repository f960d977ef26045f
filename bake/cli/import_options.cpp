#include "bake/cli/import_options.h"

#include <CLI/CLI.hpp>

#include "formats/base/text.h"
#include "runtime/tool/option_values.h"

namespace relief {
namespace {

constexpr std::uint64_t kMemoryMin = 64'000'000;         // bytes; a little mesh takes less
constexpr std::uint64_t kMemoryMax = 1'000'000'000'000;  // bytes
constexpr std::uint64_t kSecondsMax = 86'400;

std::optional<UpAxis> upAxis(const std::string& word) {
    const Result<UpAxis> up = parseUpAxis(word);
    return up ? std::optional(*up) : std::nullopt;
}

}  // namespace

void addImportOptions(CLI::App& verb, ImportSettings& settings) {
    const std::vector<std::string_view> units = lengthUnits();
    verb.add_option("--unit", settings.options.unit,
                    "Of the mesh's lengths: " + listed(units) + "; they become metres.\n" +
                        "Default: what the file says, or as they are")
        ->option_text("UNIT")
        ->check(oneOf(units));
    addParsed(verb, "--up", settings.options.up, upAxis, "one of +x, -x, +y, -y, +z, -z",
              "The mesh's axis that points upwards: +x -x +y -y +z -z; it becomes +y.\n"
              "Default: what the file says, or as it is")
        ->option_text("AXIS");
    verb.add_option("--import-memory", settings.limits.memory,
                    "Memory that reading the mesh may take; default 4GB")
        ->option_text("BYTES")
        ->transform(byteCount(kMemoryMin, kMemoryMax, "64MB to 1000GB"));
    verb.add_option("--import-time", settings.limits.seconds,
                    "Seconds that reading the mesh may take; default 60")
        ->option_text("SECONDS")
        ->transform(wholeNumber(1, kSecondsMax, "1 to " + std::to_string(kSecondsMax) + " seconds"));
    verb.add_option("--max-triangles", settings.limits.triangles,
                    "Triangles that the mesh may have, instances counted one by one; default 20000000")
        ->option_text("N")
        ->transform(wholeNumber(1, kTriangleMax, "1 to " + std::to_string(kTriangleMax) + " triangles"));
}

std::string importProvenance(const ImportOptions& options) {
    return (options.unit.empty() ? "" : " --unit " + options.unit) +
           (options.up ? " --up " + std::string(upAxisName(*options.up)) : "");
}

}  // namespace relief

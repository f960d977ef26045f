// relief-bench CASE [FILE]: prints JSON, times of the runtime's parts on this machine. scripts/bench.py reads it.
#include <CLI/CLI.hpp>
#include <array>

#include "formats/fields/json.h"
#include "runtime/bench/bench.h"
#include "runtime/command_line/command_line.h"
#include "runtime/command_line/option_values.h"
#include "runtime/gl/gl_context.h"
#include "runtime/gl/gl_functions.h"

namespace relief {
namespace {

struct Case {
    std::string_view name;
    const char* file;  ///< that it needs; "": none
    Result<Json> (*run)(const Bench&);
};
constexpr std::array<Case, 7> kCases{{{"step", "COLLIDER.relief", benchStep},
                                      {"picture", "COLLIDER.relief", benchPicture},
                                      {"births", "", benchBirths},
                                      {"sort", "", benchSort},
                                      {"statistics", "", benchStatistics},
                                      {"depth-maps", "MESH (.obj or .ply)", benchDepthMaps},
                                      {"live", "MESH (.obj or .ply)", benchLive}}};

void define(CLI::App& app, std::string& name, BenchOptions& options) {
    setUpHelp(app);
    app.footer("relief-bench step bunny.relief --path compute --particles 1048576");
    std::vector<std::string_view> names;
    for (const Case& one : kCases) {
        names.push_back(one.name);
    }
    app.add_option("CASE", name, "step, picture, births, sort, statistics, depth-maps or live")
        ->required()
        ->transform(oneOf(names));
    app.add_option("FILE", options.file, "The collider of step and picture; the mesh of depth-maps and live");
    const auto whole = [&](const char* option, auto& field, std::uint64_t least, std::uint64_t most,
                           const char* help) {
        return app.add_option(option, field, help)->option_text("N")->transform(wholeNumber(least, most));
    };
    whole("--particles", options.particles, 4, ParticleSystem::kCapacityMax,
          "Particles, a table for each number; for step, a multiple of 1024")
        ->delimiter(',')
        ->allow_extra_args(false);
    whole("--births", options.births, 1, 1U << 24U, "Births a step of births");
    whole("--blocks", options.rounds, 1, 1000, "Rounds of measurements");
    addWords(app, "--path", options.path,
             WordsFor<StepPath>{{"fragment", StepPath::kFragment}, {"compute", StepPath::kCompute}},
             "Of step and picture");
    app.add_option("--only", options.only, "One variant of step, beside those it is compared with");
    app.add_flag("--large", options.large, "Sizes for a GPU, even where there is none");
    app.add_flag("--sorted", options.sorted,
                 "Neighbours in space are neighbours on the GPU, so that the lanes of a warp do the same");
}

Result<void> run(int argc, char** argv) {
    CLI::App app("Times of the runtime's parts, as JSON", "relief-bench");
    std::string name;
    Bench bench;
    define(app, name, bench.options);
    if (!RELIEF_TRY(parseCommandLine(app, argumentsOf(argc, argv)))) {
        return {};
    }
    const Case& chosen =
        *std::find_if(kCases.begin(), kCases.end(), [&](const Case& one) { return one.name == name; });
    if (bench.options.file.empty() != (*chosen.file == '\0')) {
        return fail(ErrorCode::kUsage, *chosen.file == '\0' ? name + " takes no file; leave it out"
                                                            : name + " needs a " + chosen.file);
    }
    const auto context = RELIEF_TRY(GlContext::create());
    bench.software = context->software();
    Json json{{"case", name},
              {"device", context->description()},
              {"renderer", reinterpret_cast<const char*>(glGetString(GL_RENDERER))},
              {"software", bench.software},
              {"path", bench.options.path == StepPath::kCompute ? "compute" : "fragment"}};
    json["tables"] = RELIEF_TRY(chosen.run(bench));
    return printOut(jsonText(json));
}

}  // namespace
}  // namespace relief

int main(int argc, char** argv) {
    return relief::runProgram("relief-bench", [&] { return relief::run(argc, argv); },
                              {relief::ErrorCode::kLimit, "out of memory; choose fewer particles"});
}

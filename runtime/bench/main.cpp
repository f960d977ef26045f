// SPDX-License-Identifier: Apache-2.0
// relief-bench CASE FILE: times parts of the runtime and prints JSON for scripts/bench.py.
#include <CLI/CLI.hpp>

#include "formats/fields/json_value.h"
#include "runtime/bench/bench.h"
#include "runtime/command_line/command_line.h"
#include "runtime/command_line/option_values.h"
#include "runtime/gl/gl_context.h"
#include "runtime/gl/gl_functions.h"

namespace relief {
namespace {

using Case = Result<Json> (*)(const Bench&);
const std::map<std::string_view, Case> kCases{{"step", benchStep},
                                              {"picture", benchPicture},
                                              {"mesh", benchMesh},
                                              {"animated", benchAnimated},
                                              {"stream", benchStream}};

Result<void> run(int argc, char** argv) {
    CLI::App app("Times parts of the runtime, and prints JSON", "relief-bench");
    setUpHelp(app);
    app.footer("relief-bench step bunny.relief --shaders compute --particles 1048576");
    std::string name;
    Bench bench;
    app.add_option("CASE", name, "step, picture, mesh, animated or stream")
        ->required()
        ->transform(CLI::Validator(oneOf(kWords<"step", "picture", "mesh", "animated", "stream">), ""));
    app.add_option(
           "FILE", bench.file,
           "Collider (step, picture), animated collider (animated), .obj or .ply (mesh), world.json (stream)")
        ->required();
    app.add_option("--particles", bench.particles,
                   "Number of particles; a multiple of 1024 for step (default: depends on the case)")
        ->option_text("N")
        ->transform(CLI::Validator(wholeNumber(4, ParticleSystem::kCapacityMax), ""));
    app.add_option("--blocks", bench.rounds, "Number of measurement rounds (default: depends on the case)")
        ->option_text("N")
        ->transform(CLI::Validator(wholeNumber(1, 1000), ""));
    addWords(app, "--shaders", bench.path,
             WordsFor<StepPath>{{"fragment", StepPath::kFragment}, {"compute", StepPath::kCompute}},
             "Shaders of particle steps (default: fragment)");
    app.add_option("--only", bench.only, "Run only one variant of step, and its references");
    app.add_option("--bricks", bench.bricks,
                   "Files written by relief-accuracy --atlas for the same mesh; each adds a variant of step, "
                   "named after the file")
        ->option_text("FILE...");
    app.add_option("--exact", bench.exact,
                   "Mesh of the collider (.obj or .ply); adds two variants of step with exact signed "
                   "distances: exact, and exact_kept, which keeps distances between steps")
        ->option_text("FILE");
    app.add_option("--stream-bytes", bench.stream_bytes, "GPU budget of stream in bytes (default: 134217728)")
        ->option_text("N")
        ->transform(CLI::Validator(wholeNumber(1, std::uint64_t{1} << 33U), ""));
    app.add_flag("--large", bench.large, "Use the sizes for a GPU even on a software renderer");
    if (!RELIEF_TRY(parseCommandLine(app, argumentsOf(argc, argv)))) {
        return {};
    }
    const auto context = RELIEF_TRY(GlContext::create());
    bench.software = context->software();
    Json json{{"case", name},
              {"device", context->description()},
              {"renderer", reinterpret_cast<const char*>(glGetString(GL_RENDERER))},
              {"software", bench.software},
              {"shaders", bench.path == StepPath::kCompute ? "compute" : "fragment"}};
    json["tables"] = RELIEF_TRY(kCases.at(name)(bench));
    return printOut(jsonText(json));
}

}  // namespace
}  // namespace relief

int main(int argc, char** argv) {
    return relief::runProgram("relief-bench", [&] { return relief::run(argc, argv); },
                              {relief::ErrorCode::kLimit, "out of memory; choose fewer particles"});
}

// relief query: the field at points, by the CPU or by the simulation's own shader.
#include <spdlog/spdlog.h>
#include <tbb/parallel_for.h>

#include <CLI/CLI.hpp>
#include <algorithm>

#include "bake/cli/command.h"
#include "bake/cli/gl_options.h"
#include "bake/cli/preflight.h"
#include "bake/report/points_csv.h"
#include "formats/base/file_io.h"
#include "formats/container.h"
#include "runtime/collider/field_query.h"

namespace relief {
namespace {

constexpr std::size_t kPointsAtOnce = std::size_t{1} << 20;  // between two feedings of the watchdog

struct QueryCommand {
    CommonOptions common;
    std::string file;
    std::string points;
    std::string output;
    bool gpu = false;
    GpuOptions gpu_options;
};

std::vector<FieldSample> evaluateOnCpu(const Collider& collider, std::span<const glm::vec3> points) {
    std::vector<FieldSample> samples(points.size());
    tbb::parallel_for(std::size_t{0}, points.size(),
                      [&](std::size_t i) { samples[i] = evaluate(collider, points[i]); });
    return samples;
}

Result<std::vector<FieldSample>> evaluateOnGpu(const Collider& collider, std::span<const glm::vec3> points,
                                               const GpuOptions& options) {
    const WatchedContext gl = RELIEF_TRY(openGl(options));
    spdlog::debug("{}", gl.context->description());
    gl.watchdog->feed("uploading the collider");
    const FieldQuery query = RELIEF_TRY(FieldQuery::create(collider));
    std::vector<FieldSample> samples;
    samples.reserve(points.size());
    for (std::size_t first = 0; first < points.size(); first += kPointsAtOnce) {
        const std::span<const glm::vec3> some =
            points.subspan(first, std::min(kPointsAtOnce, points.size() - first));
        gl.watchdog->feed("points " + std::to_string(first + 1) + " to " +
                          std::to_string(first + some.size()));
        const std::vector<FieldSample> evaluated = RELIEF_TRY(query.evaluate(some));
        samples.insert(samples.end(), evaluated.begin(), evaluated.end());
    }
    gl.watchdog->rest();
    return samples;
}

Result<void> runQuery(const QueryCommand& command) {
    startLogging(command.common);
    if (!command.gpu) {
        RELIEF_TRY(refuseGpuOptions(command.gpu_options, "--gpu"));
    }
    if (command.file == "-" && command.points == "-") {
        return fail(ErrorCode::kUsage,
                    "FILE and --points cannot both be standard input; give one of them a file");
    }
    RELIEF_TRY(preflightFile(command.output));
    RELIEF_TRY(preflightDistinct(command.file, command.output));
    RELIEF_TRY(preflightDistinct(command.points, command.output));
    const Collider collider = RELIEF_TRY(loadCollider(command.file));
    const std::vector<std::byte> text = RELIEF_TRY(readFile(command.points));
    const std::vector<glm::vec3> points =
        RELIEF_TRY(parsePoints({reinterpret_cast<const char*>(text.data()), text.size()},
                               command.points == "-" ? "standard input" : command.points));
    const std::vector<FieldSample> samples = RELIEF_TRY(
        command.gpu ? evaluateOnGpu(collider, points, command.gpu_options) : evaluateOnCpu(collider, points));
    const std::string csv = formatSamples(points, samples);
    return writeFile(command.output, std::as_bytes(std::span(csv)));
}

}  // namespace

void addQuery(CLI::App& app, Action& action) {
    auto command = std::make_shared<QueryCommand>();
    CLI::App& verb =
        addVerb(app, command->common, "query",
                "Evaluates the field at points\n\nA line of the output is x,y,z,f,nx,ny,nz,map: signed "
                "distance, normal, deciding map. f is "
                "negative inside,\ninf where a point is outside and no more is known, and empty where no map "
                "votes",
                "relief query bunny.relief --points in.csv -o out.csv\n"
                "echo 0,0.1,0 | relief query bunny.relief --points - -o - --gpu");
    verb.add_option("FILE", command->file, "The collider; - for standard input")->type_name("")->required();
    verb.add_option("--points", command->points, "Lines x,y,z in object space; - for standard input")
        ->option_text("IN.csv")
        ->required();
    verb.add_option("-o,--output", command->output, "The samples; - for standard output")
        ->option_text("OUT.csv")
        ->required();
    verb.add_flag("--gpu", command->gpu,
                  "Evaluate with the simulation's shader (OpenGL 3.3; llvmpipe will do)");
    addGpuOptions(verb, command->gpu_options);
    verb.callback([command, &action] { action = [command] { return runQuery(*command); }; });
}

}  // namespace relief

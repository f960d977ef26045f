// relief query: the field at points, by the CPU or by the simulation's own shader.
#include <spdlog/spdlog.h>
#include <tbb/parallel_for.h>

#include "bake/command.h"
#include "bake/points_csv.h"
#include "bake/preflight.h"
#include "formats/container.h"
#include "formats/file_io.h"
#include "runtime/field_query.h"
#include "runtime/gl_context.h"

namespace relief {
namespace {

struct QueryCommand {
    CommonOptions common;
    std::string file;
    std::string points;
    std::string output;
    bool gpu = false;
};

std::vector<FieldSample> evaluateOnCpu(const Collider& collider, std::span<const glm::vec3> points) {
    std::vector<FieldSample> samples(points.size());
    tbb::parallel_for(std::size_t{0}, points.size(),
                      [&](std::size_t i) { samples[i] = evaluate(collider, points[i]); });
    return samples;
}

Result<std::vector<FieldSample>> evaluateOnGpu(const Collider& collider, std::span<const glm::vec3> points) {
    const Result<std::unique_ptr<GlContext>> context = GlContext::create();
    if (!context) {
        return forward(context);
    }
    spdlog::debug("{}", (*context)->description());
    const Result<FieldQuery> query = FieldQuery::create(collider);
    if (!query) {
        return forward(query);
    }
    return query->evaluate(points);
}

Result<void> runQuery(const QueryCommand& command) {
    startLogging(command.common);
    if (command.file == "-" && command.points == "-") {
        return fail(ErrorCode::kUsage,
                    "FILE and --points cannot both be standard input; give one of them a file");
    }
    for (const Result<void>& ready :
         {preflightFile(command.output), preflightDistinct(command.file, command.output),
          preflightDistinct(command.points, command.output)}) {
        if (!ready) {
            return ready;
        }
    }
    const Result<Collider> collider = loadCollider(command.file);
    if (!collider) {
        return forward(collider);
    }
    const Result<std::vector<std::byte>> text = readFile(command.points);
    if (!text) {
        return forward(text);
    }
    const Result<std::vector<glm::vec3>> points =
        parsePoints({reinterpret_cast<const char*>(text->data()), text->size()},
                    command.points == "-" ? "standard input" : command.points);
    if (!points) {
        return forward(points);
    }
    const Result<std::vector<FieldSample>> samples =
        command.gpu ? evaluateOnGpu(*collider, *points) : evaluateOnCpu(*collider, *points);
    if (!samples) {
        return forward(samples);
    }
    const std::string csv = formatSamples(*points, *samples);
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
    verb.callback([command, &action] { action = [command] { return runQuery(*command); }; });
}

}  // namespace relief

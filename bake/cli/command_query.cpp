// SPDX-License-Identifier: Apache-2.0
// relief query: evaluates the field at points.
#include <tbb/parallel_for.h>

#include <optional>

#include "bake/cli/command.h"
#include "bake/cli/option_details.h"
#include "bake/report/points_csv.h"
#include "formats/base/file_io.h"
#include "formats/base/text.h"
#include "formats/container.h"
#include "formats/nearest_surface.h"
#include "formats/world/world_field.h"
#include "runtime/command_line/command_line.h"
#include "runtime/command_line/option_values.h"

namespace relief {
namespace {

enum class DistanceTo : std::uint8_t { kNearest, kPlane };

struct QueryCommand {
    CommonOptions common;
    std::string file;
    std::string points;
    ContainerLimits limits;
    std::string output;
    std::optional<DistanceTo> distance;
};

/// Returns sample_at(p) for each point.
template <class SampleAt>
std::vector<FieldSample> sampled(std::span<const glm::vec3> points, const SampleAt& sample_at) {
    std::vector<FieldSample> samples(points.size());
    tbb::parallel_for(std::size_t{0}, points.size(),
                      [&](std::size_t i) { samples[i] = sample_at(points[i]); });
    return samples;
}

/// Samples a world; FieldSample::map is the body.
Result<std::vector<FieldSample>> sampledWorld(const QueryCommand& command, std::span<const glm::vec3> points,
                                              FileGuard& files) {
    if (command.distance == DistanceTo::kNearest) {
        return fail(
            ErrorCode::kUsage,
            quotedPath(command.file) +
                " is a world, which supports only --distance plane; use it, or query one of its colliders");
    }
    const WorldField field(RELIEF_TRY(loadWorld(command.file, command.limits)));
    const std::filesystem::path folder = std::filesystem::path(command.file).parent_path();
    for (const WorldCollider& collider : field.world().colliders) {
        RELIEF_TRY(files.reads(folder / collider.file));
        RELIEF_TRY(files.reads(collider.coarse ? folder / collider.coarse->file : std::filesystem::path()));
    }
    return sampled(points, [&](const glm::vec3& p) {
        const WorldSample sample = field.evaluate(p);
        return FieldSample{sample.distance, sample.normal, sample.body};
    });
}

Result<void> runQuery(const QueryCommand& command, FileGuard& files) {
    if (command.file == "-" && command.points == "-") {
        return fail(ErrorCode::kUsage,
                    "FILE and --points cannot both be standard input; name a file for one");
    }
    RELIEF_TRY(files.reads(command.file));
    RELIEF_TRY(files.reads(command.points));
    RELIEF_TRY(files.writes(command.output, "-o"));
    const bool world = isWorldFile(command.file);
    const Collider collider = world ? Collider() : RELIEF_TRY(loadCollider(command.file, command.limits));
    const std::vector<std::byte> text = RELIEF_TRY(readFile(command.points));
    const std::vector<glm::vec3> points =
        RELIEF_TRY(parsePoints(textOf(text), command.points == "-" ? "standard input" : command.points));
    const auto at = [&](const glm::vec3& p) {
        if (command.distance == DistanceTo::kPlane) {
            return evaluate(collider, p);
        }
        const SurfaceSample nearest = nearestSurface(collider, p);
        return FieldSample{nearest.distance, nearest.normal, nearest.map};
    };
    const std::vector<FieldSample> samples =
        world ? RELIEF_TRY(sampledWorld(command, points, files)) : sampled(points, at);
    return writeText(command.output, formatSamples(points, samples, world ? "body" : "map"));
}

}  // namespace

void addQuery(CLI::App& app, Action& action) {
    auto command = std::make_shared<QueryCommand>();
    CLI::App& verb = addVerb(
        app, command->common, "query",
        withDetails(
            "Evaluate a collider's field at points\n\n"
            "Each output line is x,y,z,f,nx,ny,nz,map: the signed distance f to the nearest surface, its "
            "normal, and its map. f is negative inside, inf outside at an unknown distance, and empty if no "
            "map votes.",
            "With --distance plane, f and the normal belong to the plane that decides the side; the side is "
            "the same.\n"
            "A world always uses --distance plane; the last column is the body."),
        "relief query bunny.relief --points in.csv -o out.csv\n"
        "echo 0,0.1,0 | relief query bunny.relief --points - -o - --distance plane");
    addOption(verb, "FILE", command->file, "Collider or world.json; - for a collider on standard input")
        ->typeName("")
        ->required();
    addOption(verb, "--points", command->points,
              "Points to evaluate, one x,y,z per line, in object space; - for standard input (required)")
        ->valueText("IN.csv")
        ->required();
    addOption(verb, "-o,--output", command->output, "Output file; - for standard output (required)")
        ->valueText("OUT.csv")
        ->required();
    addWords(
        verb, "--distance", command->distance,
        WordsFor<DistanceTo>{{"nearest", DistanceTo::kNearest}, {"plane", DistanceTo::kPlane}},
        "Distance to the nearest surface, or to the plane with which particles collide (default: nearest)");
    addMemoryOption(verb, command->limits);
    groupVerbOptions(verb, {{"Input and output", {"--points", "--output", "--distance"}}});
    setAction(verb, action, [command](FileGuard& files) { return runQuery(*command, files); });
}

}  // namespace relief

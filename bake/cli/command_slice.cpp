// SPDX-License-Identifier: Apache-2.0
// relief slice: draws the field on a plane, as a figure or as distances.
#include <spdlog/spdlog.h>

#include <algorithm>

#include "bake/cli/command.h"
#include "bake/cli/option_details.h"
#include "bake/images/slice.h"
#include "formats/base/file_io.h"
#include "formats/base/text.h"
#include "formats/container.h"
#include "runtime/command_line/command_line.h"
#include "runtime/command_line/option_values.h"

namespace relief {
namespace {

struct SliceCommand {
    CommonOptions common;
    std::string file;
    std::string output;
    ContainerLimits limits;
    SliceOptions options;  ///< without the size
    std::uint64_t size = 512;
};

/// Warns about a plane outside the bounds. The picture still shows the field there.
void warnOutside(const SliceCommand& command, const Collider& collider) {
    const std::optional<float>& at = command.options.at;
    const int axis = command.options.axis;
    const float low = collider.bounds.min[axis];
    const float high = collider.bounds.max[axis];
    if (at && !(*at >= low && *at <= high)) {
        spdlog::warn(
            "{}: --at {} is outside the collider's bounds, {} = {} to {}{}; use a number between them, or "
            "center",
            inputText(command.file), shortest(*at), axisName(axis), shortest(low), shortest(high),
            collider.unit.empty() ? "" : " " + collider.unit);
    }
}

Result<void> runSlice(const SliceCommand& command, FileGuard& files) {
    SliceOptions options = command.options;
    options.size = static_cast<std::uint32_t>(std::min<std::uint64_t>(command.size, kSliceSizeMax + 1));
    const std::string extension = lowerCase(std::filesystem::path(command.output).extension().string());
    if (extension != ".png" && extension != ".exr" && command.output != "-") {
        return fail(ErrorCode::kUsage,
                    "--output " + quotedPath(command.output) + " must end in .png or .exr; rename it");
    }
    RELIEF_TRY(files.reads(command.file));
    RELIEF_TRY(files.writes(command.output, "-o"));
    const Collider collider = RELIEF_TRY(loadCollider(command.file, command.limits));
    warnOutside(command, collider);
    const Slice slice = RELIEF_TRY(evaluateSlice(collider, options));
    const std::vector<std::byte> bytes =
        RELIEF_TRY(extension == ".exr" ? encodeExr(distanceImage(slice, collider))
                                       : drawSlice(slice, {inputName(command.file), collider.unit}));
    return writeFile(command.output, bytes);
}

}  // namespace

void addSlice(CLI::App& app, Action& action) {
    auto command = std::make_shared<SliceCommand>();
    CLI::App& verb = addVerb(app, command->common, "slice",
                             withDetails("Draw the signed distance on a plane through a collider\n\n"
                                         "OUT.png is a figure in false colours. OUT.exr stores the distances "
                                         "in object units: negative inside, +inf outside at an unknown "
                                         "distance, NaN if no map votes.",
                                         "The EXR channel is distance, of 32-bit floats. The axes to the "
                                         "right and upwards are z and y for --axis x, x and z for --axis y, "
                                         "and x and y for --axis z."),
                             "relief slice bunny.relief --axis z --at center -o slice.png\n"
                             "relief slice bunny.relief --axis y --at 0.1 --size 1024 -o slice.exr");
    addOption(verb, "FILE", command->file, "Collider; - for standard input")->typeName("")->required();
    addWords(verb, "--axis", command->options.axis, WordsFor<int>{{"x", 0}, {"y", 1}, {"z", 2}},
             "Axis perpendicular to the plane (default: z)");
    addCustomOption(
        verb, "--at",
        [&at = command->options.at](const std::string& word) {
            at = parseFloat(word);
            return at || word == "center";
        },
        "a number or center",
        "Position of the plane along the axis, in object units, or center (default: center of the bounds)")
        ->valueText("V");
    addOption(verb, "--size", command->size, "Samples along the longer side (default: 512)")
        ->valueText("N")
        ->transform(wholeNumber());
    addOption(verb, "-o,--output", command->output,
              "Image to write, .png or .exr; - for standard output, as PNG (required)")
        ->valueText("OUT")
        ->required();
    addMemoryOption(verb, command->limits);
    groupVerbOptions(verb, {{"Output", {"--output", "--size"}}, {"Plane", {"--axis", "--at"}}});
    setAction(verb, action, [command](FileGuard& files) { return runSlice(*command, files); });
}

}  // namespace relief

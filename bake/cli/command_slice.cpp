// SPDX-License-Identifier: Apache-2.0
// relief slice: the field on a plane, as a figure or as its distances.
#include <spdlog/spdlog.h>

#include <algorithm>

#include "bake/cli/command.h"
#include "bake/images/slice.h"
#include "formats/base/file_io.h"
#include "formats/base/text.h"
#include "formats/container.h"
#include "runtime/command_line/command_line.h"
#include "runtime/command_line/option_values.h"

namespace relief {
namespace {

enum class Axis : std::uint8_t { kX, kY, kZ };

/// Where on the axis.
struct Place {
    std::optional<float> at;  // object units; none for "center"
};

struct SliceCommand {
    CommonOptions common;
    std::string file;
    std::string output;
    ContainerLimits limits;
    Axis axis = Axis::kZ;
    std::optional<Place> place;
    std::uint64_t size = 512;
};

std::optional<Place> parsePlace(const std::string& word) {
    const Place place{parseFloat(word)};
    return place.at || word == "center" ? std::optional(place) : std::nullopt;
}

SliceOptions optionsOf(const SliceCommand& command) {
    SliceOptions options;
    options.axis = static_cast<int>(command.axis);
    options.at = command.place.value_or(Place{}).at;
    options.size = static_cast<std::uint32_t>(std::min<std::uint64_t>(command.size, kSliceSizeMax + 1));
    return options;
}

/// The picture is drawn all the same: it shows the field there.
void warnOutside(const SliceCommand& command, const Collider& collider) {
    const std::optional<float> at = optionsOf(command).at;
    const int axis = static_cast<int>(command.axis);
    const float low = collider.bounds.min[axis];
    const float high = collider.bounds.max[axis];
    if (at && !(*at >= low && *at <= high)) {
        spdlog::warn(
            "{}: --at {} lies outside of the collider's box, which goes from {} = {} to {}{}; give a "
            "number between them, or center",
            shownInput(command.file), shortest(*at), axisName(axis), shortest(low), shortest(high),
            collider.unit.empty() ? "" : " " + collider.unit);
    }
}

Result<void> runSlice(const SliceCommand& command, FileGuard& files) {
    const std::string extension = lowerCase(std::filesystem::path(command.output).extension().string());
    if (extension != ".png" && extension != ".exr" && command.output != "-") {
        return fail(ErrorCode::kUsage,
                    "--output " + quotedPath(command.output) + " must end in .png or .exr");
    }
    RELIEF_TRY(files.reads(command.file));
    RELIEF_TRY(files.writes(command.output, "-o"));
    const Collider collider = RELIEF_TRY(loadCollider(command.file, command.limits));
    warnOutside(command, collider);
    const Slice slice = RELIEF_TRY(evaluateSlice(collider, optionsOf(command)));
    const std::vector<std::byte> bytes =
        RELIEF_TRY(extension == ".exr" ? encodeExr(distanceImage(slice, collider))
                                       : drawSlice(slice, {inputName(command.file), collider.unit}));
    return writeFile(command.output, bytes);
}

}  // namespace

void addSlice(CLI::App& app, Action& action) {
    auto command = std::make_shared<SliceCommand>();
    CLI::App& verb = addVerb(
        app, command->common, "slice",
        "Draws the field on a plane: the distance in false colours, or as numbers\n\n"
        "OUT.png is a figure. OUT.exr holds the same signed distances, in object units, as 32-bit floats in\n"
        "the channel distance: negative inside, +inf outside if no distance is known, NaN if no map votes.\n"
        "The axes to the right and upwards are z and y across x, x and z across y, x and y across z",
        "relief slice bunny.relief --axis z --at center -o slice.png\n"
        "relief slice bunny.relief --axis y --at 0.1 --size 1024 -o slice.exr");
    addOption(verb, "FILE", command->file, "The collider; - for standard input")->typeName("")->required();
    addWords(verb, "--axis", command->axis, WordsFor<Axis>{{"x", Axis::kX}, {"y", Axis::kY}, {"z", Axis::kZ}},
             "The plane is across this axis; default z");
    addParsed(verb, "--at", command->place, parsePlace, "a number or center",
              "Where on the axis, object units; default center, the middle of the bounds")
        ->valueText("V");
    addOption(verb, "--size", command->size, "Samples along the longer side; default 512")
        ->valueText("N")
        ->transform(wholeNumber());
    addOption(verb, "-o,--output", command->output, "The image: .png or .exr; - for standard output, as PNG")
        ->valueText("OUT")
        ->required();
    addMemoryOption(verb, command->limits);
    onVerb(verb, [command, &action] {
        action = [command](FileGuard& files) { return runSlice(*command, files); };
    });
}

}  // namespace relief

// relief slice: the field on a plane, as numbers or as a figure.
#include <algorithm>

#include "bake/cli/command.h"
#include "bake/cli/preflight.h"
#include "bake/picture/slice.h"
#include "bake/picture/slice_image.h"
#include "formats/base/file_io.h"
#include "formats/base/text.h"
#include "formats/container.h"

namespace relief {
namespace {

struct SliceCommand {
    CommonOptions common;
    std::string file;
    std::string output;
    std::string axis = "z";
    std::string at = "center";
    std::string size = "512";
};

enum class ImageKind { kPng, kExr };

Result<ImageKind> imageKind(const std::string& output) {
    const std::string extension = lowerCase(std::filesystem::path(output).extension().string());
    if (extension == ".png" || output == "-") {
        return ImageKind::kPng;
    }
    if (extension == ".exr") {
        return ImageKind::kExr;
    }
    return fail(ErrorCode::kUsage, "--output " + quotedPath(output) + " must end in .png or .exr");
}

Result<SliceOptions> optionsOf(const SliceCommand& command) {
    SliceOptions options;
    if (command.axis != "x" && command.axis != "y" && command.axis != "z") {
        return fail(ErrorCode::kUsage, "--axis is '" + cleanUtf8(command.axis) + "' but must be x, y or z");
    }
    options.axis = command.axis[0] - 'x';
    if (command.at != "center") {
        options.at = parseFloat(command.at);
        if (!options.at) {
            return fail(ErrorCode::kUsage,
                        "--at is '" + cleanUtf8(command.at) + "' but must be a number or center");
        }
    }
    const std::uint64_t size = RELIEF_TRY(parseCount(command.size, "--size"));
    options.size = static_cast<std::uint32_t>(std::min<std::uint64_t>(size, kSliceSizeMax + 1));
    return options;
}

Result<void> runSlice(const SliceCommand& command) {
    startLogging(command.common);
    const ImageKind kind = RELIEF_TRY(imageKind(command.output));
    const SliceOptions options = RELIEF_TRY(optionsOf(command));
    RELIEF_TRY(preflightFile(command.output));
    const Collider collider = RELIEF_TRY(loadCollider(command.file));
    const Slice slice = RELIEF_TRY(evaluateSlice(collider, options));
    const std::string name = command.file == "-"
                                 ? "standard input"
                                 : cleanUtf8(std::filesystem::path(command.file).filename().string());
    const std::vector<std::byte> bytes =
        RELIEF_TRY(kind == ImageKind::kPng ? drawSlice(slice, {name, collider.unit})
                                           : encodeExr(sliceImage(slice, collider.unit)));
    return writeFile(command.output, bytes);
}

}  // namespace

void addSlice(CLI::App& app, Action& action) {
    auto command = std::make_shared<SliceCommand>();
    CLI::App& verb =
        addVerb(app, command->common, "slice",
                "Draws the field on a plane\n\nPNG: inside and outside beside the distance in false "
                "colours.\nEXR: channels distance, inside, map, N.X N.Y N.Z",
                "relief slice bunny.relief --axis z --at center -o slice.png\n"
                "relief slice bunny.relief --axis y --at 0.1 --size 1024 -o slice.exr");
    verb.add_option("FILE", command->file, "The collider; - for standard input")->type_name("")->required();
    verb.add_option("--axis", command->axis, "The plane is across this axis; default z")
        ->option_text("x|y|z");
    verb.add_option("--at", command->at,
                    "Where on the axis, object units; default center, the middle of the bounds")
        ->option_text("V");
    verb.add_option("--size", command->size, "Samples along the longer side; default 512")->option_text("N");
    verb.add_option("-o,--output", command->output, "OUT.png or OUT.exr; - for a PNG on standard output")
        ->option_text("OUT")
        ->required();
    verb.callback([command, &action] { action = [command] { return runSlice(*command); }; });
}

}  // namespace relief

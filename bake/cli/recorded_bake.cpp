#include "bake/cli/recorded_bake.h"

#include <algorithm>
#include <string_view>
#include <utility>

#include "bake/cli/bake_settings.h"
#include "bake/repair/mesh_care.h"
#include "formats/base/file_io.h"
#include "formats/base/text.h"

namespace relief {
namespace {

/// A wrap finer than this takes minutes.
constexpr float kWrapAlphaLeast = 0.005F;

bool isPlain(std::string_view word) {
    constexpr std::string_view kPlain =
        "abcdefghijklmnopqrstuvwxyzABCDEFGHIJKLMNOPQRSTUVWXYZ0123456789._=+/:,%-";
    return !word.empty() && word.size() <= 200 && word.find_first_not_of(kPlain) == std::string_view::npos;
}

/// A word as a shell reads it back.
std::string quoted(const std::string& word) {
    if (isPlain(word)) {
        return word;
    }
    std::string text = "'";
    for (const char c : cleanUtf8(word)) {
        text += c == '\'' ? std::string("'\\''") : std::string(1, c);
    }
    return text + "'";
}

/// \return whether the option is known, and its value one that it can have.
bool take(std::string_view option, std::string_view value, RecordedBake& bake) {
    if (option == "--map") {
        const Result<MapSpec> spec = parseMapSpec(value);
        if (spec) {
            bake.maps.push_back(*spec);
        }
        return spec.has_value();
    }
    if (option == "--quality") {
        for (const Quality quality : {Quality::kFast, Quality::kNormal, Quality::kBest}) {
            if (value == qualityName(quality)) {
                bake.quality = quality;
                return true;
            }
        }
        return false;
    }
    if (option == "--prefer") {
        for (const Prefer prefer : {Prefer::kNeither, Prefer::kInside, Prefer::kOutside}) {
            if (value == preferName(prefer)) {
                bake.prefer = prefer;
                return true;
            }
        }
        return false;
    }
    if (option == "--holes") {
        bake.keeps_holes = value == "keep";
        return true;
    }
    if (option == "--repair") {
        bake.repair = value;
        return checkMeshCare({.repair = bake.repair}).has_value();
    }
    if (option == "--as" || option == "--thickness") {
        return readRecordedShape(option, value, bake.shape);
    }
    // Those of the import are read from the command line of the check; planned maps need no backend, and what is baked
    // next has a budget of its own.
    return option == "--budget" || option == "--unit" || option == "--up" || option == "--backend";
}

}  // namespace

RecordedBake recordedBake(const std::string& options) {
    RecordedBake bake;
    std::string_view rest = options;
    for (std::string_view option = takeWord(rest); !option.empty(); option = takeWord(rest)) {
        const std::string_view value = takeWord(rest);
        const bool is_named = option == "--as" && value.find('=') != std::string_view::npos;
        if (is_named && take(option, value, bake)) {
            const NamedShape& named = bake.shape.named.back();
            bake.options.emplace_back(option, quoted(named.name + "=" + std::string(shapeAsName(named.as))));
            continue;
        }
        if (is_named || !isPlain(option) || !isPlain(value)) {
            bake.understood = false;
            continue;
        }
        bake.understood = take(option, value, bake) && bake.understood;
        const bool is_default = option == "--quality" && bake.quality == Quality::kNormal;
        // A default thickness follows the budget of the next bake.
        const bool by_part = option == "--thickness" && bake.shape.thickness_by_part;
        if (option != "--map" && option != "--budget" && option != "--backend" && !is_default && !by_part) {
            bake.options.emplace_back(option, value);
        }
    }
    return bake;
}

std::string RecordedBake::words(std::string_view without) const {
    std::string text;
    for (const auto& [option, value] : options) {
        if (option != without) {
            text.append(" ").append(option).append(" ").append(value);
        }
    }
    return text;
}

Result<ShapedMesh> shapedMesh(const RecordedBake& recorded, const PreparedMesh& mesh) {
    if (recorded.keeps_holes) {
        return ShapedMesh{mesh, {}, surfacePartsOf(mesh)};
    }
    ShapeOptions options = recorded.shape;
    if (!(options.thickness > 0.0)) {
        options.thickness = defaultThickness(mesh->bounds, kBudgetDefault);
        options.thickness_by_part = true;
    }
    return shapeMesh(mesh, options);
}

Result<ShapedMesh> repairedMesh(const RecordedBake& recorded, const PreparedMesh& mesh) {
    const std::size_t equals = recorded.repair.find('=');
    if (equals != std::string::npos &&
        parseFloat(std::string_view(recorded.repair).substr(equals + 1)).value_or(0.0F) < kWrapAlphaLeast) {
        return fail(ErrorCode::kUnsupported, "--repair " + recorded.repair + " takes long");
    }
    const CaredMesh cared = RELIEF_TRY(careFor(mesh, {.repair = recorded.repair, .report = false}));
    return shapedMesh(recorded, cared.mesh);
}

std::string shellWord(const std::string& path) {
    return quoted(path.starts_with("-") ? "./" + path : path);  // else it is taken for an option
}

}  // namespace relief

// SPDX-License-Identifier: Apache-2.0
#include "bake/shape/shape_options.h"

#include <algorithm>
#include <cmath>

#include "bake/mesh/mesh.h"
#include "formats/base/text.h"

namespace relief {
namespace {

constexpr const auto& kAsNames = kWordsOf<ShapeAs>;
/// Prefix of a default thickness that each part adapts.
constexpr std::string_view kByPart = "auto=";

constexpr double kShellMin = 0.004;
constexpr double kShellMax = 0.25;
constexpr double kShellRight = 0.1;
constexpr double kThicknessMin = 1e-4;
/// Resolution of floats at the far end of a mesh's box, in units of its longest side.
constexpr double kThicknessFloat = 4e-6;

}  // namespace

bool parseText(std::string_view word, Thickness& thickness) {
    thickness.by_part = word.starts_with(kByPart);
    const std::optional<float> length = parseFloat(word.substr(thickness.by_part ? kByPart.size() : 0));
    thickness.length = double{length.value_or(0.0F)};
    return length && *length >= 1e-15F && *length <= 1e15F;
}

std::string fieldText(const Thickness& thickness) {
    return std::string(thickness.by_part ? kByPart : "") + shortest(static_cast<float>(thickness.length));
}

std::vector<std::string> ShapeOptions::names() const {
    std::vector<std::string> names;
    for (const NamedShape& shape : named) {
        names.push_back(shape.name);
    }
    return names;
}

Result<ShapeOptions> parseShapeOptions(const std::vector<std::string>& words) {
    ShapeOptions options;
    bool has_default = false;
    for (const std::string& word : words) {
        const std::size_t equals = word.rfind('=');
        const bool is_named = equals != std::string::npos;
        const std::string kind = is_named ? word.substr(equals + 1) : word;
        // Cleaned like names in the file, so that names from an error message can be typed.
        const std::string name = cleanUtf8(word.substr(0, is_named ? equals : 0));
        const std::optional<ShapeAs> as = fromWord<ShapeAs>(kind);
        const auto wrong = [&](const std::string& why) {
            return fail(ErrorCode::kUsage,
                        "--as is '" + cleanUtf8(word, 2 * kSelectedNameBytesMax) + "' but " + why);
        };
        if (!as) {
            return wrong((is_named ? "the kind after the last = must be one of " : "must be one of ") +
                         listed(kAsNames) + (is_named ? "" : ", or NAME= and one of them") +
                         didYouMean(kind, kAsNames));
        }
        if (!is_named) {
            if (has_default) {
                return wrong("another --as gives " + std::string(wordOf(options.as)) +
                             " for everything without a name; leave one out");
            }
            options.as = *as;
            has_default = true;
            continue;
        }
        if (name.empty()) {
            return wrong(
                "must have a name from the mesh file before the =; leave out the = for the whole mesh");
        }
        if (name.size() > kSelectedNameBytesMax) {
            return wrong("a name has at most " + std::to_string(kSelectedNameBytesMax) +
                         " bytes; shorten it");
        }
        if (std::ranges::find(options.named, name, &NamedShape::name) != options.named.end()) {
            return wrong("another --as has the same name; leave one out");
        }
        if (options.named.size() == kSelectedNamesMax) {
            return fail(ErrorCode::kLimit, "--as gives more than " + std::to_string(kSelectedNamesMax) +
                                               " names; name a parent node, or change the default");
        }
        options.named.push_back({name, *as});
    }
    return options;
}

double defaultThickness(const Bounds& bounds, std::uint64_t budget_bytes) {
    const glm::dvec3 size = bounds.size();
    // Front-back maps along the axes at eight bytes per texel, plus half as many other maps.
    const double area = 12.0 * (size.x * size.y + size.y * size.z + size.z * size.x);
    const double texel = std::sqrt(area / static_cast<double>(std::max<std::uint64_t>(budget_bytes, 1)));
    return thicknessOfTexel(bounds, texel);
}

double thicknessOfTexel(const Bounds& bounds, double texel) {
    // Rounded to a float, which containers store exactly.
    return double{static_cast<float>(std::min(1.5 * texel, 0.04 * double{bounds.longestSide()}))};
}

double partThickness(double default_thickness, double part_size, bool by_texel) {
    return std::clamp(default_thickness, (by_texel ? kThicknessMin : kShellMin) * part_size,
                      kShellMax * part_size);
}

double targetThickness(double thickness, double part_size) {
    return std::min(thickness, kShellRight * part_size);
}

Result<void> checkShellThickness(double thickness, double smallest_sheet, const TriangleMesh& mesh) {
    const double least =
        std::max(kThicknessMin * smallest_sheet, kThicknessFloat * double{mesh.bounds.longestSide()});
    if (thickness >= least) {
        return {};
    }
    return fail(ErrorCode::kUsage, "--thickness is " + shortest(static_cast<float>(thickness)) +
                                       " but a shell of " + mesh.name + " must be at least " +
                                       shortest(static_cast<float>(least)) +
                                       " thick; increase it, or bake the small parts separately");
}

}  // namespace relief

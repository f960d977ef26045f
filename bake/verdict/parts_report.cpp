// SPDX-License-Identifier: Apache-2.0
#include "bake/verdict/parts_report.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <glm/common.hpp>
#include <span>

#include "bake/measure/worst_places.h"
#include "bake/verdict/report_text.h"
#include "formats/base/text.h"

namespace relief {
namespace {

constexpr std::size_t kShownParts = 5;
constexpr std::size_t kShownGroups = 5;
constexpr std::size_t kListedPartsMax = 100;
/// Texels of this fraction of a part's middle extent keep the part: three texels across a pillar.
constexpr double kTexelsAcross = 1.0 / 3.0;
constexpr double kBudgetAdvisedMax = 1e9;
/// Suggested factor on the bytes of patches if a part is lost.
constexpr double kMorePatches = 4.0;
/// A shell swallows a part if its requested thickness is at least this fraction of the part's longest side.
constexpr double kSwallows = 0.25;
constexpr std::size_t kNameBytesMax = 80;

/// Returns the rounded-up size in the syntax of --budget: "1.2MB", "320MB".
std::string megabytes(double bytes) {
    const auto tenths = static_cast<std::uint64_t>(std::ceil(bytes / 1e5));
    return tenths < 100 ? std::to_string(tenths / 10) + "." + std::to_string(tenths % 10) + "MB"
                        : std::to_string((tenths + 9) / 10) + "MB";
}

/// Returns the option for smaller patch texels: the one of --map, --texel and --budget that the collider was baked with;
/// "" if the patches would be too large. \param needed  texel, object units
std::string finerPatches(const Collider& collider, double needed) {
    std::string map;
    bool by_budget = false;
    bool by_texel = false;
    for (const RecordedOption& option : collider.provenance.options) {
        map = option.name == "map" && option.value.starts_with("patches:") ? option.value : map;
        by_budget = by_budget || option.name == "budget";
        by_texel = by_texel || option.name == "texel";
    }
    if ((by_texel && !by_budget) || map.starts_with("patches:texel=")) {
        return (map.empty() ? "--texel " : "--map patches:texel=") + roughly(needed);
    }
    // Only cells with errors are split, so the bytes of other parts hardly grow.
    const double bytes = kMorePatches * static_cast<double>(collider.texelBytes());
    return bytes > kBudgetAdvisedMax
               ? ""
               : (map.empty() ? "--budget " : "--map patches:budget=") + megabytes(bytes);
}

/// Returns the finest texel of patches in a box. Samples 27 points, because the centre may be in a large cell without
/// patches.
double finestIn(const Bounds& box, const DepthMap& map) {
    double finest = texelAt(map, box.center());
    for (int i = 0; i < 27; ++i) {
        const glm::vec3 share = 0.5F * glm::vec3(i % 3, i / 3 % 3, i / 9);
        finest = std::min(finest, texelAt(map, glm::mix(box.min, box.max, share)));
    }
    return finest;
}

double middleExtent(const SurfacePart& part) {
    const glm::dvec3 size = part.bounds.size();
    std::array<double, 3> extents = {size.x, size.y, size.z};
    std::sort(extents.begin(), extents.end());
    return extents[1];
}

/// Returns a text like "27 of 82 parts are lost".
std::string countOfMeasured(std::uint64_t count, const PartsAccuracy& accuracy, const char* what) {
    const std::uint64_t unmeasured = accuracy.countOf(PartVerdict::kUnmeasured);
    const std::uint64_t measured =
        accuracy.parts.size() - unmeasured - accuracy.countOf(PartVerdict::kHidden);
    return std::to_string(count) + " of " + (unmeasured == 0 ? "" : "the largest ") +
           countText(measured, "part") + (count == 1 ? " is " : " are ") + what;
}

std::string groupsText(const PartsAccuracy& accuracy, bool materials, const std::string& unit) {
    std::string text;
    std::size_t shown = 0;
    for (const GroupAccuracy& group : accuracy.groups) {
        if (group.is_material != materials || group.lost == 0 || shown == kShownGroups) {
            continue;
        }
        ++shown;
        text += "  " + cleanUtf8(group.name, kNameBytesMax) + ", " +
                lengthText(double{group.bounds.longestSide()}, unit) + " long at " +
                positionText(group.bounds.center()) + ": " + percentText(group.wrong.total()) + " wrong, " +
                std::to_string(group.lost) + " of " + countText(group.parts, "part") + " lost\n";
    }
    return text.empty() ? "" : (materials ? "The worst materials:\n" : "The worst nodes:\n") + text;
}

/// Returns "pillar_17 (stone)", "part 17 of wood" or "part 17". \param index  into SurfaceParts::parts; the text counts
/// from 1.
std::string partName(const SurfacePart& part, std::size_t index) {
    const std::string number = "part " + std::to_string(index + 1);
    const std::string node = cleanUtf8(part.node, kNameBytesMax);
    const std::string material = cleanUtf8(part.material, kNameBytesMax);
    if (node.empty()) {
        return material.empty() ? number : number + " of " + material;
    }
    return material.empty() ? node : node + " (" + material + ")";
}

/// Returns the side of the finest texels at the centre of a part, or of patches in its bounds, object units; 0 without
/// maps.
double partTexel(const SurfacePart& part, const Collider& collider) {
    double texel = 0.0;
    for (const DepthMap& map : collider.maps) {
        const double here = map.projection() == Projection::kLocal ? finestIn(part.bounds, map)
                                                                   : texelAt(map, part.bounds.center());
        texel = here > 0.0 && (texel == 0.0 || here < texel) ? here : texel;
    }
    return texel;
}

/// Returns "9 m long at (1, 2, 3): 48 % of the points near it are on the wrong side, classified as outside; …", then
/// partFix().
std::string partText(const PartAccuracy& accuracy, const SurfaceParts& parts, const Collider& collider) {
    const SurfacePart& part = parts.parts[accuracy.part];
    const std::string fix = partFix(part, collider);
    const double inside = accuracy.wrong.false_inside / std::max(accuracy.wrong.total(), 1e-9);
    return lengthText(part.size(), collider.unit) + " long at " + positionText(part.bounds.center()) + ": " +
           percentText(accuracy.wrong.total()) + " of the points near it are on the wrong side, " +
           (inside > 0.9   ? "classified as inside"
            : inside < 0.1 ? "classified as outside"
                           : "classified both ways") +
           (fix.empty() ? "" : "; " + fix);
}

}  // namespace

std::string ignoredText(const IgnoredParts& ignored, const std::string& unit) {
    std::string text;
    const auto add = [&](std::uint64_t count, const std::string& parts, const char* state) {
        if (count > 0) {
            text += (text.empty() ? "" : "; ") + parts + (count == 1 ? " is " : " are ") + state;
        }
    };
    const std::string of_all = " of " + countText(ignored.parts, "part");
    add(ignored.lost,
        std::to_string(ignored.lost) + of_all + ", at most " + lengthText(ignored.size, unit) + " long,",
        "not represented");
    add(ignored.thickened, std::to_string(ignored.thickened) + of_all, "thicker than in the mesh");
    add(ignored.unmeasured, "the smallest " + countText(ignored.unmeasured, "part"), "not measured");
    return text;
}

Verdict verdictOf(double wrong_percent, const std::string& grade, const std::string& but,
                  const IgnoredParts& ignored, const std::string& unit) {
    const std::string whole = gradeOf(wrong_percent);
    const std::string tail = ignoredText(ignored, unit);
    const bool worse = whole != "poor" && whole != grade && grade != "good";
    return {worse ? grade : whole,
            (worse ? percentText(wrong_percent) + " wrong near the surface, but " + but + ": " + grade
                   : verdictText(wrong_percent)) +
                (tail.empty() ? "" : "; " + tail)};
}

Verdict verdictOf(double wrong_percent, const PartsAccuracy& accuracy, const std::string& unit) {
    const std::uint64_t lost = accuracy.countOf(PartVerdict::kLost);
    const std::uint64_t coarse = accuracy.countOf(PartVerdict::kCoarse);
    return verdictOf(
        wrong_percent,
        lost > 0                              ? "poor"
        : coarse > 0 && accuracy.minor_counts ? "fair"
                                              : "good",
        lost > 0 ? countOfMeasured(lost, accuracy, "lost") : countOfMeasured(coarse, accuracy, "coarse"),
        accuracy.ignored, unit);
}

std::string partFix(const SurfacePart& part, const Collider& collider) {
    std::string fix;
    if (part.target_thickness < part.thickness) {
        fix = "its shell is " + lengthText(part.thickness, collider.unit) + " thick; --thickness " +
              shortest(parseFloat(roughly(part.target_thickness)).value_or(0.0F));
    }
    const double texel = partTexel(part, collider);
    const double right =
        kTexelsAcross * (part.kind == PartKind::kSheet ? part.target_thickness : middleExtent(part));
    const double needed = std::min(right, 0.5 * texel);
    const bool patches = collider.hasPatches();
    if (!(needed > 0.0) || (patches && !fix.empty() && texel <= right)) {
        return fix;
    }
    if (patches) {
        const std::string finer = finerPatches(collider, needed);
        fix += fix.empty()
                   ? "the heights of its patches are " + lengthText(texel, collider.unit) + " apart; try "
                   : ", and try ";
        fix += finer.empty() ? "" : finer + ", or ";
    } else {
        std::uint32_t side = 0;
        for (const DepthMap& map : collider.maps) {
            side = std::max({side, map.width, map.height});
        }
        const double resolution = std::ceil(side * (texel / needed));
        fix += fix.empty() ? "its texels are " + lengthText(texel, collider.unit) + " wide; " : " with ";
        fix += "texels of " + lengthText(needed, collider.unit) + " need ";
        if (resolution <= kMapSizeMax) {
            const std::string texels = std::to_string(static_cast<std::uint32_t>(resolution));
            fix += "--resolution " + texels + " (--map: size=" + texels + "), or ";
        }
    }
    return fix + (part.node.empty() ? "a separate bake of this part" : "a separate bake of its node");
}

std::string partsText(const PartsAccuracy& accuracy, const SurfaceParts& parts, const Collider& collider) {
    std::string text;
    std::size_t shown = 0;
    for (const PartAccuracy& part : accuracy.parts) {
        if ((part.state != PartVerdict::kLost && part.state != PartVerdict::kCoarse) ||
            shown == kShownParts) {
            break;
        }
        text += "  " + std::to_string(++shown) + "  " + partName(parts.parts[part.part], part.part) + ", " +
                partText(part, parts, collider) + "\n";
    }
    if (!text.empty()) {
        text = (shown == 1 ? "The worst part, relative to its size:\n"
                           : "The worst parts, relative to their size:\n") +
               text;
    }
    text += groupsText(accuracy, false, collider.unit) + groupsText(accuracy, true, collider.unit);
    if (accuracy.countOf(PartVerdict::kMinor) > 0) {
        text += "Parts shorter than " + lengthText(accuracy.min_part, collider.unit) +
                ", or off by less than " + lengthText(kNoticeableExcess * accuracy.min_part, collider.unit) +
                ", do not lower the grade; --min-part LENGTH changes that\n";
    }
    return text;
}

std::optional<std::string> lostPartsWarning(const PartsAccuracy& accuracy, const SurfaceParts& parts,
                                            const Collider& collider) {
    const std::uint64_t lost = accuracy.countOf(PartVerdict::kLost);
    if (lost == 0) {
        return std::nullopt;
    }
    const auto size = [&](const PartAccuracy& one) { return parts.parts[one.part].size(); };
    const auto largest = std::ranges::max_element(std::span(accuracy.parts).first(lost), {}, size);
    return countOfMeasured(lost, accuracy, "lost") + (lost == 1 ? ": " : ", the largest ") +
           partName(parts.parts[largest->part], largest->part) + ", " + partText(*largest, parts, collider);
}

std::optional<std::string> outlierText(const SurfaceParts& parts, const std::string& unit) {
    const OutlierParts strays = findOutlierParts(parts.parts);
    if (strays.parts.empty()) {
        return std::nullopt;
    }
    const std::uint32_t first = strays.parts.front();
    const SurfacePart& part = parts.parts[first];
    const std::size_t others = strays.parts.size() - 1;
    return partName(part, first) + " (" + countText(part.triangles, "triangle") + ")" +
           (others > 0 ? " and " + std::to_string(others) + " more parts are" : " is") +
           " far from everything else, at " + positionText(part.bounds.center()) + "; the rest is " +
           lengthText(double{strays.rest.longestSide()}, unit) + " long at " +
           positionText(strays.rest.center()) +
           ": the empty space between them wastes bytes; delete the outliers from the mesh";
}

std::vector<std::string> partWarnings(const SurfaceParts& parts, const std::string& unit) {
    std::vector<std::string> warnings;
    if (std::optional<std::string> stray = outlierText(parts, unit)) {
        warnings.push_back(std::move(*stray));
    }
    std::uint64_t swallowed = 0;
    std::uint32_t largest = 0;
    for (std::uint32_t i = 0; i < parts.parts.size(); ++i) {
        const SurfacePart& part = parts.parts[i];
        if (part.target_thickness >= kSwallows * part.size() && part.thickness > 0.0) {
            largest = swallowed == 0 || part.size() > parts.parts[largest].size() ? i : largest;
            ++swallowed;
        }
    }
    if (swallowed > 0) {
        const SurfacePart& part = parts.parts[largest];
        warnings.push_back("shells of --thickness " + shortest(static_cast<float>(part.thickness)) +
                           " swallow " + countText(swallowed, "sheet") +
                           (swallowed == 1 ? ": " : ", the largest ") + partName(part, largest) + ", " +
                           lengthText(part.size(), unit) + " long at " + positionText(part.bounds.center()) +
                           "; give a smaller --thickness");
    }
    return warnings;
}

void fields(FieldVisitor& visit, const Verdict& verdict) {
    visit("grade", verdict.grade,
          {.help = "good: at most 1 % wrong; fair: at most 5 %; at best fair if coarse parts miss more than "
                   "1 % of the points; poor if a part is lost",
           .words = kWords<"good", "fair", "poor">});
    visit("text", verdict.text, {"The grade in words, with the number of ignored parts"});
}

void fields(FieldVisitor& visit, const IgnoredParts& ignored) {
    visit("parts", ignored.parts, {"Parts of the mesh"});
    visit("lost", ignored.lost,
          {"Parts that are not represented, but too small to lower the grade: more than 25 % of the points "
           "near each are wrong, most of them classified as outside"});
    visit("size", ignored.size, {"Longest side of the largest ignored part", "object units", kFromZero});
    visit("thickened", ignored.thickened,
          {"Parts that are thicker than in the mesh, but too small or too slightly off to lower the grade: "
           "more than 25 % of the points near each are wrong, most of them classified as inside"});
    visit("unmeasured", ignored.unmeasured, {"Parts that were not measured: the smallest of too many"});
}

void fields(FieldVisitor& visit, const GroupAccuracy& group) {
    visit("name", group.name, {"Name in the file"});
    visit("of", group.is_material ? "material" : "node",
          {.help = "Owner of the name", .words = kWords<"node", "material">});
    visit("parts", group.parts, {"Measured parts"});
    visit("lost", group.lost, {"Lost parts"});
    visit("size", double{group.bounds.longestSide()},
          {"Longest side of the box of its parts", "object units", kFromZero});
    visit("position", group.bounds.center(), {"Center of that box", "object units"});
    fields(visit, group.wrong);
}

namespace {

struct PartReport {
    const PartAccuracy& accuracy = kNone<PartAccuracy>;
    const SurfacePart& part = kNone<SurfacePart>;
    const Collider& collider = kNone<Collider>;
};

void fields(FieldVisitor& visit, const PartReport& report) {
    const auto& [accuracy, part, collider] = report;
    const bool needs_fix = accuracy.state == PartVerdict::kLost || accuracy.state == PartVerdict::kCoarse ||
                           accuracy.state == PartVerdict::kMinor;
    visit("part", accuracy.part + 1, {"Number from 1, in the order of the first triangles", {}, kFromOne});
    visit("node", part.node, {"Name of its node in the file; may be empty"});
    visit("material", part.material, {"Name of its material in the file; may be empty"});
    visit("kind", part.kind, {"Treatment of the part; a surface is baked unchanged"});
    visit("state", accuracy.state,
          {"kept: at most 10 % of the points near it are wrong; coarse: at most 25 %; lost: more than 25 %; "
           "hidden: inside other parts; minor: like lost, but too small to be noticed; unmeasured: not "
           "measured because there are too many parts"});
    visit("size", part.size(), {"Longest side of its box", "object units", kFromZero});
    visit("position", part.bounds.center(), {"Center of its box", "object units"});
    visit("triangles", part.triangles, {"Number of triangles"});
    visit("thickness", onlyIf(part.thickness > 0.0, part.thickness),
          {"Thickness of the shell that replaces it; null without one", "object units", kFromZero});
    visit("points", accuracy.points, {"Number of measured points near it"});
    visit("sigma", accuracy.sigma,
          {"Standard deviation of the distance of these points", "object units", kFromZero});
    fields(visit, accuracy.wrong);
    visit("texel", partTexel(part, collider),
          {"Side of the finest texels at its center, or of the finest patches in its box", "object units",
           kFromZero});
    visit("fix", needs_fix ? std::optional(partFix(part, collider)) : std::nullopt,
          {"How to keep the part; null unless coarse, lost or minor"});
}

}  // namespace

void fields(FieldVisitor& visit, const PartsReport& report) {
    constexpr std::array<std::string_view, kPartVerdicts> kCounts = {
        "Parts with at most 10 % wrong points",
        "Parts with at most 25 % wrong points",
        "Parts with more than 25 % wrong points",
        "Parts inside other parts",
        "Parts with more than 25 % wrong points that are too small to be noticed",
        "Parts not measured"};
    const PartsAccuracy& accuracy = report.accuracy;
    visit("min_part", accuracy.min_part,
          {"Parts shorter than this do not lower the grade", "object units", kFromZero});
    visit("count", accuracy.parts.size(), {"Parts of the mesh"});
    for (std::size_t i = 0; i < kPartVerdicts; ++i) {
        visit(kWordsOf<PartVerdict>[i], accuracy.count[i], {kCounts[i]});
    }
    std::vector<PartReport> worst;
    const std::size_t shown = std::min(accuracy.parts.size(), kListedPartsMax);
    for (const PartAccuracy& one : std::span(accuracy.parts).first(shown)) {
        worst.push_back({one, report.parts.parts[one.part], report.collider});
    }
    visit("worst", worst,
          {"At most 100 parts, the lost ones first; a part is connected, and belongs to one node and "
           "one material"});
    std::vector<GroupAccuracy> groups;
    std::array<std::size_t, 2> listed{};  // nodes and materials
    for (const GroupAccuracy& one : accuracy.groups) {
        if (listed[one.is_material ? 1 : 0]++ < kListedPartsMax) {
            groups.push_back(one);
        }
    }
    visit("groups", groups,
          {"The worst 100 named nodes, then the worst 100 materials, if there are "
           "several; their parts are weighted by area"});
}

}  // namespace relief

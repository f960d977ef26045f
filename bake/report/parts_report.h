// The parts of a mesh that a collider loses: which they are, how large, and what would keep them.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "bake/measure/part_accuracy.h"
#include "bake/mesh/surface_parts.h"
#include "bake/report/check_report.h"
#include "formats/collider.h"

namespace relief {

/// The worse of gradeOf(wrong_percent) and that of the parts: poor if one is lost, fair if one is coarse.
[[nodiscard]] std::string gradeOf(double wrong_percent, const PartsAccuracy& accuracy);
/// "0.4 % wrong near the surface: good", "0.3 % wrong near the surface, but 27 of 82 parts are lost: poor"
[[nodiscard]] std::string verdictText(double wrong_percent, const PartsAccuracy& accuracy);

/// "pillar_17 (stone)", "part 17 of wood" or "part 17". \param index  of SurfaceParts::parts; counted from 1 in the text.
[[nodiscard]] std::string partName(const SurfacePart& part, std::size_t index);
/// Of a lost or coarse part: a budget, a thickness or a bake of its own that would keep it.
[[nodiscard]] std::string partCure(const SurfacePart& part, const Collider& collider);
/// Side of the finest texels at the middle of a part, or of patches in its box, object units; 0 without maps.
[[nodiscard]] double partTexel(const SurfacePart& part, const Collider& collider);
/// "9 m long at (1, 2, 3): 48 % of the points near it are on the wrong side, called outside; …", and partCure().
[[nodiscard]] std::string partText(const PartAccuracy& accuracy, const SurfaceParts& parts,
                                   const Collider& collider);

/// The worst parts, the worst named nodes and materials, and the number of parts that do not count; "" if all are held.
[[nodiscard]] std::string partsText(const PartsAccuracy& accuracy, const SurfaceParts& parts,
                                    const Collider& collider);
/// One line of a warning without the mesh's name; nullopt if no part is lost.
[[nodiscard]] std::optional<std::string> lostPartsWarning(const PartsAccuracy& accuracy,
                                                          const SurfaceParts& parts,
                                                          const Collider& collider);
/// Parts far from all others, in one line; nullopt if there are none.
[[nodiscard]] std::optional<std::string> strayText(const SurfaceParts& parts, const std::string& unit);
/// The same, and shells whose --thickness is at least a quarter of their parts' length: a line each.
[[nodiscard]] std::vector<std::string> partWarnings(const SurfaceParts& parts, const std::string& unit);

// --- The same as fields.

inline constexpr std::size_t kListedPartsMax = 100;

struct PartReport {
    const PartAccuracy& accuracy = kNone<PartAccuracy>;
    const SurfacePart& part = kNone<SurfacePart>;
    const Collider& collider = kNone<Collider>;
};

template <class Visitor, FieldsOf<PartReport> R>
void fields(Visitor& visit, R& report) {
    const auto& [accuracy, part, collider] = report;
    const bool wants = accuracy.state == PartVerdict::kLost || accuracy.state == PartVerdict::kCoarse;
    visit("part", accuracy.part + 1,
          {"Number, from 1, in the order of the parts' first triangles", {}, kFromOne});
    visit("node", part.node, {"Node of the file; empty without a name"});
    visit("material", part.material, {"Material of the file; empty without a name"});
    visit("kind", part.kind, {"Shape that it is treated as; a surface is baked as it is"});
    visit("state", accuracy.state,
          {"held: at most 10 % of its points are wrong; coarse: at most 25 %; lost: more; hidden: inside "
           "other parts; "
           "small: below the detail; rest: not measured because there are too many parts"});
    visit("size", part.size(), {"Longest side of its box", "object units", kFromZero});
    visit("position", part.bounds.center(), {"Middle of its box", "object units"});
    visit("triangles", part.triangles, {"Its triangles"});
    visit("thickness", onlyIf(part.thickness > 0.0, part.thickness),
          {"Thickness of the shell that replaces it; null without one", "object units", kFromZero});
    visit("points", accuracy.points, {"Points near it that were measured"});
    visit("sigma", accuracy.sigma,
          {"Standard deviation of their distance from it", "object units", kFromZero});
    fields(visit, accuracy.wrong);
    visit("texel", partTexel(part, collider),
          {"Side of the finest texels at its middle, or of the finest patches' in its box", "object units",
           kFromZero});
    visit("cure", wants ? std::optional(partCure(part, collider)) : std::nullopt,
          {"A way to keep it; null unless coarse or lost"});
}

template <class Visitor, FieldsOf<GroupAccuracy> G>
void fields(Visitor& visit, G& group) {
    visit("name", group.name, {"Name in the file"});
    visit("of", group.is_material ? "material" : "node",
          {.help = "Owner of the name", .words = kWords<"node", "material">});
    visit("parts", group.parts, {"Measured parts"});
    visit("lost", group.lost, {"Lost parts"});
    visit("size", double{group.bounds.longestSide()},
          {"Longest side of the box of its parts", "object units", kFromZero});
    visit("position", group.bounds.center(), {"Middle of that box", "object units"});
    fields(visit, group.wrong);
}

struct PartsReport {
    const PartsAccuracy& accuracy = kNone<PartsAccuracy>;
    const SurfaceParts& parts = kNone<SurfaceParts>;
    const Collider& collider = kNone<Collider>;

    /// The first kListedPartsMax parts.
    [[nodiscard]] std::vector<PartReport> worst() const;
    /// The first kListedPartsMax nodes, and as many materials.
    [[nodiscard]] std::vector<GroupAccuracy> groups() const;
};

template <class Visitor, FieldsOf<PartsReport> R>
void fields(Visitor& visit, R& report) {
    constexpr std::array<std::string_view, kPartVerdicts> kCounts = {"Parts with at most 10 % wrong points",
                                                                     "Parts with at most 25 % wrong points",
                                                                     "Parts with more wrong points",
                                                                     "Parts inside other parts",
                                                                     "Parts below the detail",
                                                                     "Parts not measured"};
    const PartsAccuracy& accuracy = report.accuracy;
    visit("detail", accuracy.detail,
          {"Parts with a smaller longest side are not judged", "object units", kFromZero});
    visit("count", accuracy.parts.size(), {"Parts of the mesh"});
    for (std::size_t i = 0; i < kPartVerdicts; ++i) {
        visit(kWordsOf<PartVerdict>[i], accuracy.count[i], {kCounts[i]});
    }
    visit("worst", report.worst(),
          {"At most 100 parts, the lost ones first; a part is connected, and of one node and "
           "one material"});
    visit("groups", report.groups(),
          {"The worst 100 named nodes, then the worst 100 materials, where there are "
           "several; their parts are weighted by area"});
}

}  // namespace relief

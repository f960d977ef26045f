// SPDX-License-Identifier: Apache-2.0
// The accuracy of a field for each part of a mesh, at the part's own scale: a prop on a terrain is judged as if baked alone.
#pragma once

#include <cstdint>
#include <optional>
#include <vector>

#include "bake/measure/accuracy.h"
#include "bake/measure/grades.h"
#include "bake/mesh/mesh_query.h"
#include "bake/mesh/surface_parts.h"

namespace relief {

struct PartOptions {
    std::uint32_t points = 1000;         ///< of each part, at most; a lost one is confirmed by at least 256
    std::uint32_t points_min = 48;       ///< of each part, at least
    std::uint64_t points_all = 200'000;  ///< of all parts together, but for points_min
    std::size_t parts_max = 10'000;      ///< the largest ones are measured
    std::uint64_t seed = 1;
    double sigma_share = 0.005;  ///< as in AccuracyOptions, in units of the part's longest side
    std::optional<double> detail =
        {};              ///< size of the smallest part that counts, object units; else defaultDetail
    double scale = 1.0;  ///< of the object in its world, for defaultDetail
};

/// kNoticeableShare of the diagonal of the parts without strays; in metres at most kNoticeableMetres in the world.
[[nodiscard]] double defaultDetail(const SurfaceParts& parts, const std::string& unit, double scale = 1.0);

enum class PartVerdict : std::uint8_t {
    kHeld,    ///< up to kPartCoarse
    kCoarse,  ///< up to kPartLost
    kLost,
    kHidden,  ///< inside other parts, where nothing collides
    kMinor,   ///< lost, but too small to lower the grade
    kRest,    ///< beyond parts_max; not measured
};
template <>
inline constexpr std::array<std::string_view, 6> kWordsOf<PartVerdict>{"held",   "coarse", "lost",
                                                                       "hidden", "minor",  "rest"};
inline constexpr std::size_t kPartVerdicts = kWordsOf<PartVerdict>.size();

struct PartAccuracy {
    std::uint32_t part = 0;  ///< index into SurfaceParts::parts
    PartVerdict state = PartVerdict::kHeld;
    std::uint32_t points = 0;  ///< near the part, by its exposed surface
    WrongShare wrong;          ///< percent of them
    double sigma = 0.0;        ///< standard deviation of their distance from the part, object units
};

/// A node or a material of several parts: their points, weighted by their areas.
struct GroupAccuracy {
    std::string name;
    bool is_material = false;
    std::uint64_t parts = 0;
    std::uint64_t lost = 0;
    Bounds bounds;
    WrongShare wrong;  ///< percent
};

/// The parts that a verdict ignores, of one mesh or several.
struct IgnoredParts {
    std::uint64_t parts = 0;       ///< all
    std::uint64_t lost = 0;        ///< PartVerdict::kMinor, and mostly called outside
    double size = 0.0;             ///< of the largest of these
    std::uint64_t thick = 0;       ///< the other ones of PartVerdict::kMinor, mostly called inside
    std::uint64_t unmeasured = 0;  ///< PartVerdict::kRest

    /// \param scale  of the other mesh's sizes.
    void add(const IgnoredParts& other, double scale);
};

struct PartsAccuracy {
    double detail = 0.0;  ///< object units
    std::vector<PartAccuracy>
        parts;  ///< lost, then coarse, and so on; within a state by wrong points times size
    std::vector<GroupAccuracy> groups;  ///< several named nodes, then several materials; the most wrong first
    std::uint64_t count[kPartVerdicts] = {};  ///< of parts in each state
    bool minor_counts =
        false;  ///< minor and coarse parts together make more than kGoodPercent of the surface wrong
    IgnoredParts ignored;

    [[nodiscard]] std::uint64_t countOf(PartVerdict state) const {
        return count[static_cast<std::size_t>(state)];
    }
};

/// Measures at points near each part's surface in the baked solid: area-weighted, with an isotropic Gaussian offset, which is
/// less for a part that is thinner and seems to be absent. Truth is the side of the whole mesh, but a shell ends at its
/// right_thickness. A part that fewer than 256 points call lost is measured again by 256. It is minor if it is shorter than the
/// detail, or if it is there and kNoticeableExcess of the detail off the surface is right; but missing minor parts are lost if they
/// count together and the detail is the default. The same for any number of threads.
/// \param query  of the solid of `parts`.
[[nodiscard]] PartsAccuracy measureParts(const MeshQuery& query, const SurfaceParts& parts,
                                         const Field& field, const PartOptions& options);

}  // namespace relief

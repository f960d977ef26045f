// SPDX-License-Identifier: Apache-2.0
// The accuracy of a field for each part of a mesh, at the part's own scale: a prop on a terrain is judged as if baked alone.
#pragma once

#include <cstdint>
#include <optional>
#include <vector>

#include "bake/measure/accuracy.h"
#include "bake/mesh/mesh_query.h"
#include "bake/mesh/surface_parts.h"

namespace relief {

/// Limits in percent of points on the wrong side; of an absent part about half are.
inline constexpr double kPartCoarse = 10.0;
inline constexpr double kPartLost = 25.0;

struct PartOptions {
    std::uint32_t points = 1000;         ///< of each part, at most
    std::uint32_t points_min = 48;       ///< of each part, at least
    std::uint64_t points_all = 200'000;  ///< of all parts together, but for points_min
    std::size_t parts_max = 10'000;      ///< the largest ones are measured
    std::uint64_t seed = 1;
    double sigma_share = 0.005;  ///< as in AccuracyOptions, in units of the part's longest side
    std::optional<double>
        detail;  ///< size of the smallest part that counts, object units; else defaultDetail
};

/// A thousandth of the longest side of the largest part; in metres at most 0.1.
[[nodiscard]] double defaultDetail(const SurfaceParts& parts, const std::string& unit);

enum class PartVerdict : std::uint8_t {
    kHeld,    ///< up to kPartCoarse
    kCoarse,  ///< up to kPartLost
    kLost,
    kHidden,  ///< inside other parts, where nothing collides
    kSmall,   ///< below `detail`; not measured
    kRest,    ///< beyond parts_max; not measured
};
template <>
inline constexpr std::array<std::string_view, 6> kWordsOf<PartVerdict>{"held",   "coarse", "lost",
                                                                       "hidden", "small",  "rest"};
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

struct PartsAccuracy {
    double detail = 0.0;  ///< object units
    std::vector<PartAccuracy>
        parts;  ///< lost, then coarse, and so on; within a state by wrong points times size
    std::vector<GroupAccuracy> groups;  ///< several named nodes, then several materials; the most wrong first
    std::uint64_t count[kPartVerdicts] = {};  ///< of parts in each state

    [[nodiscard]] std::uint64_t countOf(PartVerdict state) const {
        return count[static_cast<std::size_t>(state)];
    }
};

/// Measures at points near each part's surface in the baked solid: area-weighted, with an isotropic Gaussian offset. Truth is
/// the side of the whole mesh, but a shell ends at its right_thickness. The same for any number of threads.
/// \param query  of the solid of `parts`.
[[nodiscard]] PartsAccuracy measureParts(const MeshQuery& query, const SurfaceParts& parts,
                                         const Field& field, const PartOptions& options);

}  // namespace relief

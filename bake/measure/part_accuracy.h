// SPDX-License-Identifier: Apache-2.0
// Measures the accuracy of a field for each part of a mesh at the part's own scale, so that a prop on a terrain is
// judged as if it were baked separately.
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
    std::uint32_t points = 1000;         ///< per part, at most; a lost part is confirmed with at least 256
    std::uint32_t points_min = 48;       ///< per part, at least
    std::uint64_t points_all = 200'000;  ///< shared by parts of min_part or longer; at least points_min each
    std::size_t parts_max = 10'000;      ///< only the largest parts are measured
    std::uint64_t seed = 1;
    double sigma_fraction = 0.005;  ///< as in AccuracyOptions, in units of the part's longest side
    /// Longest side of the smallest part that counts, object units; nullopt: defaultMinPart.
    std::optional<double> min_part = {};
    double scale = 1.0;  ///< of the object in its world, for defaultMinPart
};

/// Returns kNoticeableShare times the diagonal of the bounds of all parts except outliers; at most kNoticeableMetres in
/// the world if `unit` is metres.
[[nodiscard]] double defaultMinPart(const SurfaceParts& parts, const std::string& unit, double scale = 1.0);

enum class PartVerdict : std::uint8_t {
    kKept,    ///< at most kPartCoarse percent of the points are wrong
    kCoarse,  ///< at most kPartLost percent of the points are wrong
    kLost,
    kHidden,      ///< inside other parts, where nothing can collide
    kMinor,       ///< lost, but too small to lower the grade
    kUnmeasured,  ///< beyond parts_max; not measured
};
template <>
inline constexpr std::array<std::string_view, 6> kWordsOf<PartVerdict>{"kept",   "coarse", "lost",
                                                                       "hidden", "minor",  "unmeasured"};
inline constexpr std::size_t kPartVerdicts = kWordsOf<PartVerdict>.size();

struct PartAccuracy {
    std::uint32_t part = 0;  ///< index into SurfaceParts::parts
    PartVerdict state = PartVerdict::kKept;
    std::uint32_t points = 0;  ///< number near the part's exposed surface
    WrongPercent wrong;        ///< percent of them
    double sigma = 0.0;        ///< standard deviation of their distance from the part, object units
};

/// The accuracy of all parts of a node or material, weighted by area.
struct GroupAccuracy {
    std::string name;
    bool is_material = false;
    std::uint64_t parts = 0;
    std::uint64_t lost = 0;
    Bounds bounds;
    WrongPercent wrong;  ///< percent
};

/// The parts of one or more meshes that a verdict ignores.
struct IgnoredParts {
    std::uint64_t parts = 0;       ///< all parts, including those that are not ignored
    std::uint64_t lost = 0;        ///< PartVerdict::kMinor, mostly classified as outside
    double size = 0.0;             ///< longest side of the largest lost part
    std::uint64_t thickened = 0;   ///< PartVerdict::kMinor, mostly classified as inside
    std::uint64_t unmeasured = 0;  ///< PartVerdict::kUnmeasured

    /// Adds the parts of another mesh. \param scale  factor for its sizes.
    void add(const IgnoredParts& other, double scale);
};

struct PartsAccuracy {
    double min_part = 0.0;  ///< object units
    /// By state: lost, coarse, minor, kept, hidden, unmeasured; within a state by wrong percentage times size, largest
    /// first.
    std::vector<PartAccuracy> parts;
    /// Named nodes, if there are several, then named materials, if there are several; each least accurate first.
    std::vector<GroupAccuracy> groups;
    std::uint64_t count[kPartVerdicts] = {};  ///< number of parts in each state
    /// More than kGoodPercent of the points near the surface are falsely outside because of minor and coarse parts.
    bool minor_counts = false;
    IgnoredParts ignored;

    [[nodiscard]] std::uint64_t countOf(PartVerdict state) const {
        return count[static_cast<std::size_t>(state)];
    }
};

/// Measures points near each part's surface in the baked solid. Points are area-weighted, with an isotropic Gaussian
/// offset. If most of a part seems to be missing, closer points are measured, too. Truth is the side of the whole mesh,
/// except that a shell ends at its target_thickness. If a part is lost and had fewer than 256 points, it is measured
/// again with 256.
///
/// A lost part is minor if it is shorter than `min_part`. It is also minor if most of it is present, and enough points
/// at a distance of kNoticeableExcess times `min_part` are on the right side. But minor parts mostly classified as
/// outside are lost if PartsAccuracy::minor_counts is set and `min_part` is the default. The result does not depend on
/// the number of threads.
/// \param query  of the solid of `parts`.
[[nodiscard]] PartsAccuracy measureParts(const MeshQuery& query, const SurfaceParts& parts,
                                         const Field& field, const PartOptions& options);

}  // namespace relief

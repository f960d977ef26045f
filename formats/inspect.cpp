#include "formats/inspect.h"

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <glm/geometric.hpp>
#include <string>

#include "formats/base/hash.h"
#include "formats/container_reader.h"
#include "formats/plane.h"

namespace relief {
namespace {

// Counts are of all texels; what needs geometry looks at this many of a map, evenly spread.
constexpr std::size_t kGeometryTexels = 65536;
constexpr std::size_t kSurfacePoints = 4096;

// A share of texels above which a warning is due. Single texels may be anything: rounding, slivers.
constexpr double kSaturatedShare = 0.25;
constexpr double kOutsideShare = 0.01;
constexpr double kInwardShare = 0.25;
constexpr double kReversedShare = 0.25;  // of gaps: planes that slope may cross at a texel's centre
// How far a surface point may lie outside of the bounds: of their longest side, beside the spread of a texel.
constexpr double kBoundsSlack = 0.01;
// A normal is as good as turned away only where it clearly is, whatever its encoding.
constexpr double kInwardCosine = 0.1;

std::string percent(std::size_t part, std::size_t whole) {
    char text[32];
    std::snprintf(text, sizeof(text), "%.1f %%",
                  100.0 * static_cast<double>(part) / static_cast<double>(whole));
    return text;
}

/// The depth codes of an integer texel; false for float32, whose depths do not saturate.
bool depthAtEnd(MapFormat format, std::span<const std::byte> texel, bool back) {
    const auto byteAt = [&](std::size_t i) { return std::to_integer<unsigned>(texel[i]); };
    switch (format) {
        case MapFormat::kFloat32:
            return false;
        case MapFormat::kFixed8:
        case MapFormat::kCube8: {
            const unsigned code = byteAt(2) << 8 | byteAt(3);
            return code == 1 || code == 65535;
        }
        case MapFormat::kFrontBackHalf: {
            const unsigned half = byteAt(back ? 7 : 5) << 8 | byteAt(back ? 6 : 4);
            return half == 0x0400 || half == 0x3c00;
        }
        case MapFormat::kFrontBackFixed: {
            const unsigned code = byteAt(back ? 7 : 5) << 8 | byteAt(back ? 6 : 4);
            return code == 1 || code == 65535;
        }
    }
    return false;
}

/// Whether an integer texel has bits that no writer leaves: a normal beside no surface, or an index of 255.
bool strayBits(MapFormat format, std::span<const std::byte> texel, const Texel& decoded) {
    const auto byteAt = [&](std::size_t i) { return std::to_integer<unsigned>(texel[i]); };
    const auto stray = [&](std::size_t at, bool covered) {
        return covered ? byteAt(at) == 255 || byteAt(at + 1) == 255 : (byteAt(at) | byteAt(at + 1)) != 0;
    };
    if (format == MapFormat::kFloat32) {
        return false;
    }
    return stray(0, decoded.front.has_value()) || (isFrontBack(format) && stray(2, decoded.back.has_value()));
}

struct Counts {
    std::size_t texels = 0;
    std::size_t covered = 0;
    std::size_t border = 0;  ///< covered, and never looked at
    std::size_t stray = 0;
    std::size_t gaps = 0;
    std::size_t reversed = 0;  ///< gaps that are closed before they are opened
    std::size_t surfaces = 0;  ///< of the texels looked at closely, as are the next three
    std::size_t saturated = 0;
    std::size_t inward = 0;
    std::size_t outside = 0;
};

/// The warnings 22xx: doubts about a map whose texels are valid.
struct TexelInspection {
    double coverage = 0.0;            ///< share of texels with a surface, 0…1
    std::vector<Issue> issues;        ///< their map left at −1
    std::vector<glm::dvec3> surface;  ///< surface points of some texels, object space
};

class MapInspector {
  public:
    /// \param map     valid, with its texels
    /// \param bounds  of the collider; nullptr where they are not valid
    MapInspector(const DepthMap& map, const Bounds* bounds) : map_(map), bounds_(bounds) {
        const std::size_t texels = std::size_t{map.faceCount()} * map.width * map.height;
        stride_ = std::max<std::size_t>(1, texels / kGeometryTexels);
        point_stride_ = std::max<std::size_t>(1, texels / kSurfacePoints);
        // A plane holds for its whole texel, and its depth is that at the centre.
        const glm::dvec3 s(map.object_per_map);
        texel_ = 2.0 * (s.x / map.width + s.y / map.height);
        if (map.projection() == Projection::kCube) {
            texel_ = 4.0 * (s.x + s.y + s.z) / map.width;
        }
        if (bounds != nullptr) {
            slack_ = texel_ + kBoundsSlack * static_cast<double>(bounds->longestSide());
        }
    }

    TexelInspection run() {
        std::size_t index = 0;
        for (std::uint32_t face = 0; face < map_.faceCount(); ++face) {
            for (std::uint32_t y = 0; y < map_.height; ++y) {
                for (std::uint32_t x = 0; x < map_.width; ++x) {
                    look(face, x, y, index++);
                }
            }
        }
        counts_.texels = index;
        result_.coverage = static_cast<double>(counts_.covered) / static_cast<double>(index);
        report();
        return std::move(result_);
    }

  private:
    void look(std::uint32_t face, std::uint32_t x, std::uint32_t y, std::size_t index) {
        const auto bytes = map_.texelAt(face, x, y);
        const Texel texel = decodeTexel(map_.format, bytes);
        counts_.stray += strayBits(map_.format, bytes, texel) ? 1 : 0;
        if (!texel.front && !texel.back) {
            return;
        }
        ++counts_.covered;
        const bool border = map_.projection() == Projection::kOrthographic &&
                            (x == 0 || y == 0 || x + 1 == map_.width || y + 1 == map_.height);
        counts_.border += border ? 1 : 0;
        if (map_.compare == Compare::kGap && texel.front && texel.back) {
            ++counts_.gaps;
            counts_.reversed += texel.front->depth < texel.back->depth ? 1 : 0;
        }
        if (index % stride_ != 0) {
            return;
        }
        const TexelRay ray = texelRay(map_, face, x, y);
        const bool keep = index % point_stride_ == 0;
        if (texel.front) {
            lookClosely(*texel.front, ray, map_.compare == Compare::kGreater,
                        depthAtEnd(map_.format, bytes, false), keep);
        }
        if (texel.back) {
            lookClosely(*texel.back, ray, true, depthAtEnd(map_.format, bytes, true), keep);
        }
    }

    /// \param farthest  the surface is the last on its ray, whose normal points along it.
    void lookClosely(const Surface& surface, const TexelRay& ray, bool farthest, bool at_end, bool keep) {
        const double cosine =
            glm::dot(glm::dvec3(surface.normal), glm::normalize(ray.direction)) * (farthest ? 1.0 : -1.0);
        const bool stands =
            map_.decode == Decode::kPlane && std::abs(cosine) < static_cast<double>(kStandingCosine) + 1e-4;
        if (stands) {
            return;  // its depth is a distance from the ray, and its normal is across it
        }
        ++counts_.surfaces;
        counts_.inward += cosine < -kInwardCosine ? 1 : 0;
        const glm::dvec3 at = ray.at(double{surface.depth});
        if (bounds_ != nullptr) {
            const double inside = depthInBounds(at);
            counts_.outside += inside < -slack_ ? 1 : 0;
            // A flat face may lie at the end of the volume, if the mesh ends there too.
            counts_.saturated += at_end && inside > slack_ ? 1 : 0;
        }
        if (keep) {
            result_.surface.push_back(at);
        }
    }

    /// How far a point is from the nearest face of the bounds; negative outside.
    [[nodiscard]] double depthInBounds(const glm::dvec3& p) const {
        const glm::dvec3 low = p - glm::dvec3(bounds_->min);
        const glm::dvec3 high = glm::dvec3(bounds_->max) - p;
        return std::min({low.x, low.y, low.z, high.x, high.y, high.z});
    }

    void report() {
        const auto tooMany = [](std::size_t part, double share, std::size_t whole) {
            return static_cast<double>(part) > share * static_cast<double>(whole);
        };
        const auto warn = [&](IssueCode code, std::string message) {
            result_.issues.push_back({code, -1, std::nullopt, std::move(message)});
        };
        const Counts& c = counts_;
        if (c.covered == 0) {
            warn(IssueCode::kNothingCovered, "no texel holds a surface; the map sees nothing");
        }
        if (tooMany(c.saturated, kSaturatedShare, c.surfaces)) {
            warn(IssueCode::kDepthSaturated, percent(c.saturated, c.surfaces) +
                                                 " of its surfaces lie at an end of the depth range "
                                                 "amid the bounds; its volume may cut the mesh off");
        }
        if (tooMany(c.outside, kOutsideShare, c.surfaces)) {
            warn(IssueCode::kOutsideBounds,
                 percent(c.outside, c.surfaces) + " of its surfaces lie outside of the bounds");
        }
        if (tooMany(c.inward, kInwardShare, c.surfaces)) {
            warn(IssueCode::kNormalsInward, percent(c.inward, c.surfaces) +
                                                " of its normals point into the object; the mesh may be "
                                                "inside out");
        }
        if (c.border > 0) {
            warn(
                IssueCode::kBorderCovered,
                std::to_string(c.border) + " texels of its border, which is never looked at, hold a surface");
        }
        if (c.stray > 0) {
            warn(IssueCode::kTexelBits, std::to_string(c.stray) +
                                            " texels have bits that no writer leaves: a normal without a "
                                            "surface, or an index of 255");
        }
        if (tooMany(c.reversed, kReversedShare, c.gaps)) {
            warn(IssueCode::kGapReversed, percent(c.reversed, c.gaps) +
                                              " of its gaps are closed before they are opened; nothing lies "
                                              "outside of them, and their ends may be exchanged");
        }
    }

    const DepthMap& map_;
    const Bounds* bounds_;
    std::size_t stride_ = 1;
    std::size_t point_stride_ = 1;
    double texel_ = 0.0;  ///< how far a texel's surface may lie from its centre's, object units
    double slack_ = 0.0;
    Counts counts_;
    TexelInspection result_;
};

/// How many of the points lie outside of the map's volume by more than the spread of a texel: none does where
/// `encloses` is true.
std::size_t countOutsideVolume(const DepthMap& map, const std::vector<glm::dvec3>& points) {
    constexpr double kSlack = 0.01;  // of the volume, beside two texels
    const bool cube = map.projection() == Projection::kCube;
    const double low = cube ? -1.0 : 0.0;
    const double slack_x = kSlack + 2.0 / map.width;
    const double slack_y = kSlack + 2.0 / map.height;
    const glm::dvec3 slack(slack_x, slack_y, cube ? slack_x : kSlack);
    return static_cast<std::size_t>(std::ranges::count_if(points, [&](const glm::dvec3& p) {
        for (int i = 0; i < 3; ++i) {
            const glm::dvec4 row(map.object_to_map.row[i]);
            const double at = glm::dot(glm::dvec3(row), p) + row.w;
            if (at < low - slack[i] || at > 1.0 + slack[i]) {
                return true;
            }
        }
        return false;
    }));
}

constexpr double kOutsideVolumeShare = 0.01;      // of the other maps' surface points
constexpr std::size_t kComparedPoints = 1 << 16;  // of all maps together

/// What is kept of a map to compare the others with: not its texels.
struct IntactMap {
    int index;
    const DepthMap* frame;
    std::string texel_hash;
    std::vector<glm::dvec3> surface;
};

class Inspector {
  public:
    Inspector(std::span<const std::byte> bytes, const ContainerLimits& limits) : reader_(bytes, limits) {
        result_.file_size = bytes.size();
    }

    Inspection run() {
        reader_.readDescription();
        result_.header = reader_.header_state;
        result_.metadata = reader_.metadata_state;
        result_.major = reader_.header.major;
        result_.minor = reader_.header.minor;
        for (std::size_t i = 0; i < reader_.maps.size(); ++i) {
            result_.maps.push_back(inspectMap(static_cast<int>(i)));
        }
        // Map by map; those of the whole file, −1, last: they are of bytes behind the maps.
        std::stable_sort(reader_.issues.begin() + static_cast<std::ptrdiff_t>(reader_.first_map_issue),
                         reader_.issues.end(), [](const Issue& a, const Issue& b) {
                             return static_cast<unsigned>(a.map) < static_cast<unsigned>(b.map);
                         });
        compareMaps();
        settleStates();
        result_.issues = std::move(reader_.issues);
        return std::move(result_);
    }

  private:
    MapInspection inspectMap(int index) {
        StoredMap& map = reader_.maps[static_cast<std::size_t>(index)];
        MapInspection state;
        state.payload = map.payload;
        if (map.framed) {
            state.frame = map.frame;
        }
        if (!map.readable) {
            return state;
        }
        state.state = PartState::kDamaged;
        if (reader_.readTexels(static_cast<std::size_t>(index))) {
            TexelInspection texels =
                MapInspector(map.frame, reader_.bounds_valid ? &reader_.collider.bounds : nullptr).run();
            state.coverage = texels.coverage;
            if (map.intact) {  // else anything suspicious comes from the damage
                for (Issue& issue : texels.issues) {
                    issue.map = index;
                    reader_.issues.push_back(std::move(issue));
                }
                intact_.push_back(
                    {index, &map.frame, xxh3_128Hex(map.frame.texels), std::move(texels.surface)});
                state.state = PartState::kSound;
            }
        }
        map.frame.texels = std::vector<std::byte>();  // = {} would keep the memory
        return state;
    }

    /// Checks what no map shows by itself.
    void compareMaps() {
        for (std::size_t i = 0; i < intact_.size(); ++i) {
            for (std::size_t k = 0; k < i; ++k) {
                if (intact_[k].texel_hash == intact_[i].texel_hash &&
                    *intact_[k].frame == *intact_[i].frame) {
                    reader_.add(IssueCode::kDuplicateMap,
                                "it is map " + std::to_string(intact_[k].index) + " once more", {},
                                intact_[i].index);
                    break;
                }
            }
        }
        thinOut();
        for (const IntactMap& map : intact_) {
            if (map.frame->encloses) {
                compareWithVolume(map);
            }
        }
    }

    /// Compares every map with every other, with fewer points each where there are many maps.
    void thinOut() {
        const std::size_t keep = std::max<std::size_t>(1, kComparedPoints / (intact_.size() + 1));
        for (IntactMap& map : intact_) {
            const std::size_t step = map.surface.size() / keep + 1;
            std::vector<glm::dvec3> kept;
            for (std::size_t i = 0; i < map.surface.size(); i += step) {
                kept.push_back(map.surface[i]);
            }
            map.surface = std::move(kept);
        }
    }

    void compareWithVolume(const IntactMap& map) {
        std::size_t points = 0;
        std::size_t outside = 0;
        for (const IntactMap& other : intact_) {
            if (other.index != map.index) {
                points += other.surface.size();
                outside += countOutsideVolume(*map.frame, other.surface);
            }
        }
        if (static_cast<double>(outside) > kOutsideVolumeShare * static_cast<double>(points)) {
            reader_.add(
                IssueCode::kOutsideVolume,
                std::to_string(outside) + " of " + std::to_string(points) +
                    " surface points of other maps lie outside of its volume, which is said to enclose the "
                    "collider",
                {}, map.index);
        }
    }

    /// A warning makes a sound part suspicious; a sound map under damaged metadata is not verified.
    void settleStates() {
        for (const Issue& issue : reader_.issues) {
            if (issue.map >= 0) {
                PartState& state = result_.maps[static_cast<std::size_t>(issue.map)].state;
                if (state == PartState::kSound) {
                    state =
                        issue.severity() == Severity::kWarning ? PartState::kSuspicious : PartState::kDamaged;
                }
            }
        }
        if (!reader_.metadata_intact) {
            for (MapInspection& map : result_.maps) {
                if (map.state == PartState::kSound || map.state == PartState::kSuspicious) {
                    map.state = PartState::kUnverified;
                }
            }
        }
    }

    ContainerReader reader_;
    std::vector<IntactMap> intact_;
    Inspection result_;
};

}  // namespace

Result<Inspection> inspectContainer(std::span<const std::byte> bytes, const ContainerLimits& limits) {
    return withinMemory([&]() -> Result<Inspection> { return Inspector(bytes, limits).run(); });
}

std::size_t Inspection::count(Severity severity) const {
    return static_cast<std::size_t>(
        std::ranges::count_if(issues, [&](const Issue& issue) { return issue.severity() == severity; }));
}

bool Inspection::damaged() const {
    return std::ranges::any_of(issues,
                               [](const Issue& issue) { return issue.severity() != Severity::kWarning; });
}

ErrorCode Inspection::errorCode() const {
    return errorCodeOf(issues);
}

}  // namespace relief

#include "formats/inspect.h"

#include <algorithm>

#include "formats/base/hash.h"
#include "formats/container_reader.h"
#include "formats/inspect_texels.h"

namespace relief {
namespace {

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
                inspectTexels(map.frame, reader_.bounds_valid ? &reader_.collider.bounds : nullptr);
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

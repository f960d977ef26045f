// SPDX-License-Identifier: Apache-2.0
#include "formats/inspect.h"

#include <algorithm>

#include "formats/container_reader.h"

namespace relief {
namespace {

/// Returns the fraction of texels with a surface, 0…1.
double coverageOf(const DepthMap& map) {
    if (map.projection() == Projection::kLocal) {
        return 1.0;  // patches exist only where there is a surface
    }
    std::size_t texels = 0;
    std::size_t covered = 0;
    for (std::uint32_t face = 0; face < map.faceCount(); ++face) {
        for (std::uint32_t y = 0; y < map.height; ++y) {
            for (std::uint32_t x = 0; x < map.width; ++x) {
                const Texel texel = decodeTexel(map.format, map.texelAt(face, x, y));
                covered += texel.front || texel.back ? 1 : 0;
                ++texels;
            }
        }
    }
    return static_cast<double>(covered) / static_cast<double>(texels);
}

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
        // Sort by map; issues of the whole file (−1) come last because they concern bytes after the maps.
        std::stable_sort(reader_.issues.begin() + static_cast<std::ptrdiff_t>(reader_.first_map_issue),
                         reader_.issues.end(), [](const Issue& a, const Issue& b) {
                             return static_cast<unsigned>(a.map) < static_cast<unsigned>(b.map);
                         });
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
            state.coverage = coverageOf(map.frame);
            if (map.intact) {  // otherwise the damage would cause warnings
                state.state = PartState::kSound;
                if (state.coverage == 0.0) {
                    reader_.add(IssueCode::kNothingCovered, "no texel contains a surface; the map is empty",
                                {}, index);
                }
            }
        }
        map.frame.texels = std::vector<std::byte>();  // assigning {} would keep the allocation
        return state;
    }

    /// Downgrades sound sections with a warning to suspicious, and sound maps under damaged metadata to unverified.
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

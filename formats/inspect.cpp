#include "formats/inspect.h"

#include <algorithm>
#include <cstring>
#include <exception>

#include "formats/base/hash.h"
#include "formats/container.h"
#include "formats/container_header.h"
#include "formats/container_parts.h"
#include "formats/inspect_texels.h"
#include "formats/validate.h"

namespace relief {
namespace {

bool isLimit(IssueCode code) {
    return code == IssueCode::kMetadataLimit || code == IssueCode::kMapLimit ||
           code == IssueCode::kMapSizeLimit || code == IssueCode::kTexelLimit;
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
    Inspector(std::span<const std::byte> bytes, const ContainerLimits& limits)
        : bytes_(bytes), limits_(limits) {
        result_.file_size = bytes.size();
    }

    Inspection run() {
        if (inspectVersion() && inspectSizes() && inspectMetadata()) {
            inspectDescription();
            inspectMaps();
        }
        // The reader has the last word: it may refuse what the checks above miss.
        if (!result_.damaged()) {
            if (const Result<Collider> read = readContainer(bytes_, limits_); !read) {
                add(IssueCode::kRefused, read.error().message);
            }
        }
        settleStates();
        return std::move(result_);
    }

  private:
    void add(IssueCode code, std::string message, std::optional<std::uint64_t> offset = {}, int map = -1) {
        result_.issues.push_back({code, map, offset, std::move(message)});
    }

    /// Checks the header's signature, checksum and version, and the fields that version 1 fixes.
    /// \return whether the rest of the header can be understood.
    bool inspectVersion() {
        if (bytes_.size() < sizeof(header_)) {
            add(IssueCode::kTooShort, std::to_string(bytes_.size()) + " bytes, where the header alone has " +
                                          std::to_string(sizeof(header_)));
            return false;
        }
        std::memcpy(&header_, bytes_.data(), sizeof(header_));
        const ContainerHeader expected;
        if (header_.signature != expected.signature) {
            add(IssueCode::kSignature, "bytes 0...11 are not the signature of a .relief container", 0);
            return false;
        }
        result_.major = header_.major;
        result_.minor = header_.minor;
        header_intact_ = header_.header_hash == header_.computeHash();
        if (!header_intact_) {
            add(IssueCode::kHeaderChecksum, "the checksum of the header is wrong", 56);
        }
        if (header_.major != kContainerMajor) {
            add(IssueCode::kMajorVersion,
                "container version " + std::to_string(header_.major) + "." + std::to_string(header_.minor) +
                    ", this program reads version " + std::to_string(kContainerMajor),
                12);
            return false;
        }
        if (header_.header_size != expected.header_size || header_.reserved != expected.reserved ||
            header_.metadata_offset != expected.metadata_offset) {
            add(IssueCode::kHeaderField, "header_size, reserved or metadata_offset is not that of version 1",
                16);
            header_.metadata_offset = expected.metadata_offset;
        }
        result_.header = result_.damaged() ? PartState::kDamaged : PartState::kSound;
        return true;
    }

    /// Checks what the header says of the sizes of the file and of the metadata.
    /// \return whether the metadata can be looked at.
    bool inspectSizes() {
        if (header_.file_size > bytes_.size()) {
            add(IssueCode::kTruncated,
                "truncated: " + std::to_string(bytes_.size()) + " of " + std::to_string(header_.file_size) +
                    " bytes",
                24);
        } else if (header_.file_size < bytes_.size()) {
            add(IssueCode::kTrailingBytes,
                std::to_string(bytes_.size() - header_.file_size) + " bytes more than the header says", 24);
        }
        if (header_intact_ && header_.minor > kContainerMinor) {
            add(IssueCode::kLaterMinor,
                "container version " + std::to_string(header_.major) + "." + std::to_string(header_.minor) +
                    ", this program knows " + std::to_string(kContainerMajor) + "." +
                    std::to_string(kContainerMinor),
                14);
        }
        if (header_.metadata_size > kContainerMetadataMax) {
            add(IssueCode::kMetadataLimit,
                "metadata_size is " + std::to_string(header_.metadata_size) + ", at most " +
                    std::to_string(kContainerMetadataMax) + " are allowed",
                40);
            return false;
        }
        if (header_.metadata_size > bytes_.size() - sizeof(header_)) {
            add(IssueCode::kMetadataPlace,
                "the metadata of " + std::to_string(header_.metadata_size) + " bytes reaches beyond the end",
                40);
            return false;
        }
        return true;
    }

    /// \return whether its maps can be looked at.
    bool inspectMetadata() {
        const auto metadata = bytes_.subspan(header_.metadata_offset, header_.metadata_size);
        // A right checksum vouches for the metadata, whatever else is wrong with the header.
        metadata_intact_ = header_.metadata_hash == xxh3_64(metadata);
        result_.metadata = metadata_intact_ ? PartState::kSound : PartState::kDamaged;
        if (!metadata_intact_) {
            add(IssueCode::kMetadataChecksum, "the checksum of the metadata is wrong", 48);
        }
        Result<ParsedMetadata> parsed = parseMetadata(metadata, limits_.maps);
        if (!parsed) {
            const bool limit = parsed.error().code == ErrorCode::kLimit;
            add(limit ? IssueCode::kMapLimit : IssueCode::kMetadataTable, parsed.error().message,
                header_.metadata_offset);
            result_.metadata = PartState::kUnreadable;
            return false;
        }
        parsed_ = std::move(*parsed);
        return true;
    }

    void inspectDescription() {
        // Each field by itself, the others left at values that are valid.
        const auto inspect = [&](IssueCode code, const auto& fill) {
            Collider probe;
            probe.bounds = {glm::vec3(0.0F), glm::vec3(0.0F)};
            fill(probe);
            if (const Result<void> ok = validateDescription(probe); !ok) {
                add(code, ok.error().message);
                result_.metadata = PartState::kDamaged;
                return false;
            }
            return true;
        };
        const Collider& collider = parsed_.collider;
        const Provenance& from = collider.provenance;
        bounds_valid_ = inspect(IssueCode::kBounds, [&](Collider& probe) { probe.bounds = collider.bounds; });
        inspect(IssueCode::kUnit, [&](Collider& probe) { probe.unit = collider.unit; });
        const auto text = [&](std::string Provenance::*field) {
            inspect(IssueCode::kProvenance, [&](Collider& probe) { probe.provenance.*field = from.*field; });
        };
        text(&Provenance::mesh_name);
        text(&Provenance::mesh_hash);
        text(&Provenance::tool_version);
        text(&Provenance::options);
        if (from.mesh_hash.empty()) {
            add(IssueCode::kNoMeshHash, "provenance.mesh_hash is empty: nobody can tell which mesh it is of");
        }
        if (from.tool_version.empty() || from.options.empty()) {
            add(IssueCode::kNoToolVersion,
                "provenance.tool_version or .options is empty: nobody can tell how it was made");
        }
        if (from.triangles == 0) {
            add(IssueCode::kNoTriangles, "provenance.triangles is 0");
        }
        if (parsed_.maps.empty()) {
            add(IssueCode::kNoMap, "there is no map");
            result_.metadata = PartState::kDamaged;
        }
    }

    void inspectMaps() {
        result_.maps.resize(parsed_.maps.size());
        std::uint64_t end = header_.metadata_offset + header_.metadata_size;
        std::uint64_t texel_bytes = 0;
        bool limit_passed = false;
        bool all_placed = !parsed_.maps.empty();
        for (std::size_t i = 0; i < parsed_.maps.size(); ++i) {
            ParsedMap& map = parsed_.maps[i];
            const int index = static_cast<int>(i);
            const PayloadInfo& payload = map.payload.info;
            result_.maps[i].payload = payload;
            const bool framed = inspectFrame(map, index);
            const bool placed = inspectPlace(payload, index, end);
            all_placed = all_placed && placed;
            if (placed || payload.offset == alignPayload(end)) {
                // The next payload has its place even in a file that was cut off.
                constexpr std::uint64_t kFar = std::uint64_t{1} << 60;  // their sum does not wrap
                end = std::min(payload.offset, kFar) + std::min(payload.stored_size, kFar);
            }
            if (framed && payload.raw_size <= limits_.texel_bytes) {
                texel_bytes += payload.raw_size;
            } else if (framed) {
                texel_bytes = limits_.texel_bytes + 1;
            }
            if (const auto beyond = texelsBeyond(limits_, texel_bytes, bytes_.size());
                beyond && !limit_passed) {
                limit_passed = true;
                add(IssueCode::kTexelLimit, *beyond, {}, index);
            }
            if (framed && placed && !limit_passed) {
                inspectPayload(map, index);
                map.frame.texels = std::vector<std::byte>();  // = {} would keep the memory
            }
        }
        // A size that is not the header's has been reported already.
        if (all_placed && header_.file_size == bytes_.size() && end < bytes_.size()) {
            add(IssueCode::kBytesBehind,
                std::to_string(bytes_.size() - end) + " bytes follow the last payload", end);
        }
        compareMaps();
    }

    bool inspectFrame(const ParsedMap& map, int index) {
        if (const Result<void> ok = validateFrame(map.frame); !ok) {
            const bool limit = ok.error().code == ErrorCode::kLimit;
            add(limit ? IssueCode::kMapSizeLimit : IssueCode::kFrame, ok.error().message, {}, index);
            return false;
        }
        result_.maps[static_cast<std::size_t>(index)].frame = map.frame;
        if (const Result<void> ok = validatePayloadSizes(map); !ok) {
            add(IssueCode::kPayloadSize, ok.error().message, {}, index);
            return false;
        }
        return true;
    }

    /// \param end  of what lies before the payload.
    /// \return whether the payload lies within the file.
    bool inspectPlace(const PayloadInfo& payload, int index, std::uint64_t end) {
        const std::uint64_t expected = alignPayload(end);
        if (payload.offset != expected) {
            add(IssueCode::kPayloadPlace,
                "its payload's offset is " + std::to_string(payload.offset) + " where the layout has " +
                    std::to_string(expected),
                {}, index);
        }
        if (payload.offset > bytes_.size() || payload.stored_size > bytes_.size() - payload.offset) {
            add(IssueCode::kPayloadEnd,
                "its payload of " + std::to_string(payload.stored_size) + " bytes reaches beyond the end",
                payload.offset, index);
            return false;
        }
        if (payload.offset != expected) {
            return true;
        }
        const auto padding = bytes_.subspan(end, expected - end);
        const auto at = std::ranges::find_if(padding, [](std::byte b) { return b != std::byte{0}; });
        if (at != padding.end()) {
            add(IssueCode::kPadding, "padding before its payload is not zero",
                end + static_cast<std::uint64_t>(at - padding.begin()), index);
        }
        return true;
    }

    void inspectPayload(ParsedMap& map, int index) {
        MapInspection& state = result_.maps[static_cast<std::size_t>(index)];
        state.state = PartState::kDamaged;
        const PayloadInfo& payload = map.payload.info;
        const auto stored = bytes_.subspan(payload.offset, payload.stored_size);
        const bool intact = map.payload.hash == xxh3_64(stored);
        if (!intact) {
            add(IssueCode::kPayloadChecksum, "the checksum of its payload is wrong", payload.offset, index);
        }
        Result<std::vector<std::byte>> unpacked = unpackPayload(stored, map);
        if (!unpacked) {
            add(IssueCode::kPayloadUnpack, unpacked.error().message, payload.offset, index);
            return;
        }
        map.frame.texels = std::move(*unpacked);
        if (const Result<void> ok = validateTexels(map.frame); !ok) {
            add(IssueCode::kTexels, ok.error().message, payload.offset, index);
            return;
        }
        TexelInspection texels = inspectTexels(map.frame, bounds_valid_ ? &parsed_.collider.bounds : nullptr);
        state.coverage = texels.coverage;
        if (!intact) {
            return;  // anything suspicious comes from the damage
        }
        for (Issue& issue : texels.issues) {
            issue.map = index;
            result_.issues.push_back(std::move(issue));
        }
        intact_.push_back({index, &map.frame, xxh3_128Hex(map.frame.texels), std::move(texels.surface)});
        state.state = PartState::kSound;
    }

    /// Checks what no map shows by itself.
    void compareMaps() {
        for (std::size_t i = 0; i < intact_.size(); ++i) {
            for (std::size_t k = 0; k < i; ++k) {
                if (intact_[k].texel_hash == intact_[i].texel_hash &&
                    *intact_[k].frame == *intact_[i].frame) {
                    add(IssueCode::kDuplicateMap,
                        "it is map " + std::to_string(intact_[k].index) + " once more", {}, intact_[i].index);
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
            add(IssueCode::kOutsideVolume,
                std::to_string(outside) + " of " + std::to_string(points) +
                    " surface points of other maps lie outside of its volume, which is said to enclose the "
                    "collider",
                {}, map.index);
        }
    }

    /// A warning makes a sound part suspicious; a sound map under damaged metadata is not verified.
    void settleStates() {
        for (const Issue& issue : result_.issues) {
            if (issue.map >= 0) {
                PartState& state = result_.maps[static_cast<std::size_t>(issue.map)].state;
                if (state == PartState::kSound) {
                    state =
                        issue.severity() == Severity::kWarning ? PartState::kSuspicious : PartState::kDamaged;
                }
            }
        }
        if (!metadata_intact_) {
            for (MapInspection& map : result_.maps) {
                if (map.state == PartState::kSound || map.state == PartState::kSuspicious) {
                    map.state = PartState::kUnverified;
                }
            }
        }
    }

    std::span<const std::byte> bytes_;
    ContainerLimits limits_;
    ContainerHeader header_;
    ParsedMetadata parsed_;
    bool header_intact_ = false;
    bool metadata_intact_ = false;
    bool bounds_valid_ = false;
    std::vector<IntactMap> intact_;
    Inspection result_;
};

}  // namespace

Result<Inspection> inspectContainer(std::span<const std::byte> bytes, const ContainerLimits& limits) {
    try {
        return Inspector(bytes, limits).run();
    } catch (const std::exception&) {
        return fail(ErrorCode::kLimit, "the collider does not fit into memory");
    }
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
    bool limits_alone = true;
    for (const Issue& issue : issues) {
        if (issue.code == IssueCode::kMajorVersion) {
            return ErrorCode::kUnsupported;
        }
        limits_alone = limits_alone && (issue.severity() == Severity::kWarning || isLimit(issue.code));
    }
    return limits_alone ? ErrorCode::kLimit : ErrorCode::kInvalidInput;
}

}  // namespace relief

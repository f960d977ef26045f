// SPDX-License-Identifier: Apache-2.0
#include "formats/container_reader.h"

#include <flatbuffers/flatbuffers.h>

#include <algorithm>
#include <cstring>
#include <memory>
#include <string>

#include "collider_generated.h"
#include "formats/base/hash.h"
#include "formats/compression.h"
#include "formats/validate.h"

namespace relief {
namespace {

/// zstd compresses at most 128 KiB into four bytes, so a payload that claims a higher ratio is invalid.
constexpr std::uint64_t kZstdRatioMax = 32768;
constexpr flatbuffers::uoffset_t kMetadataDepthMax = 4;  // collider, provenance, option

glm::vec3 fromFb(const fb::Vec3& v) {
    return {v.x(), v.y(), v.z()};
}

glm::vec4 fromFb(const fb::Row& r) {
    return {r.x(), r.y(), r.z(), r.w()};
}

/// Returns a map without its texels.
DepthMap readFrame(const fb::Map& map) {
    DepthMap frame;
    frame.format = static_cast<MapFormat>(map.format());
    frame.compare = static_cast<Compare>(map.compare());
    frame.decode = static_cast<Decode>(map.decode());
    frame.width = map.width();
    frame.height = map.height();
    const fb::Transform& transform = *map.object_to_map();
    frame.object_to_map.row[0] = fromFb(transform.row0());
    frame.object_to_map.row[1] = fromFb(transform.row1());
    frame.object_to_map.row[2] = fromFb(transform.row2());
    frame.object_per_map = fromFb(*map.object_per_map());
    frame.encloses = map.encloses();
    frame.empty_is_outside = map.empty_is_outside();
    return frame;
}

/// Returns the reason why texels exceed the limits for a file, or nullopt if they may be unpacked.
std::optional<std::string> texelsBeyond(const ContainerLimits& limits, std::uint64_t texel_bytes,
                                        std::uint64_t file_size) {
    if (texel_bytes > limits.texel_bytes) {
        return "with this map, the texels exceed the limit of " + std::to_string(limits.texel_bytes) +
               " bytes";
    }
    const std::uint64_t proportional = kUnpackedPerStored * std::min(file_size, limits.texel_bytes);
    if (texel_bytes > std::max(limits.memory, proportional)) {
        return "with this map, the texels take " + std::to_string(texel_bytes) + " bytes in memory, " +
               std::to_string(texel_bytes / std::max<std::uint64_t>(file_size, 1)) +
               " times the file; if you trust the file, raise --max-memory";
    }
    return std::nullopt;
}

/// Checks that a payload's sizes match its frame, which must be valid. Does not check its offset.
Result<void> validatePayloadSizes(const StoredMap& map) {
    const PayloadInfo& info = map.payload;
    if (info.packing > Packing::kZstd) {
        return invalidInput("its compression " + std::to_string(static_cast<int>(info.packing)) +
                            " is unknown");
    }
    if (info.raw_size != map.frame.texelBytes()) {
        return invalidInput("its raw_size is " + std::to_string(info.raw_size) +
                            " but its size and format require " + std::to_string(map.frame.texelBytes()) +
                            " bytes");
    }
    const bool packed = info.packing != Packing::kNone;
    if (packed ? info.stored_size >= info.raw_size : info.stored_size != info.raw_size) {
        return invalidInput("its stored_size " + std::to_string(info.stored_size) +
                            " does not match its raw_size " + std::to_string(info.raw_size) +
                            " and its compression");
    }
    if (packed && info.raw_size / kZstdRatioMax > info.stored_size) {
        return invalidInput("its " + std::to_string(info.stored_size) +
                            " stored bytes cannot unpack to a raw_size of " + std::to_string(info.raw_size));
    }
    return {};
}

/// Decompresses the texels of a payload, whose sizes must have been checked.
Result<std::vector<std::byte>> unpackPayload(std::span<const std::byte> stored, const PayloadInfo& payload) {
    if (payload.packing == Packing::kZstd) {
        return decompress(stored, payload.raw_size);
    }
    return std::vector<std::byte>(stored.begin(), stored.end());
}

/// Reads the materials; checks only the size of their nodes.
Result<Materials> readMaterials(const fb::Materials& stored) {
    Materials materials;
    const auto is_long = [](const fb::Material* one) { return one->name()->size() > kMaterialNameMax; };
    if (stored.list()->size() > kMaterialsMax ||
        std::any_of(stored.list()->begin(), stored.list()->end(), is_long) ||
        (stored.sides() != nullptr && stored.sides()->size() > kMaterialSidesMax)) {
        return invalidInput("it has more than " + std::to_string(kMaterialsMax) +
                            " materials, or one with a name of more than " +
                            std::to_string(kMaterialNameMax) + " bytes; bake the mesh again");
    }
    for (const fb::Material* one : *stored.list()) {
        materials.list.push_back({one->name()->str(), one->restitution(), one->friction(),
                                  one->lifetime_loss(), one->area_fraction()});
    }
    if (stored.sides() != nullptr) {
        for (const fb::MaterialSides* pair : *stored.sides()) {
            materials.sides.push_back({pair->axis(), pair->towards(), pair->against()});
        }
    }
    materials.origin = fromFb(*stored.origin());
    materials.size = stored.size();
    if (stored.nodes() == nullptr && stored.nodes_size() == 0) {
        return materials;
    }
    const std::span<const std::byte> bytes =
        stored.nodes() == nullptr ? std::span<const std::byte>()
                                  : std::as_bytes(std::span(stored.nodes()->data(), stored.nodes()->size()));
    const std::uint32_t size = stored.nodes_size();
    const auto packing = static_cast<Packing>(stored.compression());
    if (size > kMaterialNodesMax * sizeof(MaterialNode) || size % sizeof(MaterialNode) != 0 ||
        (packing == Packing::kNone ? size != bytes.size()
                                   : packing != Packing::kZstd || size <= bytes.size())) {
        return invalidInput("materials.nodes_size does not match the stored nodes");
    }
    std::vector<std::byte> nodes(bytes.begin(), bytes.end());
    if (packing == Packing::kZstd) {
        nodes = RELIEF_TRY(withPrefix("the nodes of the materials", decompress(bytes, size)));
    }
    if (size > 0) {  // memcpy() must not be called with null pointers
        materials.nodes.resize(size / sizeof(MaterialNode));
        std::memcpy(materials.nodes.data(), nodes.data(), nodes.size());
    }
    return materials;
}

bool isLimit(IssueCode code) {
    return code == IssueCode::kMetadataLimit || code == IssueCode::kMapLimit ||
           code == IssueCode::kMapSizeLimit || code == IssueCode::kTexelLimit;
}

}  // namespace

std::string fixFor(IssueCode code, std::uint16_t major) {
    switch (code) {
        case IssueCode::kTooShort:
            return "; it is truncated, or not a .relief container";
        case IssueCode::kSignature:
            return "; it is not a .relief container, or a text-mode transfer has damaged it";
        case IssueCode::kMajorVersion:
            return major < kContainerMajor ? ": bake the mesh again" : "; use a newer Relief";
        default:
            return isLimit(code) ? "" : "; copy the file again, or bake it again";
    }
}

std::uint64_t containerSizeMax(const ContainerLimits& limits) {
    const std::uint64_t texel_bytes = std::min(limits.texel_bytes, std::uint64_t{1} << 62);
    return sizeof(ContainerHeader) + kContainerMetadataMax + texel_bytes + limits.maps * kPayloadAlignment;
}

const char* packingName(Packing packing) {
    return packing == Packing::kZstd ? "zstd" : "none";
}

void ContainerReader::add(IssueCode code, std::string message, std::optional<std::uint64_t> offset, int map) {
    issues.push_back({code, map, offset, std::move(message)});
}

void ContainerReader::readDescription() {
    if (readHeader() && checkSizes() && readMetadata()) {
        checkDescription();
        checkMaps();
    }
}

/// Checks the signature, the version, the checksum, and the fields with fixed values in version 2.
/// \return whether the rest of the header can be interpreted.
bool ContainerReader::readHeader() {
    if (bytes_.size() < sizeof(header)) {
        add(IssueCode::kTooShort,
            std::to_string(bytes_.size()) + " bytes, but a header has " + std::to_string(sizeof(header)));
        return false;
    }
    ContainerHeader read;
    std::memcpy(&read, bytes_.data(), sizeof(read));
    if (read.signature != ContainerHeader::kSignature) {
        add(IssueCode::kSignature, "bytes 0...11 are not the signature of a .relief container", 0);
        return false;
    }
    header = read;
    const ContainerHeader expected;
    // Another major version may have a different layout and checksum.
    if (header.major != expected.major) {
        add(IssueCode::kMajorVersion, "container version " + std::to_string(header.major) + "." +
                                          std::to_string(header.minor) + "; this program reads version " +
                                          std::to_string(kContainerMajor));
        return false;
    }
    header_intact_ = header.header_hash == header.computeHash();
    if (!header_intact_) {
        add(IssueCode::kHeaderChecksum, "the checksum of the header does not match", 56);
    }
    if (header.header_size != expected.header_size || header.reserved != expected.reserved ||
        header.metadata_offset != expected.metadata_offset) {
        add(IssueCode::kHeaderField, "header_size, reserved or metadata_offset is not that of version 2", 16);
        header.metadata_offset = expected.metadata_offset;
    }
    header_state = issues.empty() ? PartState::kSound : PartState::kDamaged;
    return true;
}

/// Checks the sizes of the file and of the metadata in the header.
/// \return whether the metadata can be read.
bool ContainerReader::checkSizes() {
    if (header.file_size > bytes_.size()) {
        add(IssueCode::kTruncated,
            "truncated: " + std::to_string(bytes_.size()) + " of " + std::to_string(header.file_size) +
                " bytes",
            24);
    } else if (header.file_size < bytes_.size()) {
        add(IssueCode::kTrailingBytes,
            std::to_string(bytes_.size() - header.file_size) + " bytes more than stated in the header", 24);
    }
    if (header_intact_ && header.minor > kContainerMinor) {
        add(IssueCode::kLaterMinor,
            "container version " + std::to_string(header.major) + "." + std::to_string(header.minor) +
                "; this program supports " + std::to_string(kContainerMajor) + "." +
                std::to_string(kContainerMinor),
            14);
    }
    if (header.metadata_size > kContainerMetadataMax) {
        add(IssueCode::kMetadataLimit,
            "metadata_size is " + std::to_string(header.metadata_size) + "; at most " +
                std::to_string(kContainerMetadataMax) + " are allowed",
            40);
        return false;
    }
    if (header.metadata_size > bytes_.size() - sizeof(header)) {
        add(IssueCode::kMetadataPlace,
            "the metadata of " + std::to_string(header.metadata_size) + " bytes extends beyond the end", 40);
        return false;
    }
    return true;
}

/// \return whether there are maps to read.
bool ContainerReader::readMetadata() {
    const auto bytes = part(header.metadata_offset, header.metadata_size);
    // A valid checksum confirms the metadata even if the header is damaged.
    metadata_intact = header.metadata_hash == xxh3_64(bytes);
    if (!metadata_intact) {
        add(IssueCode::kMetadataChecksum, "the checksum of the metadata does not match", 48);
    }
    const std::size_t before = issues.size();
    // Accessors require an alignment that the file has but `bytes_` may lack.
    const auto aligned = std::make_unique<std::uint64_t[]>(bytes.size() / sizeof(std::uint64_t) + 1);
    std::memcpy(aligned.get(), bytes.data(), bytes.size());
    const auto* data = reinterpret_cast<const std::uint8_t*>(aligned.get());
    flatbuffers::Verifier verifier(data, bytes.size(), kMetadataDepthMax);
    if (!fb::VerifyColliderBuffer(verifier)) {
        add(IssueCode::kMetadataTable,
            "the metadata at byte " + std::to_string(sizeof(header)) +
                " is not a FlatBuffers table of a collider",
            header.metadata_offset);
        return false;
    }
    const fb::Collider& metadata = *fb::GetCollider(data);
    const auto& stored = *metadata.maps();
    if (stored.size() > limits_.maps) {
        add(IssueCode::kMapLimit,
            std::to_string(stored.size()) + " maps exceed the limit of " + std::to_string(limits_.maps),
            header.metadata_offset);
        return false;
    }
    collider.bounds = {fromFb(*metadata.bounds_min()), fromFb(*metadata.bounds_max())};
    collider.unit = metadata.unit()->str();
    const fb::Provenance& from = *metadata.provenance();
    collider.provenance = {
        from.mesh_name()->str(), from.mesh_hash()->str(), from.triangles(), from.tool_version()->str(), {}};
    if (from.options() != nullptr) {
        // Many options may share one text, so the total can exceed the file.
        std::uint64_t text_bytes = 0;
        for (const fb::Option* option : *from.options()) {
            text_bytes += std::uint64_t{option->name()->size()} + option->value()->size();
        }
        if (text_bytes > kContainerMetadataMax) {
            add(IssueCode::kMetadataTable,
                "the options take " + std::to_string(text_bytes) + " bytes; bake the mesh again",
                header.metadata_offset);
            return false;
        }
        for (const fb::Option* option : *from.options()) {
            collider.provenance.options.push_back({option->name()->str(), option->value()->str()});
        }
    }
    if (metadata.animation() != nullptr) {
        const auto animation =
            std::as_bytes(std::span(metadata.animation()->data(), metadata.animation()->size()));
        collider.animation.assign(animation.begin(), animation.end());
    }
    if (metadata.materials() != nullptr) {
        if (Result<Materials> materials = readMaterials(*metadata.materials())) {
            collider.materials = std::move(*materials);
        } else {
            add(IssueCode::kMaterials, materials.error().message);
        }
    }
    for (const fb::Map* map : stored) {
        const fb::Payload& payload = *map->payload();
        maps.push_back({readFrame(*map),
                        {payload.offset(), payload.stored_size(), payload.raw_size(),
                         static_cast<Packing>(map->compression())},
                        payload.xxh3()});
    }
    metadata_state = metadata_intact && issues.size() == before ? PartState::kSound : PartState::kDamaged;
    return true;
}

void ContainerReader::checkDescription() {
    std::vector<Issue> invalid = descriptionIssues(collider);
    bounds_valid = invalid.empty() || invalid.front().code != IssueCode::kBounds;
    if (!invalid.empty() || maps.empty()) {
        metadata_state = PartState::kDamaged;
    }
    issues.insert(issues.end(), invalid.begin(), invalid.end());
    const Provenance& from = collider.provenance;
    if (from.mesh_hash.empty()) {
        add(IssueCode::kNoMeshHash, "provenance.mesh_hash is empty: the source mesh is unknown");
    }
    if (from.tool_version.empty() || from.options.empty()) {
        add(IssueCode::kNoToolVersion,
            "provenance.tool_version or .options is empty: the bake cannot be reproduced");
    }
    if (from.triangles == 0) {
        add(IssueCode::kNoTriangles, "provenance.triangles is 0");
    }
    if (maps.empty()) {
        add(IssueCode::kNoMap, "there are no maps");
    }
}

void ContainerReader::checkMaps() {
    first_map_issue = issues.size();
    std::uint64_t end = header.metadata_offset + header.metadata_size;
    std::uint64_t texel_bytes = 0;
    bool limit_passed = false;
    bool all_placed = !maps.empty();
    for (std::size_t i = 0; i < maps.size(); ++i) {
        StoredMap& map = maps[i];
        const int index = static_cast<int>(i);
        const PayloadInfo& payload = map.payload;
        const bool sized = checkFrame(map, index);
        const bool placed = checkPlace(payload, index, end);
        all_placed = all_placed && placed;
        if (placed || payload.offset == alignPayload(end)) {
            // Later payloads keep their expected offsets even in a truncated file.
            constexpr std::uint64_t kFar = std::uint64_t{1} << 60;  // large, but sums do not overflow
            end = std::min(payload.offset, kFar) + std::min(payload.stored_size, kFar);
        }
        texel_bytes += sized ? payload.raw_size : 0;
        if (const auto beyond = texelsBeyond(limits_, texel_bytes, bytes_.size()); beyond && !limit_passed) {
            limit_passed = true;
            add(IssueCode::kTexelLimit, *beyond, {}, index);
        }
        map.readable = sized && placed && !limit_passed;
    }
    // A size that differs from the header's has been reported already.
    if (all_placed && header.file_size == bytes_.size() && end < bytes_.size()) {
        add(IssueCode::kBytesAfterPayload,
            std::to_string(bytes_.size() - end) + " bytes follow the last payload", end);
    }
}

/// \return whether the frame and the payload's sizes are valid.
bool ContainerReader::checkFrame(StoredMap& map, int index) {
    if (const Result<void> ok = validateFrame(map.frame); !ok) {
        const bool limit = ok.error().code == ErrorCode::kLimit;
        add(limit ? IssueCode::kMapSizeLimit : IssueCode::kFrame, ok.error().message, {}, index);
        return false;
    }
    map.framed = true;
    if (const Result<void> ok = validatePayloadSizes(map); !ok) {
        add(IssueCode::kPayloadSize, ok.error().message, {}, index);
        return false;
    }
    return true;
}

/// Checks that payloads are contiguous: each at the next multiple of 64, with zeros between.
/// \param end  end of the data before the payload. \return whether the payload lies within the file.
bool ContainerReader::checkPlace(const PayloadInfo& payload, int index, std::uint64_t end) {
    const std::uint64_t expected = alignPayload(end);
    if (payload.offset != expected) {
        add(IssueCode::kPayloadPlace,
            "its payload's offset is " + std::to_string(payload.offset) + " instead of " +
                std::to_string(expected),
            {}, index);
    }
    if (payload.offset > bytes_.size() || payload.stored_size > bytes_.size() - payload.offset) {
        add(IssueCode::kPayloadEnd,
            "its payload of " + std::to_string(payload.stored_size) + " bytes extends beyond the end",
            payload.offset, index);
        return false;
    }
    if (payload.offset != expected) {
        return true;
    }
    const auto padding = part(end, expected - end);
    const auto at =
        std::find_if(padding.begin(), padding.end(), [](std::byte b) { return b != std::byte{0}; });
    if (at != padding.end()) {
        add(IssueCode::kPadding, "padding before its payload is not zero",
            end + static_cast<std::uint64_t>(at - padding.begin()), index);
    }
    return true;
}

bool ContainerReader::readTexels(std::size_t index) {
    StoredMap& map = maps[index];
    const auto at = static_cast<int>(index);
    const auto stored = part(map.payload.offset, map.payload.stored_size);
    map.intact = map.hash == xxh3_64(stored);
    if (!map.intact) {
        add(IssueCode::kPayloadChecksum, "the checksum of its payload does not match", map.payload.offset,
            at);
    }
    Result<std::vector<std::byte>> unpacked = unpackPayload(stored, map.payload);
    if (!unpacked) {
        add(IssueCode::kPayloadUnpack, unpacked.error().message, map.payload.offset, at);
        return false;
    }
    map.frame.texels = std::move(*unpacked);
    if (const Result<void> ok = validateTexels(map.frame); !ok) {
        add(IssueCode::kTexels, ok.error().message, map.payload.offset, at);
        return false;
    }
    return true;
}

std::optional<Error> ContainerReader::refusal() const {
    const auto first = std::find_if(issues.begin(), issues.end(), [](const Issue& issue) {
        return issue.severity() != Severity::kWarning;
    });
    if (first == issues.end()) {
        return std::nullopt;
    }
    const Error error{errorCodeOf(issues),
                      first->message + (first->offset ? ", at byte " + std::to_string(*first->offset) : "") +
                          fixFor(first->code, header.major)};
    return first->map < 0 ? error : inMap(static_cast<std::size_t>(first->map), error);
}

ErrorCode errorCodeOf(std::span<const Issue> issues) {
    bool only_limits = true;
    for (const Issue& issue : issues) {
        if (issue.code == IssueCode::kMajorVersion) {
            return ErrorCode::kUnsupported;
        }
        only_limits = only_limits && (issue.severity() == Severity::kWarning || isLimit(issue.code));
    }
    return only_limits ? ErrorCode::kLimit : ErrorCode::kInvalidInput;
}

}  // namespace relief

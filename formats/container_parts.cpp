#include "formats/container_parts.h"

#include <flatbuffers/flatbuffers.h>

#include <algorithm>
#include <cstring>
#include <memory>
#include <string>

#include "collider_generated.h"
#include "formats/compression.h"
#include "formats/container_header.h"
#include "formats/row_spans.h"

namespace relief {
namespace {

/// zstd packs at most a block of 128 KiB into four bytes, and an empty row of kMapSizeMax texels takes four, so a payload
/// that claims more is a lie.
constexpr std::uint64_t kZstdRatioMax = 32768;
constexpr flatbuffers::uoffset_t kMetadataDepthMax = 4;  // collider, map or provenance

glm::vec3 fromFb(const fb::Vec3& v) {
    return {v.x(), v.y(), v.z()};
}

glm::vec4 fromFb(const fb::Row& r) {
    return {r.x(), r.y(), r.z(), r.w()};
}

/// A map without its texels.
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

}  // namespace

std::uint64_t containerSizeMax(const ContainerLimits& limits) {
    const std::uint64_t texel_bytes = std::min(limits.texel_bytes, std::uint64_t{1} << 62);
    return sizeof(ContainerHeader) + kContainerMetadataMax + texel_bytes + limits.maps * kPayloadAlignment;
}

std::optional<std::string> texelsBeyond(const ContainerLimits& limits, std::uint64_t texel_bytes,
                                        std::uint64_t file_size) {
    if (texel_bytes > limits.texel_bytes) {
        return "with it, the texels take more than the limit of " + std::to_string(limits.texel_bytes) +
               " bytes";
    }
    const std::uint64_t worth = kUnpackedPerStored * std::min(file_size, limits.texel_bytes);
    if (texel_bytes > std::max(limits.memory, worth)) {
        return "with it, the texels take " + std::to_string(texel_bytes) + " bytes in memory, " +
               std::to_string(texel_bytes / std::max<std::uint64_t>(file_size, 1)) +
               " times the file; if you trust it, allow more with --max-memory";
    }
    return std::nullopt;
}

Result<ParsedMetadata> parseMetadata(std::span<const std::byte> bytes, std::uint32_t maps_max) {
    // Accessors need the alignment that the file has, and that `bytes` need not have.
    const auto aligned = std::make_unique<std::uint64_t[]>(bytes.size() / sizeof(std::uint64_t) + 1);
    std::memcpy(aligned.get(), bytes.data(), bytes.size());
    const auto* data = reinterpret_cast<const std::uint8_t*>(aligned.get());
    flatbuffers::Verifier verifier(data, bytes.size(), kMetadataDepthMax);
    if (!fb::VerifyColliderBuffer(verifier)) {
        return invalidInput("the metadata at byte " + std::to_string(sizeof(ContainerHeader)) +
                            " is no FlatBuffers table of a collider");
    }
    const fb::Collider& metadata = *fb::GetCollider(data);
    ParsedMetadata parsed;
    Collider& collider = parsed.collider;
    collider.bounds = {fromFb(*metadata.bounds_min()), fromFb(*metadata.bounds_max())};
    collider.unit = metadata.unit()->str();
    const fb::Provenance& from = *metadata.provenance();
    collider.provenance = {from.mesh_name()->str(), from.mesh_hash()->str(), from.triangles(),
                           from.tool_version()->str(), from.options()->str()};
    const auto& maps = *metadata.maps();
    if (maps.size() > maps_max) {
        return fail(ErrorCode::kLimit, std::to_string(maps.size()) + " maps are more than the limit of " +
                                           std::to_string(maps_max));
    }
    for (flatbuffers::uoffset_t i = 0; i < maps.size(); ++i) {
        const fb::Map& map = *maps.Get(i);
        const fb::Payload& payload = *map.payload();
        parsed.maps.push_back({readFrame(map),
                               {{payload.offset(), payload.stored_size(), payload.raw_size(),
                                 static_cast<Packing>(map.compression())},
                                payload.xxh3()}});
    }
    return parsed;
}

Result<void> validatePayloadSizes(const ParsedMap& map) {
    const PayloadInfo& info = map.payload.info;
    if (info.packing > Packing::kRows) {
        return invalidInput("its compression " + std::to_string(static_cast<int>(info.packing)) +
                            " is unknown");
    }
    if (info.packing == Packing::kRows && !isFrontBack(map.frame.format)) {
        return invalidInput(std::string("its compression \"rows\" does not go with its format \"") +
                            mapFormatName(map.frame.format) + "\"");
    }
    if (info.raw_size != map.frame.texelBytes()) {
        return invalidInput("its raw_size is " + std::to_string(info.raw_size) +
                            " where its size and format need " + std::to_string(map.frame.texelBytes()) +
                            " bytes");
    }
    const bool packed = info.packing != Packing::kNone;
    if (packed ? info.stored_size >= info.raw_size : info.stored_size != info.raw_size) {
        return invalidInput("its stored_size " + std::to_string(info.stored_size) +
                            " does not go with its raw_size " + std::to_string(info.raw_size) +
                            " and its compression");
    }
    if (packed && info.raw_size / kZstdRatioMax > info.stored_size) {
        return invalidInput("its " + std::to_string(info.stored_size) + " stored bytes cannot hold the " +
                            std::to_string(info.raw_size) + " that they claim");
    }
    return {};
}

const char* packingName(Packing packing) {
    switch (packing) {
        case Packing::kNone:
            return "none";
        case Packing::kZstd:
            return "zstd";
        case Packing::kRows:
            return "rows";
    }
    return "unknown";
}

Result<std::vector<std::byte>> unpackPayload(std::span<const std::byte> stored, const ParsedMap& map) {
    switch (map.payload.info.packing) {
        case Packing::kZstd:
            return decompress(stored, map.payload.info.raw_size);
        case Packing::kRows:
            return unpackRows(stored, map.frame);
        case Packing::kNone:
            break;
    }
    return std::vector<std::byte>(stored.begin(), stored.end());
}

}  // namespace relief

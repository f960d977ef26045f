// SPDX-License-Identifier: Apache-2.0
#include "formats/container.h"

#include <flatbuffers/flatbuffers.h>

#include <algorithm>
#include <array>
#include <cstring>
#include <string>
#include <string_view>

#include "collider_generated.h"
#include "formats/base/file_io.h"
#include "formats/base/hash.h"
#include "formats/base/result.h"
#include "formats/base/text.h"
#include "formats/compression.h"
#include "formats/container_reader.h"
#include "formats/validate.h"

namespace relief {
namespace {

constexpr int kZstdLevelMax = 19;

/// A payload in file form. `stored` refers to `packed`, or to the uncompressed bytes if `packed` is empty.
struct PackedPayload {
    Packing packing = Packing::kNone;
    std::vector<std::byte> packed;
    std::span<const std::byte> stored;
};

/// Compresses bytes with zstd if that makes them shorter.
Result<PackedPayload> packBytes(std::span<const std::byte> raw, int level) {
    PackedPayload packed;
    packed.stored = raw;
    if (level > 0 && !raw.empty()) {
        std::vector<std::byte> bytes = RELIEF_TRY(compress(raw, level));
        if (bytes.size() < raw.size()) {
            packed.packing = Packing::kZstd;
            packed.packed = std::move(bytes);
            packed.stored = packed.packed;
        }
    }
    return packed;
}

fb::Vec3 toFb(const glm::vec3& v) {
    return {v.x, v.y, v.z};
}

fb::Row toFb(const glm::vec4& r) {
    return {r.x, r.y, r.z, r.w};
}

flatbuffers::Offset<fb::Map> addMap(flatbuffers::FlatBufferBuilder& builder, const DepthMap& map,
                                    const fb::Payload& payload, Packing packing) {
    const fb::Transform transform(toFb(map.object_to_map.row[0]), toFb(map.object_to_map.row[1]),
                                  toFb(map.object_to_map.row[2]));
    const fb::Vec3 object_per_map = toFb(map.object_per_map);
    return fb::CreateMap(builder, static_cast<fb::Format>(map.format), static_cast<fb::Compare>(map.compare),
                         map.width, map.height, &transform, &object_per_map, map.encloses,
                         map.empty_is_outside, static_cast<fb::Compression>(packing), &payload,
                         static_cast<fb::Decode>(map.decode));
}

/// \param nodes  the nodes in file form.
flatbuffers::Offset<fb::Materials> addMaterials(flatbuffers::FlatBufferBuilder& builder,
                                                const Materials& materials, const PackedPayload& nodes) {
    if (materials.empty()) {
        return 0;
    }
    std::vector<flatbuffers::Offset<fb::Material>> list;
    for (const Material& one : materials.list) {
        const auto name = builder.CreateString(one.name);
        list.push_back(fb::CreateMaterial(builder, name, one.restitution, one.friction, one.lifetime_loss,
                                          one.area_fraction));
    }
    std::vector<fb::MaterialSides> sides;
    for (const MaterialSides& pair : materials.sides) {
        sides.emplace_back(pair.axis, pair.towards, pair.against);
    }
    const auto list_vector = builder.CreateVector(list);
    const flatbuffers::Offset<flatbuffers::Vector<const fb::MaterialSides*>> side_vector =
        sides.empty() ? 0 : builder.CreateVectorOfStructs(sides);
    const flatbuffers::Offset<flatbuffers::Vector<std::uint8_t>> node_vector =
        nodes.stored.empty()
            ? 0
            : builder.CreateVector(reinterpret_cast<const std::uint8_t*>(nodes.stored.data()),
                                   nodes.stored.size());
    const fb::Vec3 origin = toFb(materials.origin);
    return fb::CreateMaterials(builder, list_vector, side_vector, &origin, materials.size, node_vector,
                               static_cast<fb::Compression>(nodes.packing),
                               static_cast<std::uint32_t>(materials.nodes.size() * sizeof(MaterialNode)));
}

/// \param payloads  one for each map. Their offsets do not affect the size of the result.
std::vector<std::byte> writeMetadata(const Collider& collider, std::span<const fb::Payload> payloads,
                                     std::span<const PackedPayload> packed,
                                     const PackedPayload& material_nodes) {
    flatbuffers::FlatBufferBuilder builder;
    std::vector<flatbuffers::Offset<fb::Map>> maps;
    for (std::size_t i = 0; i < collider.maps.size(); ++i) {
        maps.push_back(addMap(builder, collider.maps[i], payloads[i], packed[i].packing));
    }
    const Provenance& from = collider.provenance;
    // Build them one by one: the evaluation order of function arguments is unspecified, and each string is written on
    // creation.
    std::vector<flatbuffers::Offset<fb::Option>> options;
    for (const RecordedOption& option : from.options) {
        const auto value = builder.CreateString(option.value);
        const auto name = builder.CreateString(option.name);
        options.push_back(fb::CreateOption(builder, name, value));
    }
    const flatbuffers::Offset<flatbuffers::Vector<flatbuffers::Offset<fb::Option>>> option_vector =
        options.empty() ? 0 : builder.CreateVector(options);
    const auto tool_version = builder.CreateString(from.tool_version);
    const auto mesh_hash = builder.CreateString(from.mesh_hash);
    const auto mesh_name = builder.CreateString(from.mesh_name);
    const auto provenance =
        fb::CreateProvenance(builder, mesh_name, mesh_hash, from.triangles, tool_version, option_vector);
    const fb::Vec3 bounds_min = toFb(collider.bounds.min);
    const fb::Vec3 bounds_max = toFb(collider.bounds.max);
    const auto unit = builder.CreateString(collider.unit);
    const auto map_vector = builder.CreateVector(maps);
    flatbuffers::Offset<flatbuffers::Vector<std::uint8_t>> animation = 0;
    if (!collider.animation.empty()) {
        builder.ForceVectorAlignment(collider.animation.size(), 1, sizeof(std::uint64_t));
        animation = builder.CreateVector(reinterpret_cast<const std::uint8_t*>(collider.animation.data()),
                                         collider.animation.size());
    }
    const auto materials = addMaterials(builder, collider.materials, material_nodes);
    fb::FinishColliderBuffer(builder, fb::CreateCollider(builder, &bounds_min, &bounds_max, unit, provenance,
                                                         map_vector, animation, materials));
    const auto bytes = std::as_bytes(std::span(builder.GetBufferPointer(), builder.GetSize()));
    return {bytes.begin(), bytes.end()};
}

Result<void> checkWritable(const Collider& collider, const ContainerWriteOptions& options) {
    if (options.compression_level < 0 || options.compression_level > kZstdLevelMax) {
        return fail(ErrorCode::kUsage, "compression level " + std::to_string(options.compression_level) +
                                           " is not in 0..." + std::to_string(kZstdLevelMax));
    }
    const ContainerLimits limits;
    if (collider.maps.size() > limits.maps) {
        return fail(ErrorCode::kLimit, std::to_string(collider.maps.size()) + " maps exceed the limit of " +
                                           std::to_string(limits.maps) + "; use fewer maps");
    }
    RELIEF_TRY(validate(collider));
    if (collider.texelBytes() > limits.texel_bytes) {
        return fail(ErrorCode::kLimit,
                    std::to_string(collider.texelBytes()) + " bytes of texels are more than the limit of " +
                        std::to_string(limits.texel_bytes) + "; use smaller or fewer maps");
    }
    return {};
}

Result<std::vector<std::byte>> writeChecked(const Collider& collider, const ContainerWriteOptions& options) {
    std::vector<PackedPayload> packed;
    for (std::size_t i = 0; i < collider.maps.size(); ++i) {
        Result<PackedPayload> one = packBytes(collider.maps[i].texels, options.compression_level);
        if (!one) {
            return tl::unexpected<Error>(inMap(i, one.error()));
        }
        packed.push_back(std::move(*one));
    }

    const PackedPayload material_nodes =
        RELIEF_TRY(packBytes(std::as_bytes(std::span(collider.materials.nodes)), options.compression_level));

    // Payloads follow the metadata, which stores their offsets: first determine its size, then its values.
    std::vector<fb::Payload> payloads;
    for (std::size_t i = 0; i < packed.size(); ++i) {
        payloads.emplace_back(0, packed[i].stored.size(), collider.maps[i].texels.size(),
                              xxh3_64(packed[i].stored));
    }
    ContainerHeader header;
    header.metadata_size = writeMetadata(collider, payloads, packed, material_nodes).size();
    std::uint64_t end = header.metadata_offset + header.metadata_size;
    for (fb::Payload& payload : payloads) {
        payload = fb::Payload(alignPayload(end), payload.stored_size(), payload.raw_size(), payload.xxh3());
        end = payload.offset() + payload.stored_size();
    }
    const std::vector<std::byte> metadata = writeMetadata(collider, payloads, packed, material_nodes);
    if (metadata.size() != header.metadata_size || metadata.size() > kContainerMetadataMax) {
        return fail(ErrorCode::kLimit,
                    !collider.animation.empty()
                        ? "the animated mesh exceeds the 16 MiB of a container's metadata; "
                          "simplify it, or bake fewer clips"
                    : !collider.materials.empty()
                        ? "the materials do not fit into the container; bake with --materials drop"
                        : "the metadata does not fit into the container; use fewer maps");
    }
    header.file_size = end;
    header.metadata_hash = xxh3_64(metadata);
    header.header_hash = header.computeHash();

    std::vector<std::byte> bytes(static_cast<std::size_t>(end));  // zero-initialized: padding
    std::memcpy(bytes.data(), &header, sizeof(header));
    std::copy(metadata.begin(), metadata.end(),
              bytes.begin() + static_cast<std::ptrdiff_t>(header.metadata_offset));
    for (std::size_t i = 0; i < packed.size(); ++i) {
        std::copy(packed[i].stored.begin(), packed[i].stored.end(),
                  bytes.begin() + static_cast<std::ptrdiff_t>(payloads[i].offset()));
    }
    return bytes;
}

/// Common extensions of `relief bake` inputs, except those that a collider might have.
constexpr std::array<std::string_view, 16> kMeshExtensions = {
    ".ac",   ".acc", ".3ds", ".b3d", ".blend", ".dae", ".fbx", ".glb",
    ".gltf", ".lwo", ".obj", ".off", ".ms3d",  ".ply", ".stl", ".x"};

/// First byte of a container: not a letter, and not the first byte of any mesh format above.
constexpr std::byte kFirstByte{ContainerHeader::kSignature[0]};

}  // namespace

Result<std::vector<std::byte>> writeContainer(const Collider& collider,
                                              const ContainerWriteOptions& options) {
    return withinMemory([&]() -> Result<std::vector<std::byte>> {
        RELIEF_TRY(checkWritable(collider, options));
        return writeChecked(collider, options);
    });
}

Result<Collider> readContainer(std::span<const std::byte> bytes, const ContainerLimits& limits) {
    return withinMemory([&]() -> Result<Collider> {
        ContainerReader reader(bytes, limits);
        reader.readDescription();
        std::optional<Error> refused = reader.refusal();
        for (std::size_t i = 0; !refused && i < reader.maps.size(); ++i) {
            reader.readTexels(i);
            reader.collider.maps.push_back(std::move(reader.maps[i].frame));
            refused = reader.refusal();
        }
        if (refused) {
            return tl::unexpected<Error>(std::move(*refused));
        }
        return std::move(reader.collider);
    });
}

Result<ContainerInfo> readContainerInfo(std::span<const std::byte> bytes, const ContainerLimits& limits) {
    return withinMemory([&]() -> Result<ContainerInfo> {
        ContainerReader reader(bytes, limits);
        reader.readDescription();
        if (std::optional<Error> refused = reader.refusal()) {
            return tl::unexpected<Error>(std::move(*refused));
        }
        ContainerInfo info{reader.header.major, reader.header.minor, reader.header.file_size, {}};
        for (const StoredMap& map : reader.maps) {
            info.payloads.push_back(map.payload);
        }
        return info;
    });
}

Result<Collider> loadCollider(const std::filesystem::path& path, const ContainerLimits& limits) {
    const std::vector<std::byte> bytes = RELIEF_TRY(readFile(path, containerSizeMax(limits)));
    RELIEF_TRY(rejectMesh(path, bytes));
    return withPrefix(quotedPath(path), readContainer(bytes, limits));
}

Result<void> saveCollider(const std::filesystem::path& path, const Collider& collider,
                          const ContainerWriteOptions& options) {
    return writeFile(
        path, RELIEF_TRY(withPrefix("cannot write " + quotedPath(path), writeContainer(collider, options))));
}

Result<void> rejectMeshName(const std::filesystem::path& path) {
    const std::string extension = lowerCase(path.extension().native());
    if (extension == ".json") {
        return fail(
            ErrorCode::kInvalidInput,
            quotedPath(path) + " is not a collider but a world; name one of the containers next to it");
    }
    if (std::find(kMeshExtensions.begin(), kMeshExtensions.end(), extension) == kMeshExtensions.end()) {
        return {};
    }
    std::filesystem::path baked = path;
    baked.replace_extension(".relief");
    return fail(ErrorCode::kInvalidInput, quotedPath(path) +
                                              " is a mesh, not a collider; bake it first: relief bake " +
                                              quotedPath(path) + " -o " + quotedPath(baked));
}

Result<void> rejectMesh(const std::filesystem::path& path, std::span<const std::byte> bytes) {
    return !bytes.empty() && bytes.front() == kFirstByte ? Result<void>() : rejectMeshName(path);
}

}  // namespace relief

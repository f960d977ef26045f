// SPDX-License-Identifier: Apache-2.0
// A world: colliders and the bodies that place them, in one readable file beside the collider files.
//
//     {
//       "format": "relief-world", "version": 1, "unit": "m",
//       "colliders": [{"file": "chair-0123456789abcdef.relief", "hash": "…", "gpu_bytes": 65536, "mesh": "chair", …}],
//       "bodies": [{"collider": 0, "node": "chair.001", "position": [3, 0, 1], "rotation": [0, 0, 0, 1], "scale": 1, …}]
//     }
//
// README.md in this folder describes the format. It differs from a tileset.json of OGC 3D Tiles: a collider is listed
// once, regardless of how often it is placed, and poses preserve shapes. Distances of a body are those of its collider,
// multiplied by the scale.
#pragma once

#include <array>
#include <cstdint>
#include <filesystem>
#include <glm/vec3.hpp>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "formats/base/field.h"
#include "formats/base/result.h"
#include "formats/collider.h"
#include "formats/container_limits.h"
#include "formats/material_response.h"
#include "formats/world/pose.h"

namespace relief {

inline constexpr std::size_t kWorldCollidersMax = 4096;
inline constexpr std::size_t kWorldBodiesMax = 65'536;
inline constexpr std::size_t kWorldMaterialsMax = 4096;
inline constexpr std::uint64_t kWorldBytesMax = std::uint64_t{64} << 20;
inline constexpr std::uint32_t kWorldVersion = 1;
inline constexpr std::string_view kWorldFormat = "relief-world";
/// File name inside a world's folder.
inline constexpr const char* kWorldFileName = "world.json";
inline constexpr double kWorldCoordinateMax = double{1e15F};
inline constexpr double kWorldFileBytesMax = 2147483648.0;  ///< maximum of WorldFile::gpu_bytes

/// A container of a world, as listed in the file.
struct WorldFile {
    std::string file;
    std::string hash;
    std::uint64_t gpu_bytes = 0;
};

void fields(FieldVisitor& visit, WorldFile& file);

struct WorldCollider : WorldFile {
    std::string mesh;
    Bounds box{glm::vec3(0.0F), glm::vec3(0.0F)};
    std::optional<WorldFile> coarse;
};

void fields(FieldVisitor& visit, WorldCollider& collider);

/// Selects a collider's own container, or its coarse container if there is one.
enum class WorldDetail : std::uint8_t { kFine, kCoarse };
[[nodiscard]] const WorldFile& fileOf(const WorldCollider& collider, WorldDetail detail);

/// world = position + scale · rotation · object
struct WorldBody {
    std::uint32_t collider = 0;
    std::string node{};
    glm::vec3 position{0.0F};
    std::array<float, 4> rotation{0.0F, 0.0F, 0.0F, 1.0F};
    float scale = 1.0F;
    float restitution = 1.0F;
    float friction = 0.0F;
};

void fields(FieldVisitor& visit, WorldBody& body);

[[nodiscard]] Pose poseOf(const WorldBody& body);

struct World {
    std::string format{kWorldFormat};
    std::uint32_t version = kWorldVersion;
    std::string unit;
    std::vector<WorldCollider> colliders;
    std::vector<WorldBody> bodies;
    std::vector<MaterialResponse> materials;  ///< responses by name, for all colliders
};

inline constexpr std::array<std::string_view, 2> kWorldUnits{"m", ""};

void fields(FieldVisitor& visit, World& world);

/// Returns the indices of the bodies with this node name, in world order. Several bodies share a name if the node's
/// mesh was cut into tiles, which move together, or if several nodes have the same name. Empty if there are none.
[[nodiscard]] std::vector<std::size_t> findBodies(const World& world, std::string_view node);

/// Returns a box that contains all bodies.
[[nodiscard]] Bounds worldBounds(const World& world);

/// Writes a line for each collider and each body. Equal worlds give equal text.
[[nodiscard]] std::string worldText(const World& world);

/// Parses untrusted text; does not open the files that it names. Normalizes rotations.
/// Errors, in one line without the file name: kInvalidInput, kUnsupported (another version), kLimit.
[[nodiscard]] Result<World> parseWorld(std::string_view text);

struct LoadedWorld {
    World world;
    std::vector<Collider> colliders;  ///< in the order of world.colliders
};

/// Loads a world with its colliders, and compares their hashes, sizes and boxes with those in the file.
/// \param limits  texel_bytes applies to the total of all colliders.
/// Errors, prefixed with the file: those of parseWorld, readFile and readContainer; kInvalidInput for a path that
/// leaves the folder, or a hash, size or box that differs; kIo for a missing container.
[[nodiscard]] Result<LoadedWorld> loadWorld(const std::filesystem::path& path,
                                            const ContainerLimits& limits = {},
                                            WorldDetail detail = WorldDetail::kFine);

/// Loads only the world file. Errors: those of loadWorld.
[[nodiscard]] Result<World> loadWorldFile(const std::filesystem::path& path);

/// Loads one collider of a world.
/// \param folder  of the world. Errors: those of loadWorld, prefixed with the collider's index instead of the file.
[[nodiscard]] Result<Collider> loadWorldCollider(const World& world, std::size_t collider, WorldDetail detail,
                                                 const std::filesystem::path& folder,
                                                 const ContainerLimits& limits = {});
/// Reads one collider from the bytes of its container.
[[nodiscard]] Result<Collider> readWorldCollider(const World& world, std::size_t collider, WorldDetail detail,
                                                 std::span<const std::byte> bytes,
                                                 const ContainerLimits& limits = {});

}  // namespace relief

// SPDX-License-Identifier: Apache-2.0
// A world: colliders, and the bodies that are placed instances of them, in one readable file beside the colliders' files.
//
//     {
//       "format": "relief-world", "version": 1, "unit": "m",
//       "colliders": [{"file": "chair-0123456789abcdef.relief", "hash": "…", "gpu_bytes": 65536, "mesh": "chair", …}],
//       "bodies": [{"collider": 0, "node": "chair.001", "position": [3, 0, 1], "rotation": [0, 0, 0, 1], "scale": 1, …}]
//     }
//
// README.md beside this file describes it. It differs from a tileset.json of OGC 3D Tiles in that a collider is named once
// however often it is placed, and that a pose keeps shapes: distances of a collider are those of its body times the scale.
#pragma once

#include <array>
#include <cstdint>
#include <filesystem>
#include <glm/vec3.hpp>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <type_traits>
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
/// The name of the file in the folder of a world.
inline constexpr const char* kWorldFileName = "world.json";
inline constexpr double kWorldCoordinateMax = double{1e15F};
inline constexpr double kWorldFileBytesMax = 2147483648.0;  ///< all texels of a container

/// A container of a world.
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

/// Of a collider its own container, or its coarse one where it has that.
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
    std::vector<MaterialResponse> materials;  ///< responses by name, of all colliders
};

inline constexpr std::array<std::string_view, 2> kWorldUnits{"m", ""};

void fields(FieldVisitor& visit, World& world);

/// The numbers of the bodies of a node, in the world's order: several in one place where its mesh was cut into tiles, which move
/// as one; those of all nodes that share the name. Empty: there is none.
[[nodiscard]] std::vector<std::size_t> findBodies(const World& world, std::string_view node);

/// The box that holds all bodies where they are.
[[nodiscard]] Bounds worldBounds(const World& world);

/// A line for each collider and each body. The same world is the same text.
[[nodiscard]] std::string worldText(const World& world);

/// Reads untrusted text; the files that it names are not looked at. Rotations get length 1.
/// Errors, in one line and without the file's name: kInvalidInput, kUnsupported (another version), kLimit.
[[nodiscard]] Result<World> parseWorld(std::string_view text);

struct LoadedWorld {
    World world;
    std::vector<Collider> colliders;  ///< of world.colliders
};

/// A world with its colliders, whose hashes, sizes and boxes are compared with the file's.
/// \param limits  texel_bytes: of all colliders together.
/// Errors, with the file in front: those of parseWorld, readFile and readContainer; kInvalidInput: a path that leads out of
/// the folder, a hash, a size or a box that differs; kIo: a container that is missing.
[[nodiscard]] Result<LoadedWorld> loadWorld(const std::filesystem::path& path,
                                            const ContainerLimits& limits = {},
                                            WorldDetail detail = WorldDetail::kFine);

/// The world alone. Errors: as loadWorld.
[[nodiscard]] Result<World> loadWorldFile(const std::filesystem::path& path);

/// One of its colliders.
/// \param folder  of the world. Errors: as loadWorld, with the collider's place in front.
[[nodiscard]] Result<Collider> loadWorldCollider(const World& world, std::size_t collider, WorldDetail detail,
                                                 const std::filesystem::path& folder,
                                                 const ContainerLimits& limits = {});
/// The same of the bytes of its container.
[[nodiscard]] Result<Collider> readWorldCollider(const World& world, std::size_t collider, WorldDetail detail,
                                                 std::span<const std::byte> bytes,
                                                 const ContainerLimits& limits = {});

}  // namespace relief

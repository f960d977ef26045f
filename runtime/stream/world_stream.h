// SPDX-License-Identifier: Apache-2.0
// A world whose colliders come to the GPU when they are needed. A coarse likeness of each always lies there, so that nothing
// falls through; its own maps come by a thread that loads and by an upload of a few bytes at each update, and go by
// least recent use.
//
//     auto world = *WorldStream::open("level/world.json", {.gpu_bytes = 64 << 20});
//     particles.setCollider(&world->textures());
//     ...                                                  // each frame:
//     need(world->update(points));                         // camera, emitters; waits for nothing
//     for (const std::string& line : world->takeWarnings()) { log(line); }
//     need(particles.step(dt));
//
// Runs that are to be reproducible call finish(points) in place of update().
//
// A collider without a coarse likeness is there from the beginning. One that is missing or damaged is named once by
// takeWarnings(), and is not asked for again.
#pragma once

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <memory>
#include <span>
#include <string>
#include <vector>

#include "formats/base/result.h"
#include "formats/world/world.h"
#include "runtime/bodies/world_textures.h"
#include "runtime/stream/collider_source.h"
#include "runtime/stream/stream_plan.h"

namespace relief {

struct StreamOptions {
    std::uint64_t gpu_bytes = std::uint64_t{256} << 20;     ///< of all texels, the coarse ones included
    std::uint64_t upload_bytes = std::uint64_t{128} << 10;  ///< that one update may copy, at least 8
    /// Colliders that are loaded or wait for their upload, at least 1: they take memory.
    std::size_t under_way = 2;
};

struct StreamCounts {
    std::size_t wanted = 0;       ///< colliders with a coarse likeness that reach into the points' balls
    std::size_t present = 0;      ///< of those the ones that are there with their own maps
    std::size_t failed = 0;       ///< colliders that could not be loaded
    std::uint64_t gpu_bytes = 0;  ///< of all that is there
    std::uint64_t uploaded = 0;   ///< bytes since the beginning
};

class WorldStream {
  public:
    /// Uploads the coarse likenesses. Needs a current context, as all but the const functions do.
    /// \param bodies  of the world's colliders, by the pointers of `coarse`, and others, as WorldTextures takes them.
    /// \param coarse  the world's colliders with WorldDetail::kCoarse, as many as it has. Not needed later.
    /// Errors: those of WorldTextures::create; kLimit: the coarse likenesses alone take more than gpu_bytes.
    [[nodiscard]] static Result<std::unique_ptr<WorldStream>> create(const World& world,
                                                                     std::span<const ColliderBody> bodies,
                                                                     std::span<const Collider* const> coarse,
                                                                     std::unique_ptr<ColliderSource> source,
                                                                     const StreamOptions& options = {});
    /// The world of a file as it stands, by makeFileSource(). Errors: also those of loadWorld.
    [[nodiscard]] static Result<std::unique_ptr<WorldStream>> open(const std::filesystem::path& path,
                                                                   const StreamOptions& options = {},
                                                                   const ContainerLimits& limits = {});
    /// The same of a world that has been read, with WorldDetail::kCoarse. \param path  of its file.
    [[nodiscard]] static Result<std::unique_ptr<WorldStream>> open(const LoadedWorld& coarse,
                                                                   const std::filesystem::path& path,
                                                                   const StreamOptions& options = {},
                                                                   const ContainerLimits& limits = {});
    WorldStream(const WorldStream&) = delete;
    WorldStream& operator=(const WorldStream&) = delete;
    ~WorldStream();

    /// They stay at one address. Poses are set here, below.
    [[nodiscard]] const WorldTextures& textures() const;
    [[nodiscard]] WorldTextures& textures();
    /// As WorldTextures::setPoses.
    void setPoses(std::span<const Pose> poses);

    /// Before a step. Its work and what it copies are bounded, and it waits neither for the loader nor for the GPU.
    /// Errors: kUsage: a point that is not finite or whose radius is not above 0.
    [[nodiscard]] Result<void> update(std::span<const PointOfInterest> points);
    /// The same, and waits until all that these points want is there, as far as there is room.
    [[nodiscard]] Result<void> finish(std::span<const PointOfInterest> points);

    /// One line for each collider that could not be loaded, or has no room, since the last call.
    [[nodiscard]] std::vector<std::string> takeWarnings();
    [[nodiscard]] StreamCounts counts() const;

  private:
    struct State;
    explicit WorldStream(std::unique_ptr<State> state);
    std::unique_ptr<State> state_;
};

}  // namespace relief

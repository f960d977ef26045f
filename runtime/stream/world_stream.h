// SPDX-License-Identifier: Apache-2.0
// A world whose colliders are streamed to the GPU on demand. Their coarse colliders are always resident, so that no
// particle falls through. A thread loads the full maps. Each update uploads a limited number of bytes. If there is no
// room, the update evicts full maps that no point of interest needs, and needed full maps for which nearer needed maps
// leave no room. The least recently needed maps are evicted first.
//
//     auto world = *WorldStream::open("level/world.json", {.gpu_bytes = 64 << 20});
//     particles.setCollider(&world->textures());
//     ...                                                  // each frame:
//     need(world->update(points));                         // camera, emitters; never waits
//     for (const std::string& line : world->takeWarnings()) { log(line); }
//     need(particles.step(dt));
//
// For reproducible runs, call finish(points) instead of update().
//
// Colliders without a coarse version are resident from the start. Colliders that are missing or damaged are reported
// once by takeWarnings() and not requested again.
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
    std::uint64_t gpu_bytes = std::uint64_t{256} << 20;     ///< for all texels, including coarse colliders
    std::uint64_t upload_bytes = std::uint64_t{128} << 10;  ///< limit per update, at least 8
    /// Maximum number of colliders in memory that are being loaded or wait for their upload, at least 1.
    std::size_t under_way = 2;
};

struct StreamCounts {
    std::size_t wanted = 0;       ///< streamed colliders that a point of interest needs
    std::size_t present = 0;      ///< wanted colliders that are resident with full maps
    std::size_t failed = 0;       ///< colliders that could not be loaded
    std::uint64_t gpu_bytes = 0;  ///< total resident
    std::uint64_t uploaded = 0;   ///< bytes since creation
};

class WorldStream {
  public:
    /// Uploads the coarse colliders. Needs a current context, as do all functions that are not const.
    /// \param bodies  point to the colliders in `coarse`, or to other colliders, which are not streamed.
    /// \param coarse  the world's colliders with WorldDetail::kCoarse, in order. Not needed after the call.
    /// Errors: those of WorldTextures::create; kLimit if the coarse colliders exceed gpu_bytes.
    [[nodiscard]] static Result<std::unique_ptr<WorldStream>> create(const World& world,
                                                                     std::span<const ColliderBody> bodies,
                                                                     std::span<const Collider* const> coarse,
                                                                     std::unique_ptr<ColliderSource> source,
                                                                     const StreamOptions& options = {});
    /// Opens a world file with makeFileSource(). Errors: also those of loadWorld.
    [[nodiscard]] static Result<std::unique_ptr<WorldStream>> open(const std::filesystem::path& path,
                                                                   const StreamOptions& options = {},
                                                                   const ContainerLimits& limits = {});
    /// Opens a world that was loaded with WorldDetail::kCoarse. \param path  the world file.
    [[nodiscard]] static Result<std::unique_ptr<WorldStream>> open(const LoadedWorld& coarse,
                                                                   const std::filesystem::path& path,
                                                                   const StreamOptions& options = {},
                                                                   const ContainerLimits& limits = {});
    ~WorldStream();

    /// The address of the textures is stable. Set poses with setPoses() below.
    [[nodiscard]] const WorldTextures& textures() const;
    [[nodiscard]] WorldTextures& textures();
    /// Sets poses like WorldTextures::setPoses().
    void setPoses(std::span<const Pose> poses);

    /// Call it before a step. Its work and uploads are bounded, and it waits neither for the loader nor for the GPU.
    /// Errors: kUsage (a point that is not finite, or a radius that is not above 0).
    [[nodiscard]] Result<void> update(std::span<const PointOfInterest> points);
    /// Likewise, but waits until all colliders that these points need are resident, as far as they fit.
    [[nodiscard]] Result<void> finish(std::span<const PointOfInterest> points);

    /// Returns one line for each collider that could not be loaded or did not fit since the last call.
    [[nodiscard]] std::vector<std::string> takeWarnings();
    [[nodiscard]] StreamCounts counts() const;

  private:
    struct State;
    explicit WorldStream(std::unique_ptr<State> state);
    std::unique_ptr<State> state_;
};

}  // namespace relief

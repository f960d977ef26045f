// SPDX-License-Identifier: Apache-2.0
// Sources of a world's colliders: files that a thread reads, or a source that the program provides.
#pragma once

#include <cstddef>
#include <filesystem>
#include <memory>
#include <optional>

#include "formats/base/result.h"
#include "formats/world/world.h"

namespace relief {

/// Provides the requested colliders in any order. All calls come from one thread. A step calls it within a PassState, so
/// changes of GL state do not last.
class ColliderSource {
  public:
    struct Arrival {
        std::size_t collider = 0;
        Result<Collider> loaded;
    };

    ColliderSource() = default;
    ColliderSource(const ColliderSource&) = delete;
    ColliderSource& operator=(const ColliderSource&) = delete;
    virtual ~ColliderSource() = default;

    /// Requests one of world.colliders in full detail. Not called again for the same collider before it has arrived.
    virtual void request(std::size_t collider) = 0;
    /// Returns the next collider that has arrived, or nullopt. Never waits.
    [[nodiscard]] virtual std::optional<Arrival> take() = 0;
    /// Likewise, but waits for a pending request. Sources that cannot wait return take().
    [[nodiscard]] virtual std::optional<Arrival> wait() { return take(); }
    /// Frees a collider that is no longer needed, if possible in another thread: freeing megabytes takes a fraction of
    /// a millisecond.
    virtual void release(Collider /*used*/) {}
};

/// Reads a world's containers in a thread that ends with the source, and checks them against the world's hashes, sizes
/// and boxes.
/// \param folder  of the world. Errors: kLimit (no thread could be created).
[[nodiscard]] Result<std::unique_ptr<ColliderSource>> makeFileSource(World world,
                                                                     std::filesystem::path folder,
                                                                     const ContainerLimits& limits = {});

}  // namespace relief

// SPDX-License-Identifier: Apache-2.0
// Colliders of a world from elsewhere: files that a thread reads, or whatever a program has.
#pragma once

#include <cstddef>
#include <filesystem>
#include <memory>
#include <optional>

#include "formats/base/result.h"
#include "formats/world/world.h"

namespace relief {

/// Brings colliders in the order of the requests. All calls come from one thread.
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

    /// Asks for one of world.colliders, in full detail. None is asked for again before it has come.
    virtual void request(std::size_t collider) = 0;
    /// The next one that has come; nullopt: none yet. Never waits.
    [[nodiscard]] virtual std::optional<Arrival> take() = 0;
    /// The same, but waits while any is under way. A source that cannot wait gives what take() gives.
    [[nodiscard]] virtual std::optional<Arrival> wait() { return take(); }
    /// Takes back what has been used, to free it where that holds up nobody: megabytes take a part of a millisecond.
    virtual void release(Collider /*used*/) {}
};

/// Reads a world's containers, and compares them with its hashes, sizes and boxes, in a thread of its own, which ends with
/// the object.
/// \param folder  of the world. Errors: kLimit: the system has no thread left.
[[nodiscard]] Result<std::unique_ptr<ColliderSource>> makeFileSource(World world,
                                                                     std::filesystem::path folder,
                                                                     const ContainerLimits& limits = {});

}  // namespace relief

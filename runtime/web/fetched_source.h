// SPDX-License-Identifier: Apache-2.0
// Colliders of a streamed world that the page fetches: next() returns requests, give() passes the bytes.
#pragma once

#include <cstddef>
#include <deque>
#include <optional>
#include <set>
#include <span>
#include <string>

#include "formats/world/world.h"
#include "runtime/stream/collider_source.h"

namespace relief {

class FetchedSource : public ColliderSource {
  public:
    explicit FetchedSource(World world) : world_(std::move(world)) {}

    void request(std::size_t collider) override { requests_.push_back(collider); }
    [[nodiscard]] std::optional<Arrival> take() override;

    /// Returns the next collider to fetch; nullopt if there is none.
    [[nodiscard]] std::optional<std::size_t> next();
    /// Ends a fetch with the bytes of its container, which are validated. Ignores colliders that next() did not return.
    void give(std::size_t collider, std::span<const std::byte> bytes);
    /// Ends a fetch that failed. \param reason  names the file.
    void refuse(std::size_t collider, std::string reason);

    /// Number of requests not yet ended by give() or refuse().
    [[nodiscard]] std::size_t underWay() const { return requests_.size() + fetched_.size(); }

  private:
    const World world_;
    std::deque<std::size_t> requests_;
    std::set<std::size_t> fetched_;  // returned by next()
    std::deque<Arrival> arrivals_;
};

}  // namespace relief

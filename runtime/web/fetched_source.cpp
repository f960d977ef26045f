// SPDX-License-Identifier: Apache-2.0
#include "runtime/web/fetched_source.h"

#include <utility>

#include "formats/container_reader.h"

namespace relief {

std::optional<ColliderSource::Arrival> FetchedSource::take() {
    if (arrivals_.empty()) {
        return std::nullopt;
    }
    std::optional<Arrival> first = std::move(arrivals_.front());
    arrivals_.pop_front();
    return first;
}

std::optional<std::size_t> FetchedSource::next() {
    if (requests_.empty()) {
        return std::nullopt;
    }
    const std::size_t first = requests_.front();
    requests_.pop_front();
    fetched_.insert(first);
    return first;
}

void FetchedSource::give(std::size_t collider, std::span<const std::byte> bytes) {
    if (fetched_.erase(collider) > 0) {
        arrivals_.push_back({collider, withinMemory([&]() -> Result<Collider> {
                                 return readWorldCollider(world_, collider, WorldDetail::kFine, bytes);
                             })});
    }
}

void FetchedSource::refuse(std::size_t collider, std::string reason) {
    if (fetched_.erase(collider) > 0) {
        arrivals_.push_back({collider, fail(ErrorCode::kIo, std::move(reason))});
    }
}

}  // namespace relief

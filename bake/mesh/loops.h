// SPDX-License-Identifier: Apache-2.0
// Provides a parallel loop, a loop over a grid, and a counting sort.
#pragma once

#include <tbb/blocked_range.h>
#include <tbb/parallel_for.h>

#include <cstddef>
#include <cstdint>
#include <numeric>
#include <span>
#include <vector>

namespace relief {

/// Calls visit(i) for i in [begin, end) on all cores. \param grain  minimum number of indices per task.
template <class Visit>
void forEachIndex(std::size_t begin, std::size_t end, std::size_t grain, const Visit& visit) {
    tbb::parallel_for(tbb::blocked_range<std::size_t>(begin, end, grain), [&](const auto& range) {
        for (std::size_t i = range.begin(); i != range.end(); ++i) {
            visit(i);
        }
    });
}

/// Calls visit(at) for each integer point with begin ≤ at < end along every axis, x fastest.
/// \tparam Vector  glm::ivec3 or glm::uvec3.
template <class Vector, class Visit>
void forEachPoint(const Vector& begin, const Vector& end, const Visit& visit) {
    for (Vector at = begin; at.z < end.z; ++at.z) {
        for (at.y = begin.y; at.y < end.y; ++at.y) {
            for (at.x = begin.x; at.x < end.x; ++at.x) {
                visit(at);
            }
        }
    }
}

/// Groups values by bucket, keeping their order in each bucket: a counting sort.
template <class Value, class Index = std::uint32_t>
class Buckets {
  public:
    Buckets() = default;
    /// \param forEach  calls its argument with (bucket, value) for every value. forEach is called twice, and must
    /// repeat the order.
    template <class ForEach>
    Buckets(std::size_t count, const ForEach& forEach) : first_(count + 1, 0) {
        forEach([&](std::size_t bucket, const Value&) { ++first_[bucket + 1]; });
        std::partial_sum(first_.begin(), first_.end(), first_.begin());
        values_.resize(first_.back());
        std::vector<Index> next(first_.begin(), first_.end() - 1);
        forEach([&](std::size_t bucket, const Value& value) { values_[next[bucket]++] = value; });
    }

    [[nodiscard]] std::size_t size() const { return first_.size() - 1; }
    /// Index in values() of the first value of a bucket; the end if bucket is size().
    [[nodiscard]] Index first(std::size_t bucket) const { return first_[bucket]; }
    [[nodiscard]] std::span<const Value> operator[](std::size_t bucket) const {
        return std::span(values_).subspan(first_[bucket], first_[bucket + 1] - first_[bucket]);
    }
    [[nodiscard]] std::vector<Value>& values() { return values_; }  ///< all buckets, in order

  private:
    std::vector<Index> first_;
    std::vector<Value> values_;
};

}  // namespace relief

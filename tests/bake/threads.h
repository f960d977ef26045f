// SPDX-License-Identifier: Apache-2.0
// Runs work on a given number of threads.
#pragma once

#include <tbb/global_control.h>
#include <tbb/task_arena.h>

#include <cstddef>

namespace relief::test {

/// \return the result of f
template <class F>
auto onThreads(int threads, const F& f) {
    const tbb::global_control control(tbb::global_control::max_allowed_parallelism,
                                      static_cast<std::size_t>(threads));
    tbb::task_arena arena(threads);
    return arena.execute(f);
}

}  // namespace relief::test

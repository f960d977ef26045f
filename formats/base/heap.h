// SPDX-License-Identifier: Apache-2.0
// The heap of a tool that allocates much for a short time.
#pragma once

#include <cstddef>

namespace relief {

/// The room of a bake: of `relief`, and of what is timed against it.
inline constexpr std::size_t kBakeHeapBytes = std::size_t{128} << 20;

/// Keeps freed blocks of up to 32 MB instead of giving them back to the system, and makes room for `bytes` more, with large
/// pages if the system has them: where it clears 4 kB at a time, a bake spends a fifth of its time on that. Without so much
/// address space there is no room made. Takes no memory before it is used.
///
/// Call it once, before threads and large blocks, in an executable of our own: a library leaves the heap alone, and this
/// header is not installed.
void prepareHeap(std::size_t bytes);

}  // namespace relief

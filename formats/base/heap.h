// The heap of a tool that allocates much for a short time.
#pragma once

#include <cstddef>

namespace relief {

/// Keeps freed memory instead of giving it back to the system, and asks for large pages for the first `bytes` of the
/// heap, as far as it can be had: where the system clears 4 kB at a time, a bake spends a fifth of its time on that. Takes no
/// memory before it is used. Call it once, first of all, in an executable of our own: a library leaves the heap alone, and this header is not installed.
void prepareHeap(std::size_t bytes);

}  // namespace relief

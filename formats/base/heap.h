// SPDX-License-Identifier: Apache-2.0
// Heap tuning for tools with large short-lived allocations.
#pragma once

#include <cstddef>

namespace relief {

/// Address space that `relief` reserves at its start.
inline constexpr std::size_t kBakeHeapBytes = std::size_t{128} << 20;

/// Keeps freed blocks of up to 32 MB in the process and reserves address space for `bytes` more, with huge pages if
/// available. Clearing 4 kB pages one by one otherwise takes a fifth of a bake's time. Reserves nothing if the address
/// space is too small. Memory is committed only when used.
///
/// Call it once, before starting threads and allocating large blocks. Only our own executables call it: libraries must
/// not change the heap, and this header is not installed.
void prepareHeap(std::size_t bytes);

}  // namespace relief

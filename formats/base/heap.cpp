// SPDX-License-Identifier: Apache-2.0
#include "formats/base/heap.h"

#include <malloc.h>
#include <sys/mman.h>
#include <unistd.h>

#include <algorithm>
#include <climits>
#include <cstdint>
#include <cstdlib>

namespace relief {
namespace {

/// Size of later heap extensions; large because assimp makes many small allocations.
constexpr int kStepBytes = 16 << 20;
/// Largest block that glibc may allocate from the heap instead of with mmap.
constexpr int kLargestBlock = 32 << 20;
/// A block that does not fit into the initial heap, but into its first extension.
constexpr std::size_t kFirstBlock = std::size_t{1} << 20;

std::uintptr_t heapEnd() {
    return reinterpret_cast<std::uintptr_t>(::sbrk(0));
}

}  // namespace

void prepareHeap(std::size_t bytes) {
    ::mallopt(M_TRIM_THRESHOLD, INT_MAX);
    ::mallopt(M_MMAP_THRESHOLD, kLargestBlock);
    // Extend once, by a large step: madvise() does not cover pages that are added later.
    const std::uintptr_t before = heapEnd();
    ::mallopt(M_TOP_PAD, static_cast<int>(std::min<std::size_t>(bytes, INT_MAX)));
    void* volatile first = std::malloc(kFirstBlock);  // volatile: an unused allocation may be optimized away
    std::free(first);
    ::mallopt(M_TOP_PAD, kStepBytes);
    const auto page = static_cast<std::uintptr_t>(::sysconf(_SC_PAGESIZE));
    const std::uintptr_t begin = (before + page - 1) / page * page;
    if (const std::uintptr_t end = heapEnd(); end > begin) {
        ::madvise(reinterpret_cast<void*>(begin), end - begin, MADV_HUGEPAGE);
    }
}

}  // namespace relief

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

/// Further steps of the heap: few, as assimp allocates much in little pieces.
constexpr int kStepBytes = 16 << 20;
/// The most that glibc takes from its heaps instead of a mapping of its own.
constexpr int kLargestBlock = 32 << 20;
/// Less than any first step, and more than the heap begins with.
constexpr std::size_t kFirstBlock = std::size_t{1} << 20;

std::uintptr_t heapEnd() {
    return reinterpret_cast<std::uintptr_t>(::sbrk(0));
}

}  // namespace

void prepareHeap(std::size_t bytes) {
    ::mallopt(M_TRIM_THRESHOLD, INT_MAX);
    ::mallopt(M_MMAP_THRESHOLD, kLargestBlock);
    // One large step now: madvise() does not cover the pages of a later one.
    const std::uintptr_t before = heapEnd();
    ::mallopt(M_TOP_PAD, static_cast<int>(std::min<std::size_t>(bytes, INT_MAX)));
    void* volatile first = std::malloc(kFirstBlock);  // volatile: an unused block need not be allocated
    std::free(first);
    ::mallopt(M_TOP_PAD, kStepBytes);
    const auto page = static_cast<std::uintptr_t>(::sysconf(_SC_PAGESIZE));
    const std::uintptr_t begin = (before + page - 1) / page * page;
    if (const std::uintptr_t end = heapEnd(); end > begin) {
        ::madvise(reinterpret_cast<void*>(begin), end - begin, MADV_HUGEPAGE);
    }
}

}  // namespace relief

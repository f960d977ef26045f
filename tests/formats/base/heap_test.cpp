// SPDX-License-Identifier: Apache-2.0
// The first part of the heap uses large pages if the system supports them, and freed memory is not returned to the
// system.
#include "formats/base/heap.h"

#include <gtest/gtest.h>
#include <sys/resource.h>
#include <unistd.h>

#include <cstdint>
#include <cstring>
#include <fstream>
#include <memory>
#include <sstream>
#include <string>

namespace relief {
namespace {

#if defined(RELIEF_SANITIZED) || defined(__SANITIZE_THREAD__)
constexpr bool kOwnHeap = false;  // a sanitizer replaces the heap
#else
constexpr bool kOwnHeap = true;
#endif

/// The kernel's flags of the mapping that contains an address, as " rd wr … "; "" if it is not mapped.
std::string flagsAt(const void* address) {
    const auto wanted = reinterpret_cast<std::uintptr_t>(address);
    std::ifstream maps("/proc/self/smaps");
    std::string line;
    bool here = false;
    while (std::getline(maps, line)) {
        std::istringstream words(line);
        std::uintptr_t begin = 0;
        std::uintptr_t end = 0;
        char dash = 0;
        if (words >> std::hex >> begin >> dash >> end && dash == '-') {
            here = begin <= wanted && wanted < end;
        } else if (here && line.starts_with("VmFlags:")) {
            return line.substr(8) + " ";
        }
    }
    return "";
}

long pageFaults() {
    rusage usage{};
    ::getrusage(RUSAGE_SELF, &usage);
    return usage.ru_minflt;
}

void touch(std::size_t bytes) {
    const std::unique_ptr<char[]> block(new char[bytes]);
    std::memset(block.get(), 1, bytes);
    EXPECT_EQ(block[bytes / 2], 1);
}

// Runs in its own process because the heap of this process is already in use.
TEST(Heap, RequestsLargePagesAndKeepsFreedMemory) {
    GTEST_FLAG_SET(death_test_style,
                   "threadsafe");  // restarts the program: a fork would inherit this heap
    const auto work = [] {
        prepareHeap(std::size_t{64} << 20);
        const std::unique_ptr<char[]> block(new char[24 << 20]);
        const bool large = flagsAt(block.get() + (12 << 20)).find(" hg ") != std::string::npos;
        constexpr std::size_t kBytes = 24 << 20;  // above a step of the heap, below its largest block
        touch(kBytes);
        const long before = pageFaults();
        touch(kBytes);
        const bool kept = pageFaults() - before < 64;  // 6144 new pages of 4 kB otherwise
        ::_exit(kOwnHeap ? (large ? 0 : 1) + (kept ? 0 : 2) : 0);
    };
    EXPECT_EXIT(work(), testing::ExitedWithCode(0), "")
        << "1: no large pages were requested; 2: freed memory was returned to the system";
}

// If less memory is available, as under ulimit -v, the heap stays unchanged and usable.
TEST(Heap, StaysWithinTheMemoryLimit) {
    const auto work = [] {
        std::ifstream sizes("/proc/self/statm");
        std::uint64_t pages = 0;
        sizes >> pages;
        const rlim_t limit = pages * static_cast<std::uint64_t>(::sysconf(_SC_PAGESIZE)) + (rlim_t{60} << 20);
        const rlimit some{limit, limit};
        const bool limited = !kOwnHeap || ::setrlimit(RLIMIT_AS, &some) == 0;
        const void* const end = ::sbrk(0);
        prepareHeap(std::size_t{1} << 30);
        const bool grown = kOwnHeap && ::sbrk(0) != end;
        void* volatile block = std::malloc(std::size_t{1} << 20);
        ::_exit((limited ? 0 : 1) + (grown ? 2 : 0) + (block != nullptr ? 0 : 4));
    };
    EXPECT_EXIT(work(), testing::ExitedWithCode(0), "")
        << "1: cannot set a limit; 2: the heap exceeded it; 4: allocations fail";
}

}  // namespace
}  // namespace relief

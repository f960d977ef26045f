// SPDX-License-Identifier: Apache-2.0
// The rights that the import worker gives up before it reads a file.
#pragma once

#include <cstdint>

#include "formats/base/result.h"

namespace relief {

/// Bytes of the first thread's stack. Readers run on a stack of their own, which the address space limits.
inline constexpr std::uint64_t kSandboxStack = std::uint64_t{8} << 20;

struct SandboxLimits {
    std::uint64_t memory = 0;   ///< bytes of address space beyond what the process has when this is called
    std::uint32_t seconds = 1;  ///< of processor time
};

/// Limits this process for good: its address space, stack and processor time; no core file, no writing or growing of
/// files, no new privileges, no debugger; it ends with the parent thread. Where the kernel has Landlock, it can
/// open nothing but files below `folder`, for reading. Where it has seccomp, few system calls are left: any other ends it by
/// SIGSYS. Call it while there is one thread.
/// \param folder  descriptor; -1 for none.
/// \param result  descriptor of the memory that may still be shared, cut and sealed, or of the pipe that may still be written;
/// -1 for none.
/// Errors: kFailure.
[[nodiscard]] Result<void> enterSandbox(const SandboxLimits& limits, int folder, int result);

}  // namespace relief

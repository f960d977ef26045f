// SPDX-License-Identifier: Apache-2.0
// Drops the privileges of the import worker before it reads a file.
#pragma once

#include <cstdint>

#include "formats/base/result.h"

namespace relief {

/// Stack size of the first thread, in bytes. Readers run on their own stack, which counts towards the memory limit.
inline constexpr std::uint64_t kSandboxStack = std::uint64_t{8} << 20;

struct SandboxLimits {
    std::uint64_t memory = 0;   ///< bytes of address space beyond the current use
    std::uint32_t seconds = 1;  ///< limit on processor time
};

/// Restricts this process irrevocably. Limits address space, stack and processor time; forbids core files, writing or
/// growing files, new privileges and debuggers; ends the process when its parent thread ends. With Landlock, only files
/// below `folder` can be opened, read-only. With seccomp, only a few system calls are allowed; others fail
/// or raise SIGSYS. Call this function while the process has a single thread.
/// \param folder  descriptor; -1 for none.
/// \param result  descriptor of the memory that may still be mapped, truncated and sealed, or of the pipe that may
/// still be written; -1 for none.
/// Errors: kFailure.
[[nodiscard]] Result<void> enterSandbox(const SandboxLimits& limits, int folder, int result);

}  // namespace relief

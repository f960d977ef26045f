// What the import worker gives up before it looks at a file.
#pragma once

#include <cstdint>

#include "formats/base/result.h"

namespace relief {

struct SandboxLimits {
    std::uint64_t memory = 0;   ///< bytes of address space beyond what the process has when this is called
    std::uint32_t seconds = 1;  ///< of processor time
};

/// For this process, for good: limits of address space and processor time, no core file, no file can be
/// written or made longer, no new privileges, no debugger, death with the parent thread; and where the kernel
/// has Landlock, nothing in the file system can be opened but files below `folder`, for reading. \param
/// folder  descriptor; -1 for none. Errors: kFailure.
[[nodiscard]] Result<void> enterSandbox(const SandboxLimits& limits, int folder);

}  // namespace relief

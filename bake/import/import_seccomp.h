// The system calls that the import worker keeps.
#pragma once

#include "formats/base/result.h"

namespace relief {

/// Takes from this process, for good, all system calls but those that reading a mesh needs: memory that is not
/// executable, threads of its own, reading of descriptors, files opened by openat2 (where Landlock keeps them below a
/// folder and for reading), clocks, and its end. Calls that libraries try and can do without fail (EACCES, EPERM,
/// ENOSYS, ENOTTY); all others end the process by SIGSYS. Call it while there is one thread, after PR_SET_NO_NEW_PRIVS.
/// A kernel without seccomp leaves the process as it is.
/// \param folder  the one descriptor that openat2 may begin at; -1 for none.
/// \param result  the one descriptor that may be shared for writing, cut and sealed; -1 for none.
/// Errors: kFailure.
[[nodiscard]] Result<void> enterSeccomp(int folder, int result);

}  // namespace relief

// Memory shared by importMeshInWorker and relief-import: a memfd, sealed once it is complete.
#pragma once

#include <fcntl.h>

#include <cstdint>

#include "formats/base/retry.h"

namespace relief {

/// Allocates the first bytes of a memfd now: touching a page that cannot be allocated raises SIGBUS.
/// \return 0 or an errno: ENOSPC and ENOMEM where the system has no more.
[[nodiscard]] inline int reserveMemory(int file, std::uint64_t bytes) {
    return bytes == 0 ? 0 : retryTransient([&] {
        return ::fallocate(file, 0, 0, static_cast<off_t>(bytes)) == 0 ? 0 : errno;
    });
}

/// Seals a memfd; none of its pages may be mapped for writing. Retries while the kernel itself holds a page (EBUSY).
/// \return 0 or an errno.
[[nodiscard]] inline int addSeals(int file, int seals) {
    return retryTransient([&] { return ::fcntl(file, F_ADD_SEALS, seals) == 0 ? 0 : errno; });
}

}  // namespace relief

// Calls again where the system was short of something for a moment.
#pragma once

#include <cerrno>
#include <ctime>

namespace relief {

/// Whether a call with this errno may succeed a moment later: no process or memory was free, all files of the system were
/// open, or somebody held the pages.
[[nodiscard]] inline bool isTransient(int number) {
    return number == EINTR || number == EAGAIN || number == ENOMEM || number == ENFILE || number == EBUSY;
}

/// Calls up to six times, with pauses of 5, 10, 20, 40 and 80 ms, while the errno is transient.
/// \param call  returns 0 or an errno. \return the last errno; 0 for success.
template <class Call>
[[nodiscard]] int retryTransient(Call&& call) {
    int code = call();
    for (long pause = 5; isTransient(code) && pause <= 80; pause *= 2) {
        const timespec moment{0, pause * 1'000'000};
        ::nanosleep(&moment, nullptr);
        code = call();
    }
    return code;
}

}  // namespace relief

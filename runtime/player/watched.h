// Work of the GPU that a watchdog looks after.
#pragma once

#include <string>

#include "runtime/player/watchdog.h"

namespace relief {

/// Calls `work` and returns its result. The watchdog is fed before it and rests after it.
/// \param watchdog  may be null.
/// \param what      what the GPU does meanwhile, for the watchdog's message: "steps 1 to 16".
template <class Work>
auto watched(Watchdog* watchdog, const std::string& what, const Work& work) {
    if (watchdog == nullptr) {
        return work();
    }
    watchdog->feed(what);
    auto result = work();
    watchdog->rest();
    return result;
}

}  // namespace relief

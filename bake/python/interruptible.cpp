#include "bake/python/interruptible.h"

#include <unistd.h>

#include <cstdio>
#include <cstdlib>

namespace relief {
namespace {

std::atomic<int> g_running = 0;

void endAtOnce(int status, void* /*nothing*/) {
    if (g_running > 0) {
        std::fflush(nullptr);
        ::_exit(status);
    }
}

}  // namespace

MayBeAbandoned::MayBeAbandoned() {
    // Called before the destructors of libraries, whose registration is older.
    static const int registered = ::on_exit(endAtOnce, nullptr);
    static_cast<void>(registered);
    ++g_running;
}

MayBeAbandoned::~MayBeAbandoned() {
    --g_running;
}

}  // namespace relief

// `relief`: the offline tool. Verbs are in command_<verb>.cpp; exit codes are those of formats/base/result.h.
#include <malloc.h>

#include <exception>
#include <new>

#include "bake/cli/command_line.h"
#include "formats/base/ending_signals.h"

int main(int argc, char** argv) {
    relief::endCleanlyOnSignals();
    // Fewer, larger steps of the heap: assimp allocates much in little pieces, and gives it all back.
    mallopt(M_TOP_PAD, 16 << 20);
    try {
        const relief::Result<void> done = relief::runCommandLine(argc, argv);
        return done ? 0 : relief::reportError(done.error());
    } catch (const std::bad_alloc&) {
        return relief::reportError(
            {relief::ErrorCode::kFailure, "out of memory; use smaller maps or a smaller mesh"});
    } catch (const std::exception& e) {
        return relief::reportError({relief::ErrorCode::kFailure, e.what()});
    }
}

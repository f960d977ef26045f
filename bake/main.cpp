// `relief`: the offline tool. Verbs are in bake/cli/command_VERB.cpp; exit codes are those of formats/base/result.h.
#include <malloc.h>

#include "bake/cli/command_line.h"
#include "runtime/tool/command_line.h"

int main(int argc, char** argv) {
    // Fewer, larger steps of the heap: assimp allocates much in little pieces, and gives it all back.
    mallopt(M_TOP_PAD, 16 << 20);
    return relief::runProgram(
        [&] { return relief::runRelief(argc, argv); }, relief::reportError,
        {relief::ErrorCode::kFailure, "out of memory; use smaller maps or a smaller mesh"});
}

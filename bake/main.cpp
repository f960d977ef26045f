// SPDX-License-Identifier: Apache-2.0
// `relief`: the offline tool. Verbs are in bake/cli/command_VERB.cpp; exit codes are those of formats/base/result.h.
#include "bake/cli/command.h"
#include "bake/recipe/child_process.h"
#include "formats/base/heap.h"
#include "runtime/command_line/command_line.h"

int main(int argc, char** argv) {
    relief::ChildProcesses::endWithParent();
    relief::prepareHeap(relief::kBakeHeapBytes);
    return relief::runProgram(
        "relief", [&] { return relief::runRelief(argc, argv); },
        {relief::ErrorCode::kFailure, "out of memory; use smaller maps or a smaller mesh"});
}

// SPDX-License-Identifier: Apache-2.0
// `relief-sim`: simulates scenes. Exit codes: formats/base/result.h.
#include "runtime/cli/sim.h"
#include "runtime/command_line/command_line.h"

int main(int argc, char** argv) {
    return relief::runProgram(
        "relief-sim", [&] { return relief::runSim(argc, argv); },
        {relief::ErrorCode::kLimit, "out of memory; choose a smaller capacity or size"});
}

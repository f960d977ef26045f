// `relief-sim`: plays scenes; exit codes are those of formats/base/result.h.
#include <cstdio>

#include "runtime/cli/sim.h"
#include "runtime/tool/command_line.h"

int main(int argc, char** argv) {
    return relief::runProgram(
        [&] { return relief::runSim(argc, argv); },
        [](const relief::Error& error) {
            std::fprintf(stderr, "relief-sim: error: %s\n", error.message.c_str());
        },
        {relief::ErrorCode::kLimit, "out of memory; choose a smaller capacity or size"});
}

#include "runtime/command_line/memory_option.h"

#include <CLI/CLI.hpp>

#include "runtime/command_line/option_values.h"

namespace relief {

void addMemoryOption(CLI::App& app, ContainerLimits& limits) {
    limits.memory = kToolMemory;
    app.add_option(
           "--max-memory", limits.memory,
           "Texels that a collider may unpack to; default 160MB, or 16 times its file if that is more")
        ->option_text("BYTES")
        ->transform(byteCount());
}

}  // namespace relief

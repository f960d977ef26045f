// --max-memory of everything that reads a collider.
#pragma once

#include <cstdint>

#include "formats/container_limits.h"

namespace CLI {
class App;
}

namespace relief {

/// What the tools unpack of a file that is smaller than a sixteenth of it, bytes: a map of 4096x4096 of eight bytes a
/// texel, and a little.
inline constexpr std::uint64_t kToolMemory = 160'000'000;

/// Lowers limits.memory to kToolMemory, and adds --max-memory, which sets it. `limits` must outlive the app.
void addMemoryOption(CLI::App& app, ContainerLimits& limits);

}  // namespace relief

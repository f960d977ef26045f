// SPDX-License-Identifier: Apache-2.0
// The command line of `relief-sim`.
#pragma once

#include "formats/base/result.h"
#include "runtime/player/player.h"
#include "runtime/player/player_options.h"

namespace CLI {
class App;
}

namespace relief {

struct FrameSize {
    std::uint32_t width = 0;  ///< pixels, as is the next
    std::uint32_t height = 0;
};

/// What the options are read into.
struct SimCommand {
    PlayerOptions player;
    std::optional<FrameSize> size;
    std::optional<DumpFormat> dump_format;
    std::string page;  ///< --page; empty: none
    bool check = false;
    bool json = false;
    bool quiet = false;
};

/// Gives an app named "relief-sim" its options. `command` must outlive it.
void defineSim(CLI::App& app, SimCommand& command);

/// Parses the command line and does what it says.
[[nodiscard]] Result<void> runSim(int argc, char** argv);

}  // namespace relief

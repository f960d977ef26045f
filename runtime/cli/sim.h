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
    std::uint32_t width = 0;   ///< pixels
    std::uint32_t height = 0;  ///< pixels
};

/// The parsed options.
struct SimCommand {
    PlayerOptions player;
    std::optional<FrameSize> size;
    std::optional<DumpFormat> dump_format;
    std::string page;  ///< --page; empty: none
    bool check = false;
    bool json = false;
    bool quiet = false;
};

/// Adds the options of relief-sim to an app. `command` must outlive the app.
void defineSim(CLI::App& app, SimCommand& command);

/// Parses the command line, then runs the simulation, checks the scene or writes the page.
[[nodiscard]] Result<void> runSim(int argc, char** argv);

}  // namespace relief

// SPDX-License-Identifier: Apache-2.0
// Shared by the cases of relief-bench: options, and works that are timed in turns. Nothing here is a test: machines are
// shared and noisy.
#pragma once

#include <cstdint>
#include <functional>
#include <nlohmann/json_fwd.hpp>
#include <string>
#include <vector>

#include "formats/base/result.h"
#include "runtime/particles/particle_system.h"

namespace relief {

using Json = nlohmann::ordered_json;

struct Bench {
    std::string file;             ///< the collider, the animated container, the mesh or the world
    std::uint32_t particles = 0;  ///< 0: the case's own number
    StepPath path = StepPath::kFragment;
    std::string only;                 ///< a variant of the step; empty: all
    std::vector<std::string> bricks;  ///< files of relief-accuracy --atlas, for the step
    std::uint64_t stream_bytes = std::uint64_t{128} << 20;  ///< of the GPU, for stream
    int rounds = 0;                                         ///< 0: the case's own number
    bool large = false;                                     ///< sizes for a GPU
    bool software = false;                                  ///< the processor plays the GPU

    [[nodiscard]] std::uint32_t particlesOr(std::uint32_t on_gpu, std::uint32_t on_cpu) const {
        return particles != 0 ? particles : large || !software ? on_gpu : on_cpu;
    }
};

struct Work {
    std::string name;
    std::function<Result<void>()> run;
    std::string over = {};              ///< the work that its time is divided by; empty: no ratio
    std::function<void()> before = {};  ///< ahead of each block, not timed; may be empty
    std::function<void()> after = {};   ///< behind each block, not timed; may be empty
};

/// A block is some calls between two glFinish, each flushed as the end of a frame is: a driver may keep unflushed calls
/// until glFinish, and the GPU would idle while they are made.
struct Blocks {
    int rounds = 7;  ///< blocks of each work; --blocks overrides
    int calls = 0;   ///< of a block; 0: as many as take 10 ms
};

/// Times works in turns after a call of each, for which the driver compiles. An array of {name, ms, cpu_ms, gpu_ms,
/// over: {of, median, least, most}}, milliseconds of a call as medians over the blocks: by the clock on the wall, of all
/// threads, and by the GPU's clock, null on a software renderer. A ratio is the median of those within each round, which other
/// work on the machine meets alike; with a software renderer it is of CPU time, which that work hardly changes.
/// Errors: those of the works.
[[nodiscard]] Result<Json> timeInTurns(const Bench& bench, const std::vector<Work>& works,
                                       const Blocks& blocks);

/// Calls it for so long: a GPU that has waited slows its clock down. Without effect on a software renderer.
void warmUp(const Bench& bench, double ms, const std::function<void()>& run);

// The cases. Each returns its tables: objects that hold what the table is of, and `rows` of timeInTurns().
[[nodiscard]] Result<Json> benchStep(const Bench& bench);
[[nodiscard]] Result<Json> benchPicture(const Bench& bench);
[[nodiscard]] Result<Json> benchMesh(const Bench& bench);
[[nodiscard]] Result<Json> benchAnimated(const Bench& bench);
/// Its rows are flights: each of 2000 frames, of which the median and the worst are told.
[[nodiscard]] Result<Json> benchStream(const Bench& bench);

}  // namespace relief

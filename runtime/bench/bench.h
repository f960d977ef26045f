// Shared by the cases of relief-bench: options, and works that are timed in turns. Nothing here is a test: machines are
// shared and noisy.
#pragma once

#include <cstdint>
#include <functional>
#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "formats/base/result.h"
#include "runtime/particles/particle_system.h"

namespace relief {

using Json = nlohmann::ordered_json;

struct BenchOptions {
    std::string file;                      ///< the collider or the mesh; empty: none given
    std::vector<std::uint32_t> particles;  ///< a table each; empty: the case's own numbers
    std::uint32_t births = 16667;          ///< a step
    StepPath path = StepPath::kFragment;
    std::string only;     ///< a variant of the step; empty: all
    int rounds = 0;       ///< 0: the case's own number
    bool large = false;   ///< sizes for a GPU
    bool sorted = false;  ///< particles lie on the GPU in the order of their places
};

/// The options, and whether a software renderer plays the GPU.
struct Bench {
    BenchOptions options;
    bool software = false;

    [[nodiscard]] bool large() const { return options.large || !software; }
    [[nodiscard]] std::vector<std::uint32_t> particlesOr(std::vector<std::uint32_t> numbers) const {
        return options.particles.empty() ? std::move(numbers) : options.particles;
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
    /// On a GPU, ahead of each block for so long: a GPU that has waited slows its clock down.
    double warm_ms = 0.0;
    std::function<void()> warm = {};  ///< empty: the work itself
    bool gpu_clock = false;           ///< a GPU's ratios are of its own clock; else of the wall's
};

/// Times works in turns after a call of each, for which the driver compiles. An array of {name, ms, call_ms, cpu_ms,
/// gpu_ms, over: {of, median, least, most}}, milliseconds of a call as medians over the blocks: by the clock on the wall;
/// until the calls return (where that is nearly the whole, the GPU waited for the CPU); of all threads; and by the GPU's
/// clock, null where it has none. A ratio is the median of those within each round, which other work on the machine meets
/// alike; with a software renderer it is of CPU time, which that work hardly changes.
/// Errors: those of the works.
[[nodiscard]] Result<Json> timeInTurns(const Bench& bench, const std::vector<Work>& works,
                                       const Blocks& blocks);

// The cases. Each returns its tables: objects that hold what the table is of, and `rows` of timeInTurns().
[[nodiscard]] Result<Json> benchStep(const Bench& bench);
[[nodiscard]] Result<Json> benchPicture(const Bench& bench);
[[nodiscard]] Result<Json> benchBirths(const Bench& bench);
[[nodiscard]] Result<Json> benchSort(const Bench& bench);
[[nodiscard]] Result<Json> benchStatistics(const Bench& bench);
[[nodiscard]] Result<Json> benchDepthMaps(const Bench& bench);
[[nodiscard]] Result<Json> benchLive(const Bench& bench);

}  // namespace relief

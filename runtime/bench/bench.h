// SPDX-License-Identifier: Apache-2.0
// Shared by the cases of relief-bench: options, and timing of alternating work. Timings are not tests, because machines
// are shared and noisy.
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
    std::string file;             ///< collider, animated container, mesh or world, depending on the case
    std::uint32_t particles = 0;  ///< 0: the default of the case
    StepPath path = StepPath::kFragment;
    std::string only;                 ///< name of a variant; empty: all
    std::vector<std::string> bricks;  ///< files of relief-accuracy --atlas, for the step case
    std::string exact;                ///< mesh to compare with (mesh_tree.h), for the step case; empty: none
    std::uint64_t stream_bytes = std::uint64_t{128} << 20;  ///< GPU budget of the stream case
    int rounds = 0;                                         ///< 0: the default of the case
    bool large = false;                                     ///< GPU problem sizes even on a software renderer
    bool software = false;                                  ///< software renderer

    [[nodiscard]] std::uint32_t particlesOr(std::uint32_t on_gpu, std::uint32_t on_cpu) const {
        return particles != 0 ? particles : large || !software ? on_gpu : on_cpu;
    }
};

struct Work {
    std::string name;
    std::function<Result<void>()> run;
    std::string over = {};              ///< workload to divide the times by; empty: no ratio
    std::function<void()> before = {};  ///< called before each block, not timed; may be empty
    std::function<void()> after = {};   ///< called after each block, not timed; may be empty
};

/// A block is a workload's calls between two glFinish(). Each call is flushed like the end of a frame; otherwise a
/// driver may hold back calls until glFinish, and the GPU would idle.
struct Blocks {
    int rounds = 7;  ///< blocks per workload; --blocks overrides it
    int calls = 0;   ///< calls per block; 0: as many as take 10 ms
};

/// Times workloads in alternation, after one untimed call of each for shader compilation. Returns an array of {name,
/// ms, cpu_ms, gpu_ms, over: {of, median, least, most}}: milliseconds per call as medians over the blocks, by wall
/// clock, CPU time of all threads, and GPU time (null on a software renderer). Ratios are computed for each round, so
/// that other load on the machine affects both workloads equally; `median` is over the rounds. With a software
/// renderer, ratios use CPU time, which other load hardly changes.
/// Errors: those of the workloads.
[[nodiscard]] Result<Json> timeAlternating(const Bench& bench, const std::vector<Work>& works,
                                           const Blocks& blocks);

/// Calls `run` for `ms` milliseconds, because idle GPUs reduce their clock. Does nothing on a software renderer.
void warmUp(const Bench& bench, double ms, const std::function<void()>& run);

// The cases. Each returns an array of tables: objects with a description and `rows`, the result of timeAlternating().
[[nodiscard]] Result<Json> benchStep(const Bench& bench);
[[nodiscard]] Result<Json> benchPicture(const Bench& bench);
[[nodiscard]] Result<Json> benchMesh(const Bench& bench);
[[nodiscard]] Result<Json> benchAnimated(const Bench& bench);
/// Each row summarises 2000 frames (120 on a software renderer) in which the camera hovers or flies over the world: the
/// median, the 99th percentile and the slowest frame.
[[nodiscard]] Result<Json> benchStream(const Bench& bench);

}  // namespace relief

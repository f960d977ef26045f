// `relief bake` for programs that want the collider and no file: the package of Python.
#pragma once

#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "bake/cli/bake_settings.h"
#include "bake/mesh/mesh.h"
#include "formats/base/result.h"
#include "formats/collider.h"

namespace relief {

/// The command of a command line. \param options  its words, without the mesh and the output: "--budget=256kB", "--paper".
/// Errors: kUsage, as `relief bake` has them.
[[nodiscard]] Result<BakeCommand> bakeCommandOf(std::vector<std::string> options);

struct BakedInMemory {
    Collider collider;                  ///< the one that `relief bake` would write
    std::vector<std::string> warnings;  ///< those that it would print
};

/// Bakes the mesh, and writes nothing but the plan of --plan-out. Options about the output and the time have no effect.
/// \param command     its mesh is the file to read.
/// \param mesh        as finishMesh leaves it: instead of a file.
/// \param checkpoint  called now and then, from any thread; what it throws comes out of here and ends the bake.
/// Errors: those of `relief bake`; kUsage: options that need the mesh's file.
[[nodiscard]] Result<BakedInMemory> bakeInMemory(BakeCommand command, std::optional<TriangleMesh> mesh,
                                                 std::function<void()> checkpoint);

}  // namespace relief

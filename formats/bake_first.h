// A mesh where a baked collider is needed: the commonest mix-up, and its cure.
#pragma once

#include <cstddef>
#include <filesystem>
#include <span>

#include "formats/base/result.h"

namespace relief {

/// Fails with kInvalidInput if the name is that of a mesh: "it is a mesh; bake it first: relief bake …", the path in
/// front.
[[nodiscard]] Result<void> refuseMeshName(const std::filesystem::path& path);

/// The same, unless the contents begin as a container does, whatever its name.
[[nodiscard]] Result<void> refuseMesh(const std::filesystem::path& path, std::span<const std::byte> bytes);

}  // namespace relief

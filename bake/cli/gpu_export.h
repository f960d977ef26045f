// `relief export --gpu`: what a program of one's own uploads, as files. runtime/collider/LAYOUT.md describes them.
#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "formats/base/result.h"
#include "formats/collider.h"

namespace relief {

/// gpu.json, block.bin, collider.glsl and a file for each texture that holds something: the names of what exportForGpu()
/// writes.
[[nodiscard]] std::vector<std::string> gpuFileNames(const Collider& collider);

/// Writes them. \param folder  exists.
/// Fails as gpuImage and writeFile do.
[[nodiscard]] Result<void> exportForGpu(const Collider& collider, const std::filesystem::path& folder);

}  // namespace relief

// `relief export --gpu`: what a program of one's own uploads, as files. runtime/collider/LAYOUT.md describes them.
#pragma once

#include <filesystem>

#include "formats/base/result.h"
#include "formats/collider.h"

namespace relief {

/// Writes gpu.json, block.bin, collider.glsl and a file for each texture that holds something; returns how many files.
/// \param folder  exists.
/// Fails as gpuImage and writeFile do.
[[nodiscard]] Result<int> exportForGpu(const Collider& collider, const std::filesystem::path& folder);

}  // namespace relief

// The readers of a scene's tables that live in files of their own. All throw SceneError.
#pragma once

#include <filesystem>
#include <string_view>
#include <vector>

#include "runtime/scene_emitter.h"
#include "runtime/scene_table.h"

namespace relief {

/// [emitter], or [[emitter]] as often as wanted; one emitter with every default where there is neither.
/// \param folder  of the scene. \param capacity  of the particles.
[[nodiscard]] std::vector<SceneEmitter> readEmitters(SceneTable& top, std::string_view file,
                                                     const std::filesystem::path& folder,
                                                     std::uint32_t capacity);

}  // namespace relief

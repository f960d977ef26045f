// Readers of parts of a scene that have files of their own; parseScene calls them. All throw SceneError.
#pragma once

#include <filesystem>
#include <string_view>
#include <vector>

#include "runtime/scene.h"
#include "runtime/scene_emitter.h"
#include "runtime/scene_table.h"

namespace relief {

/// The keys of [render] that say how particles are sorted (scene_sort.cpp). Throws SceneError.
void readSort(SceneTable& table, Scene& scene);
/// Makes the tables of readAir known to `top`; call before its finish().
void nameAirTables(SceneTable& top);
/// [[attractor]], [[vortex]], [flow] and [curl_noise]; call when scene.forces is read.
void readAir(SceneTable& top, const std::filesystem::path& folder, Scene& scene);
/// forces.viscosity; `forces` is the table of that name.
void readViscosity(SceneTable& forces, Scene& scene);
/// [emitter], or [[emitter]] as often as wanted; one emitter with every default where there is neither.
/// \param folder  of the scene. \param capacity  of the particles.
[[nodiscard]] std::vector<SceneEmitter> readEmitters(SceneTable& top, std::string_view file,
                                                     const std::filesystem::path& folder,
                                                     std::uint32_t capacity);

}  // namespace relief

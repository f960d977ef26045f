// Readers of parts of a scene file that have a source file of their own. For scene.cpp alone.
#pragma once

#include "runtime/scene.h"
#include "runtime/scene_table.h"

namespace relief {

/// The keys of [render] that say how particles are sorted (scene_sort.cpp). Throws SceneError.
void readSort(SceneTable& table, Scene& scene);

}  // namespace relief

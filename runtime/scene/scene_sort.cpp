#include "runtime/scene/scene_readers.h"

namespace relief {
namespace {

constexpr double kSortFramesMax = 200;

}  // namespace

void readSort(SceneTable& table, Scene& scene) {
    std::uint32_t& frames = scene.render.sort_frames;
    table.integer("sort_frames", {0.0, kSortFramesMax}, frames);
    // A whole sequence each frame is what the spreading is there to avoid.
    if (frames == 1) {
        table.failAt(*table.find("sort_frames"),
                     table.full("sort_frames") + " = 1 is out of range; choose 0, for no sort, or 2 to 200");
    }
}

}  // namespace relief

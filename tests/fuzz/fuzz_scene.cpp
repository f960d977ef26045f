// SPDX-License-Identifier: Apache-2.0
// Scene files: any input gives a scene, or one line with file, line and column.
#include <string_view>

#include "runtime/scene/scene.h"
#include "tests/fuzz/target.h"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
    const std::string_view text(reinterpret_cast<const char*>(data), size);
    auto scene = relief::parseScene(text, "/scenes/scene.toml");
    if (!scene) {
        mustHold(scene.error().message.find("scene.toml") != std::string::npos, "an error names the file");
        mustBeLine(scene.error().message);
        return 0;
    }
    mustHold(!scene->colliders.empty(), "a scene has a collider");
    mustHold(!scene->emitters.empty(), "a scene has an emitter");
    const auto whole = relief::withDefaults(*std::move(scene), {{-1.0F, -2.0F, -3.0F}, {1.0F, 2.0F, 3.0F}});
    mustHold(whole.has_value() || !whole.error().message.empty(), "an error has a message");
    return 0;
}

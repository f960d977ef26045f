// SPDX-License-Identifier: Apache-2.0
// World files: any input gives a world that round-trips, or a one-line error.
#include <cmath>
#include <string_view>

#include "formats/world/world.h"
#include "tests/fuzz/target.h"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
    const std::string_view text(reinterpret_cast<const char*>(data), size);
    const auto world = relief::parseWorld(text);
    if (!world) {
        mustHold(world.error().message.find("; ") != std::string::npos, "an error has advice");
        mustBeLine(world.error().message);
        return 0;
    }
    for (const relief::WorldCollider& collider : world->colliders) {
        mustHold(!std::filesystem::path(collider.file).is_absolute() &&
                     collider.file.find("../") == std::string::npos,
                 "no path leads out of the folder");
    }
    for (const relief::WorldBody& body : world->bodies) {
        mustHold(body.collider < world->colliders.size() && body.scale > 0.0F,
                 "a body has a collider and a size");
        mustHold(std::isfinite(body.position.x + body.position.y + body.position.z), "positions are finite");
    }
    const std::string written = relief::worldText(*world);
    const auto again = relief::parseWorld(written);
    mustHold(again.has_value(), "a written world can be read");
    mustHold(
        again->bodies.size() == world->bodies.size() && again->colliders.size() == world->colliders.size(),
        "a world keeps its bodies and colliders");
    return 0;
}

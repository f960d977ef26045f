// SPDX-License-Identifier: Apache-2.0
#include "bake/engines/engine_export.h"

#include <algorithm>
#include <cmath>
#include <cstring>
#include <span>

#include "bake/engines/body_cells.h"
#include "bake/engines/engine_constants.h"
#include "bake/engines/engine_texts.h"
#include "formats/container.h"

namespace relief {
namespace {

/// A text of the project, and its name in the export.
struct CopiedText {
    std::string_view path;
    std::string_view name;
};

std::vector<CopiedText> textsOf(Engine engine) {
    switch (engine) {
        case Engine::kC:
            return {{"formats/single/relief.h", "relief.h"},
                    {"samples/own_engine/bounce.c", "bounce.c"},
                    {"samples/own_engine/README.md", "README.md"},
                    {"shaders/engines/relief.glsl", "relief.glsl"},
                    {"shaders/engines/relief.hlsl", "relief.hlsl"},
                    {"shaders/engines/relief.metal", "relief.metal"},
                    {"shaders/engines/relief.wgsl", "relief.wgsl"}};
        case Engine::kGodot:
        case Engine::kUnity:
        case Engine::kUnreal:
        case Engine::kThree:
        case Engine::kPlaycanvas:
            break;
    }
    return {};
}

std::vector<std::byte> bytesOf(std::string_view text) {
    const auto bytes = std::as_bytes(std::span(text));
    return {bytes.begin(), bytes.end()};
}

template <class T>
std::vector<std::byte> bytesOf(const std::vector<T>& values) {
    const auto bytes = std::as_bytes(std::span(values));
    return {bytes.begin(), bytes.end()};
}

void appendTexts(std::vector<EngineFile>& files, Engine engine) {
    for (const CopiedText& text : textsOf(engine)) {
        files.push_back({std::string(text.name), bytesOf(engineText(text.path))});
    }
}

}  // namespace

Result<std::vector<EngineFile>> engineFiles(const Collider& collider, std::string_view name, Engine engine) {
    const DepthMap* map = RELIEF_TRY(engineMap(collider));
    std::vector<EngineFile> files;
    files.push_back({std::string(name) + ".relief", RELIEF_TRY(writeContainer(collider))});
    std::vector<std::byte> texels = map->texels;
    fillRow(texels);
    files.push_back({std::string(name) + ".texels", std::move(texels)});
    files.push_back({std::string(name) + ".constants", bytesOf(std::vector{engineConstants(*map)})});
    appendTexts(files, engine);
    return files;
}

Result<std::vector<EngineFile>> engineFiles(const LoadedWorld& loaded, std::string_view name, Engine engine) {
    std::vector<std::byte> texels;
    std::vector<EngineConstants> colliders;
    for (std::size_t i = 0; i < loaded.colliders.size(); ++i) {
        const DepthMap* map =
            RELIEF_TRY(withPrefix(loaded.world.colliders[i].file, engineMap(loaded.colliders[i])));
        const std::size_t first = texels.size() / kEngineTexelBytes;
        if (first + map->texels.size() / kEngineTexelBytes > kEngineTexelsMax) {
            return fail(ErrorCode::kLimit, "the colliders of this level exceed the " +
                                               std::to_string(kEngineTexelsMax) +
                                               " texels of one texture; bake it with a smaller --budget");
        }
        colliders.push_back(engineConstants(*map, static_cast<std::uint32_t>(first)));
        texels.insert(texels.end(), map->texels.begin(), map->texels.end());
    }
    fillRow(texels);
    std::vector<EngineBody> bodies;
    for (const WorldBody& body : loaded.world.bodies) {
        const Pose pose = poseOf(body);
        const Bounds box = toWorld(pose, loaded.world.colliders[body.collider].box);
        bodies.push_back({placedConstants(colliders[body.collider], pose),
                          {box.min.x, box.min.y, box.min.z, body.restitution},
                          {box.max.x, box.max.y, box.max.z, body.friction}});
    }
    std::vector<EngineFile> files;
    files.push_back({std::string(name) + ".texels", std::move(texels)});
    files.push_back({std::string(name) + ".bodies", bytesOf(bodies)});
    files.push_back({std::string(name) + ".cells", bytesOf(bodyCells(bodies))});
    appendTexts(files, engine);
    return files;
}

}  // namespace relief

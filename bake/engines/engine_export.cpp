// SPDX-License-Identifier: Apache-2.0
#include "bake/engines/engine_export.h"

#include <span>

#include "bake/engines/body_cells.h"
#include "bake/engines/engine_constants.h"
#include "bake/engines/engine_texts.h"
#include "formats/container.h"

namespace relief {
namespace {

/// A text of the project, and its name in the export.
struct CopiedText {
    Engine engine;
    std::string_view path;
    std::string_view name;
};

// embed.cmake reads the paths from here.
constexpr CopiedText kTexts[] = {
    {Engine::kC, "formats/single/relief.h", "relief.h"},
    {Engine::kC, "samples/own_engine/bounce.c", "bounce.c"},
    {Engine::kC, "samples/own_engine/README.md", "RELIEF.md"},
    {Engine::kC, "shaders/engines/relief.glsl", "relief.glsl"},
    {Engine::kC, "shaders/engines/relief.hlsl", "relief.hlsl"},
    {Engine::kC, "shaders/engines/relief.metal", "relief.metal"},
    {Engine::kC, "shaders/engines/relief.wgsl", "relief.wgsl"},
    {Engine::kGodot, "samples/godot/README.md", "RELIEF.md"},
    {Engine::kGodot, "samples/godot/addons/relief/plugin.cfg", "addons/relief/plugin.cfg"},
    {Engine::kGodot, "samples/godot/addons/relief/plugin.gd", "addons/relief/plugin.gd"},
    {Engine::kGodot, "samples/godot/addons/relief/relief_body.gdshaderinc",
     "addons/relief/relief_body.gdshaderinc"},
    {Engine::kGodot, "samples/godot/addons/relief/relief_checksum.gd", "addons/relief/relief_checksum.gd"},
    {Engine::kGodot, "samples/godot/addons/relief/relief_collider.gd", "addons/relief/relief_collider.gd"},
    {Engine::kGodot, "samples/godot/addons/relief/relief_loader.gd", "addons/relief/relief_loader.gd"},
    {Engine::kGodot, "samples/godot/addons/relief/relief_particles.gd", "addons/relief/relief_particles.gd"},
    {Engine::kGodot, "samples/godot/addons/relief/relief_particles.gdshader",
     "addons/relief/relief_particles.gdshader"},
    {Engine::kGodot, "shaders/engines/relief.gdshaderinc", "addons/relief/relief.gdshaderinc"},
    {Engine::kUnity, "samples/unity/README.md", "RELIEF.md"},
    {Engine::kUnity, "shaders/engines/relief.hlsl", "relief.hlsl"},
    {Engine::kUnreal, "samples/unreal/README.md", "RELIEF.md"},
    {Engine::kUnreal, "shaders/engines/relief.hlsl", "relief.hlsl"},
    {Engine::kThree, "samples/web/engines/three.md", "RELIEF.md"},
    {Engine::kThree, "samples/web/engines/three.html", "index.html"},
    {Engine::kThree, "samples/web/engines/three_webgl.js", "three_webgl.js"},
    {Engine::kThree, "samples/web/engines/three_webgpu.js", "three_webgpu.js"},
    {Engine::kThree, "samples/web/engines/snow.js", "snow.js"},
    {Engine::kPlaycanvas, "samples/web/engines/playcanvas.md", "RELIEF.md"},
    {Engine::kPlaycanvas, "samples/web/engines/playcanvas.html", "index.html"},
    {Engine::kPlaycanvas, "samples/web/engines/playcanvas.js", "playcanvas.js"},
    {Engine::kPlaycanvas, "samples/web/engines/snow.js", "snow.js"},
};

/// JavaScript modules for three.js and PlayCanvas.
constexpr std::string_view kModules[] = {
    "runtime/web/engines/bytes.js",     "runtime/web/engines/index.d.ts",  "runtime/web/engines/index.js",
    "runtime/web/engines/materials.js", "runtime/web/engines/metadata.js", "runtime/web/engines/open.js",
    "runtime/web/engines/patches.js",   "runtime/web/engines/xxh3.js",     "runtime/web/engines/zstd.js",
};

/// Returns a text as a template literal of JavaScript.
std::string literal(std::string_view text) {
    std::string result = "`";
    for (const char c : text) {
        result += c == '`' || c == '\\' || c == '$' ? "\\" : "";
        result += c;
    }
    return result + "`";
}

/// Returns a file name as part of a URL.
std::string inUrl(std::string_view name) {
    constexpr std::string_view kDigits = "0123456789ABCDEF";
    constexpr std::string_view kPlain = "0123456789-._abcdefghijklmnopqrstuvwxyzABCDEFGHIJKLMNOPQRSTUVWXYZ";
    std::string result;
    for (const char c : name) {
        const auto byte = static_cast<unsigned char>(c);
        result += kPlain.find(c) != kPlain.npos ? std::string{c}
                                                : std::string{'%', kDigits[byte / 16], kDigits[byte % 16]};
    }
    return result;
}

/// \param values  a string or a vector
template <class Values>
std::vector<std::byte> bytesOf(const Values& values) {
    const auto bytes = std::as_bytes(std::span(values));
    return {bytes.begin(), bytes.end()};
}

void replaceAll(std::string& text, std::string_view from, std::string_view to) {
    for (std::size_t at = 0; (at = text.find(from, at)) != std::string::npos; at += to.size()) {
        text.replace(at, from.size(), to);
    }
}

/// Appends the texts of an engine. Adapts web samples, so that they import and load the files of the export.
/// \param name  of the collider; empty for a level, which has no samples.
void appendTexts(std::vector<EngineFile>& files, Engine engine, std::string_view name) {
    for (const CopiedText& copied : kTexts) {
        if (copied.engine == engine && !(name.empty() && copied.path.starts_with("samples/"))) {
            std::string text(engineText(copied.path));
            if (copied.name.ends_with(".js")) {
                replaceAll(text, "relief-particles/collider", "./relief/index.js");
                replaceAll(text, "body.relief", inUrl(name) + ".relief");
            }
            files.push_back({std::string(copied.name), bytesOf(text)});
        }
    }
    if (engine != Engine::kThree && engine != Engine::kPlaycanvas) {
        return;
    }
    for (const std::string_view module : kModules) {
        std::string text(engineText(module));
        // Embeds the shaders, which browsers cannot import. For the npm package, a bundler embeds them.
        for (const std::string language : {"glsl", "wgsl"}) {
            const std::string shader = "shaders/engines/relief." + language;
            replaceAll(text, "export { default as " + language + " } from \"../../../" + shader + "\"",
                       "export const " + language + " = " + literal(engineText(shader)));
        }
        files.push_back({"relief" + std::string(module.substr(module.rfind('/'))), bytesOf(text)});
    }
}

}  // namespace

Result<std::vector<EngineFile>> engineFiles(const Collider& collider, std::string_view name, Engine engine) {
    const DepthMap* map = RELIEF_TRY(engineMap(collider));
    std::vector<EngineFile> files;
    const bool raw = engine == Engine::kUnity || engine == Engine::kUnreal;
    if (!raw) {
        files.push_back({std::string(name) + ".relief", RELIEF_TRY(writeContainer(collider))});
    }
    if (raw || engine == Engine::kC) {
        std::vector<std::byte> texels = map->texels;
        fillRow(texels);
        files.push_back({std::string(name) + ".texels", std::move(texels)});
        files.push_back({std::string(name) + ".constants", bytesOf(std::vector{patchConstants(*map)})});
    }
    appendTexts(files, engine, name);
    return files;
}

Result<std::vector<EngineFile>> engineFiles(const LoadedWorld& loaded, std::string_view name, Engine engine) {
    std::vector<std::byte> texels;
    std::vector<PatchConstants> colliders;
    for (std::size_t i = 0; i < loaded.colliders.size(); ++i) {
        const DepthMap* map =
            RELIEF_TRY(withPrefix(loaded.world.colliders[i].file, engineMap(loaded.colliders[i])));
        const std::size_t first = texels.size() / kPatchTexelBytes;
        if (first + map->texels.size() / kPatchTexelBytes > kEngineTexelsMax) {
            return fail(ErrorCode::kLimit, "the colliders of this world exceed the " +
                                               std::to_string(kEngineTexelsMax) +
                                               " texels of one texture; bake it with a smaller --budget");
        }
        colliders.push_back(patchConstants(*map, first));
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
    fillRow(files.back().bytes, kBodiesPerRow * sizeof(EngineBody));
    files.push_back({std::string(name) + ".cells", bytesOf(bodyCells(bodies))});
    fillRow(files.back().bytes, kEngineTextureWidth * sizeof(std::uint32_t));
    files.push_back({"RELIEF.md", bytesOf(engineText("bake/engines/README.md"))});
    appendTexts(files, engine, {});
    return files;
}

}  // namespace relief

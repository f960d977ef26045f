// SPDX-License-Identifier: Apache-2.0
#include "runtime/scene/scene_parser.h"

#include "formats/base/file_io.h"
#include "formats/config/toml_reader.h"

namespace relief {
namespace {

namespace fs = std::filesystem;

constexpr std::uint64_t kSceneBytesMax = std::uint64_t{1} << 20;

}  // namespace

void readScene(const TomlValue& top, Scene& scene) {
    readToml(top, scene);
}

Result<Scene> parseScene(std::string_view text, const fs::path& path, const fs::path& root) {
    Scene scene;
    RELIEF_TRY(readTomlFile(text, {oneLine(path.native()), path.parent_path(), root, "scene"},
                            [&](const TomlValue& top) { readScene(top, scene); }));
    return scene;
}

Result<Scene> loadScene(const fs::path& path, const fs::path& root) {
    const auto bytes = RELIEF_TRY(readFile(path, kSceneBytesMax));
    return parseScene({reinterpret_cast<const char*>(bytes.data()), bytes.size()}, path, root);
}

}  // namespace relief

#include "formats/bake_first.h"

#include <algorithm>
#include <array>
#include <string>
#include <string_view>

#include "formats/base/file_io.h"
#include "formats/base/text.h"

namespace relief {
namespace {

/// Common formats of `relief bake`; those that cannot be mistaken for a collider are left out.
constexpr std::array<std::string_view, 14> kMeshExtensions = {".3ds",  ".b3d",  ".blend", ".dae", ".fbx",
                                                              ".glb",  ".gltf", ".lwo",   ".obj", ".off",
                                                              ".ms3d", ".ply",  ".stl",   ".x"};

/// The first byte of every container (formats/README.md, "Bytes"): no letter, and not the beginning of any mesh above.
constexpr std::byte kContainerBegins{0xAB};

}  // namespace

Result<void> refuseMeshName(const std::filesystem::path& path) {
    const std::string extension = lowerCase(path.extension().native());
    if (std::find(kMeshExtensions.begin(), kMeshExtensions.end(), extension) == kMeshExtensions.end()) {
        return {};
    }
    std::filesystem::path baked = path;
    baked.replace_extension(".relief");
    return fail(ErrorCode::kInvalidInput, quotedPath(path) +
                                              " is a mesh, and no collider; bake it first: relief bake " +
                                              quotedPath(path) + " -o " + quotedPath(baked));
}

Result<void> refuseMesh(const std::filesystem::path& path, std::span<const std::byte> bytes) {
    return !bytes.empty() && bytes.front() == kContainerBegins ? Result<void>() : refuseMeshName(path);
}

}  // namespace relief

#include "bake/world/world_files.h"

#include <set>
#include <span>
#include <system_error>

#include "bake/recipe/bake_cache.h"
#include "bake/recipe/recipe_jobs.h"
#include "formats/base/file_io.h"

namespace relief {
namespace {

namespace fs = std::filesystem;

constexpr std::size_t kStemMax = 64;

std::vector<WorldCollider> collidersOf(const fs::path& path) {
    const auto bytes = readFile(path, kWorldBytesMax);
    if (!bytes) {
        return {};
    }
    Result<World> world = parseWorld({reinterpret_cast<const char*>(bytes->data()), bytes->size()});
    return world ? std::move(world->colliders) : std::vector<WorldCollider>();
}

std::vector<std::string> removeUnnamed(const fs::path& folder, const std::vector<WorldCollider>& before,
                                       const World& world) {
    std::set<std::string> named;
    for (const WorldCollider& collider : world.colliders) {
        named.insert(collider.file);
    }
    std::vector<std::string> removed;
    for (const WorldCollider& old : before) {
        const fs::path path = folder / old.file;
        std::error_code error;
        const bool own = old.file.ends_with(kColliderExtension) && !fs::path(old.file).has_parent_path() &&
                         !named.contains(old.file) && hashOfFile(path) == old.hash;
        if (own && fs::remove(path, error)) {
            removed.push_back(old.file);
        }
    }
    return removed;
}

}  // namespace

std::string fileStem(std::string_view name) {
    std::string stem;
    for (const char c : name.substr(0, kStemMax)) {
        const bool plain = (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z') || (c >= '0' && c <= '9') ||
                           c == '-' || c == '.' || c == '_';
        stem += plain ? c : '_';
    }
    return stem.empty() || stem.front() == '.' || stem.front() == '-' ? "_" + stem : stem;
}

Result<std::vector<std::string>> replaceWorld(const fs::path& folder, const World& world,
                                              const std::string& name) {
    const std::string text = worldText(world);
    // A world that no reader would take must not be written: scales or places that floats do not hold.
    static_cast<void>(RELIEF_TRY(inFront(name, parseWorld(text))));
    const fs::path path = folder / kWorldFileName;
    const std::vector<WorldCollider> before = collidersOf(path);
    RELIEF_TRY(writeFile(path, std::as_bytes(std::span(text))));
    return removeUnnamed(folder, before, world);
}

}  // namespace relief

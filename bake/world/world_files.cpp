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

std::vector<WorldFile> filesOf(const std::vector<WorldCollider>& colliders) {
    std::vector<WorldFile> files;
    for (const WorldCollider& collider : colliders) {
        files.push_back(collider);
        if (collider.coarse) {
            files.push_back(*collider.coarse);
        }
    }
    return files;
}

std::vector<WorldFile> filesOf(const fs::path& path) {
    const Result<World> world = loadWorldFile(path);
    return world ? filesOf(world->colliders) : std::vector<WorldFile>();
}

std::vector<std::string> removeUnnamed(const fs::path& folder, const std::vector<WorldFile>& before,
                                       const World& world) {
    std::set<std::string> named;
    for (const WorldFile& file : filesOf(world.colliders)) {
        named.insert(file.file);
    }
    std::vector<std::string> removed;
    for (const WorldFile& old : before) {
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
    const std::vector<WorldFile> before = filesOf(path);
    RELIEF_TRY(writeFile(path, std::as_bytes(std::span(text))));
    return removeUnnamed(folder, before, world);
}

}  // namespace relief

#include "bake/recipe/prune.h"

#include <fcntl.h>
#include <sys/stat.h>
#include <unistd.h>

#include <cerrno>
#include <system_error>

#include "bake/recipe/bake_cache.h"
#include "formats/base/descriptor.h"

namespace relief {
namespace {

namespace fs = std::filesystem;

/// A name that recipeJobs() could have made: the cache may be anybody's.
bool isOutputName(const fs::path& name) {
    if (name.empty() || name.is_absolute() || name != name.lexically_normal() ||
        !name.native().ends_with(kColliderExtension) || name.filename() == kColliderExtension ||
        name.native().find('\0') != std::string::npos) {
        return false;
    }
    return *name.begin() != "..";
}

std::string failure(int code) {
    // ELOOP is a link where a file was opened, ENOTDIR one where a folder was.
    return code == ELOOP || code == ENOTDIR ? "a symbolic link leads there"
                                            : std::system_category().message(code);
}

/// A file below a folder, reached without following any link.
struct Reached {
    Descriptor folder;  ///< that it lies in
    Descriptor file;
    int code = 0;  ///< errno, where it cannot be opened
};

Reached reach(const fs::path& output_folder, const fs::path& name) {
    constexpr int kFolder = O_RDONLY | O_DIRECTORY | O_CLOEXEC;
    Reached reached;
    reached.folder = Descriptor(::open(output_folder.c_str(), kFolder));
    for (const fs::path& part : name.parent_path()) {
        if (reached.folder) {
            reached.folder = Descriptor(::openat(reached.folder.get(), part.c_str(), kFolder | O_NOFOLLOW));
        }
    }
    if (reached.folder) {
        reached.file = Descriptor(::openat(reached.folder.get(), name.filename().c_str(),
                                           O_RDONLY | O_NONBLOCK | O_NOFOLLOW | O_CLOEXEC));
    }
    reached.code = reached.file ? 0 : errno;
    return reached;
}

/// Removes one output, or finds out why it stays.
/// \return false if there is no such file.
bool prune(const fs::path& output_folder, const BakeCacheEntry& entry, bool dry_run, PrunedOutput& pruned) {
    const fs::path name = pruned.output;
    const Reached reached = reach(output_folder, name);
    struct stat status {};
    if (reached.code == ENOENT) {
        return false;
    }
    if (!reached.file || ::fstat(reached.file.get(), &status) != 0 || !S_ISREG(status.st_mode)) {
        pruned.kept = reached.code == 0 ? "it is no file" : failure(reached.code);
        return true;
    }
    pruned.bytes = static_cast<std::uint64_t>(status.st_size);
    if (hashOfFile("/proc/self/fd/" + std::to_string(reached.file.get())) != entry.output_hash) {
        pruned.kept = "it is not what was baked";
    } else if (!dry_run && ::unlinkat(reached.folder.get(), name.filename().c_str(), 0) != 0) {
        pruned.kept = std::system_category().message(errno);
    }
    return true;
}

}  // namespace

Result<std::vector<PrunedOutput>> pruneOutputs(const fs::path& output_folder, const std::string& recipe,
                                               const std::function<bool(const std::string&)>& wanted,
                                               bool dry_run) {
    std::vector<PrunedOutput> found;
    const auto look = [&](BakeCacheEntries& entries) {
        std::erase_if(entries, [&](const auto& named) {
            const auto& [output, entry] = named;
            if (recipe.empty() || entry.recipe != recipe || !isOutputName(output) || wanted(output)) {
                return false;
            }
            PrunedOutput pruned{output, entry.inputs.front().path};
            if (!prune(output_folder, entry, dry_run, pruned)) {
                return true;
            }
            found.push_back(pruned);
            return pruned.kept.empty();
        });
    };
    if (dry_run) {
        BakeCacheEntries entries = loadBakeCache(output_folder).value_or(BakeCacheEntries{});
        look(entries);
        return found;
    }
    RELIEF_TRY(editBakeCache(output_folder, look));
    return found;
}

}  // namespace relief

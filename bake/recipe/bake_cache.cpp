// SPDX-License-Identifier: Apache-2.0
#include "bake/recipe/bake_cache.h"

#include <fcntl.h>
#include <sys/file.h>

#include <algorithm>
#include <nlohmann/json.hpp>
#include <set>
#include <span>
#include <system_error>

#include "formats/base/descriptor.h"
#include "formats/base/file_io.h"
#include "formats/base/hash.h"
#include "formats/base/result.h"
#include "formats/base/text.h"
#include "formats/world/world.h"

namespace relief {
namespace {

namespace fs = std::filesystem;
using Json = nlohmann::ordered_json;

constexpr std::uint64_t kCacheBytesMax = std::uint64_t{256} << 20;
constexpr const char* kFormat = "relief-cache";
constexpr int kCacheVersion = 1;

/// Locks a folder; does nothing if the file system has no locks.
class FolderLock {
  public:
    explicit FolderLock(const fs::path& folder)
        : folder_(::open(folder.c_str(), O_RDONLY | O_DIRECTORY | O_CLOEXEC)) {
        while (folder_ && ::flock(folder_.get(), LOCK_EX) != 0 && errno == EINTR) {
        }
    }

  private:
    Descriptor folder_;
};

/// Throws Json::exception if a member is missing or has another type.
BakeCacheEntry entryOf(const Json& json) {
    BakeCacheEntry entry;
    entry.tool = json.at("tool").get<std::string>();
    entry.output_hash = json.at("output_hash").get<std::string>();
    entry.output_bytes = json.at("output_bytes").get_ref<const Json::number_unsigned_t&>();
    entry.options = json.at("options").get<std::vector<std::string>>();
    const Json& inputs = json.at("inputs");
    static_cast<void>(inputs.at(0));  // throws if it is empty: such an entry would never become stale
    for (const Json& input : inputs) {
        entry.inputs.push_back({input.at("file").get<std::string>(), input.at("hash").get<std::string>()});
    }
    if (json.contains("containers")) {
        entry.containers = json["containers"].get<std::map<std::string, std::string>>();
    }
    if (json.contains("wrong_percent")) {
        entry.wrong_percent = json["wrong_percent"].get<double>();
    }
    return entry;
}

}  // namespace

Result<std::string> toolIdentity() {
    const fs::path self = "/proc/self/exe";
    const auto bytes = RELIEF_TRY(readFile(self));
    std::string identity = std::string("relief ") + RELIEF_VERSION + " " + xxh3_128Hex(bytes);
    // The worker that imports meshes, if it is next to this program.
    std::error_code error;
    const fs::path importer = fs::read_symlink(self, error).parent_path() / "relief-import";
    if (const std::optional<std::string> hash = hashOfFile(importer); hash) {
        identity += " " + *hash;
    }
    return identity;
}

std::optional<std::string> hashOfFile(const fs::path& path) {
    std::error_code error;
    if (!fs::is_regular_file(path, error)) {
        return std::nullopt;
    }
    const auto bytes = readFile(path);
    return bytes ? std::optional(xxh3_128Hex(*bytes)) : std::nullopt;
}

std::optional<std::string> hashOfInput(const fs::path& path) {
    std::error_code error;
    if (!fs::is_directory(path, error)) {
        return hashOfFile(path);
    }
    std::set<std::string> names;
    fs::directory_iterator entry(path, error);
    for (; !error && entry != fs::directory_iterator(); entry.increment(error)) {
        const std::string name = entry->path().filename().string();
        if (!name.starts_with('.') && !name.ends_with(kColliderExtension) && name != kWorldFileName) {
            names.insert(name);
        }
    }
    std::string text;
    for (const std::string& name : names) {
        text += name + '\0';
    }
    return error ? std::nullopt : std::optional(xxh3_128Hex(std::as_bytes(std::span(text))));
}

Result<BakeCacheEntries> parseBakeCache(std::string_view text) {
    try {
        const Json json = Json::parse(text);
        if (json.at("format") == kFormat && json.at("version") == kCacheVersion) {
            BakeCacheEntries entries;
            for (const auto& [name, value] : json.at("outputs").get_ref<const Json::object_t&>()) {
                entries.insert_or_assign(name, entryOf(value));
            }
            return entries;
        }
    } catch (const Json::exception&) {
        // The kind of error does not matter, because the file will be rewritten.
    }
    return invalidInput("it is not a cache file, or has an unsupported version");
}

std::string bakeCacheText(const BakeCacheEntries& entries) {
    Json outputs = Json::object();
    for (const auto& [name, entry] : entries) {
        Json inputs = Json::array();
        for (const InputFile& input : entry.inputs) {
            inputs.push_back({{"file", cleanUtf8(input.path)}, {"hash", input.hash}});
        }
        outputs[cleanUtf8(name)] = {{"tool", entry.tool},
                                    {"options", entry.options},
                                    {"inputs", std::move(inputs)},
                                    {"output_hash", entry.output_hash},
                                    {"output_bytes", entry.output_bytes}};
        if (!entry.containers.empty()) {
            outputs[cleanUtf8(name)]["containers"] = entry.containers;
        }
        if (entry.wrong_percent) {
            outputs[cleanUtf8(name)]["wrong_percent"] = *entry.wrong_percent;
        }
    }
    const Json json = {{"format", kFormat}, {"version", kCacheVersion}, {"outputs", std::move(outputs)}};
    return json.dump(1, ' ', false, Json::error_handler_t::replace) + "\n";
}

Result<std::optional<std::vector<std::byte>>> readCacheFile(const fs::path& path) {
    std::error_code error;
    const fs::file_status status = fs::symlink_status(path, error);
    if (!fs::exists(status)) {
        return std::nullopt;
    }
    // A link could lead out of the folder.
    if (!fs::is_regular_file(status)) {
        return invalidInput(quotedPath(path) + ": not a regular file");
    }
    return RELIEF_TRY(readFile(path, kCacheBytesMax));
}

Result<void> writeCacheFile(const fs::path& path, std::string_view text) {
    std::error_code error;
    if (fs::is_symlink(fs::symlink_status(path, error)) && !fs::remove(path, error)) {
        return fail(ErrorCode::kIo,
                    "cannot replace the link " + quotedPath(path) + ": " + error.message() + "; remove it");
    }
    return writeText(path, text);
}

Result<BakeCacheEntries> loadBakeCache(const fs::path& output_folder) {
    const fs::path path = output_folder / kBakeCacheName;
    const auto bytes = RELIEF_TRY(readCacheFile(path));
    return bytes ? withPrefix(quotedPath(path), parseBakeCache(textOf(*bytes))) : BakeCacheEntries{};
}

Result<void> updateBakeCache(const fs::path& output_folder, const BakeCacheEntries& entries) {
    const FolderLock lock(output_folder);
    // An unreadable cache is replaced.
    BakeCacheEntries all = loadBakeCache(output_folder).value_or(BakeCacheEntries{});
    for (const auto& [name, entry] : entries) {
        all.insert_or_assign(name, entry);
    }
    std::erase_if(all, [&](const auto& named) {
        std::error_code error;
        return !fs::exists(output_folder / named.first, error);
    });
    return writeCacheFile(output_folder / kBakeCacheName, bakeCacheText(all));
}

std::string assetKey(const std::string& tool, const std::vector<std::string>& options,
                     std::vector<InputFile> inputs) {
    std::ranges::sort(inputs, {}, &InputFile::path);
    // Prefix each part with its length, so that different lists have different texts.
    std::string text;
    const auto add = [&](const std::string& part) { text += std::to_string(part.size()) + ":" + part; };
    add(tool);
    add(std::to_string(options.size()));
    std::ranges::for_each(options, add);
    for (const InputFile& input : inputs) {
        add(input.path);
        add(input.hash);
    }
    return xxh3_128Hex(std::as_bytes(std::span(text)));
}

std::string pathFromRecipe(const fs::path& file, const fs::path& recipe_folder) {
    const fs::path inside = file.lexically_normal().lexically_relative(recipe_folder.lexically_normal());
    return inside.empty() ? file.string() : inside.string();
}

std::optional<std::string> staleness(const RecipeJob& job, const BakeCacheEntry* entry,
                                     const std::string& tool, const fs::path& recipe_folder) {
    std::error_code error;
    if (!fs::exists(job.output_path, error)) {
        return entry == nullptr ? "new" : "the output is missing";
    }
    if (entry == nullptr || entry->containers.empty() == job.world) {
        return "the output is not in the cache";
    }
    if (entry->tool != tool) {
        return "baked by another version of relief";
    }
    if (entry->options != job.options) {
        return "the options changed";
    }
    if (entry->inputs.front().path != job.mesh) {
        return "the mesh is a different file";
    }
    for (const InputFile& input : entry->inputs) {
        if (hashOfInput(recipe_folder / input.path) != input.hash) {
            return quotedPath(input.path) + " changed";
        }
    }
    if (hashOfFile(job.output_path) != entry->output_hash) {
        return "the output changed";
    }
    for (const auto& [file, hash] : entry->containers) {
        const fs::path path = job.output_path.parent_path() / file;
        if (hashOfFile(path) != hash) {
            return "its " + quotedPath(file) + (fs::exists(path, error) ? " changed" : " is missing");
        }
    }
    return std::nullopt;
}

}  // namespace relief

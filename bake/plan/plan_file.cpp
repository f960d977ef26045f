#include "bake/plan/plan_file.h"

#include <algorithm>
#include <array>
#include <exception>
#include <optional>

#include "formats/base/file_io.h"
#include "formats/base/text.h"
#include "formats/config/toml.h"
#include "formats/container.h"
#include "formats/container_limits.h"

namespace relief {
namespace {

namespace fs = std::filesystem;

constexpr std::uint64_t kPlanBytesMax = std::uint64_t{1} << 20;
constexpr std::int64_t kVersion = 1;
constexpr double kLengthMax = 1e15;
constexpr std::array<std::string_view, 6> kTopKeys = {"version", "quality",   "prefer",
                                                      "budget",  "thickness", "map"};

/// The choice that a node names; nullopt where it names none.
template <class Choice>
std::optional<Choice> wordIn(const toml::node& node) {
    const auto word = node.value_exact<std::string>();
    return word ? fromWord<Choice>(*word) : std::nullopt;
}

class Reader {
  public:
    explicit Reader(std::string file) : file_(std::move(file)) {}

    Result<PlanFile> read(std::string_view text) const {
        try {
            return readPlan(toml::parse(text, file_));
        } catch (const toml::parse_error& error) {
            return invalid(error.source().begin, "not TOML: " + cleanUtf8(error.description()));
        } catch (const std::exception& error) {
            return invalid({1, 1}, "cannot be read: " + cleanUtf8(error.what()));
        }
    }

  private:
    [[nodiscard]] tl::unexpected<Error> failAt(const toml::source_position& at, ErrorCode code,
                                               const std::string& message) const {
        return fail(code,
                    file_ + ":" + std::to_string(at.line) + ":" + std::to_string(at.column) + ": " + message);
    }
    [[nodiscard]] tl::unexpected<Error> invalid(const toml::source_position& at,
                                                const std::string& message) const {
        return failAt(at, ErrorCode::kInvalidInput, message);
    }
    /// An error of a MapSpecBuilder: wrong usage of an option is invalid input in a file.
    [[nodiscard]] tl::unexpected<Error> refused(const toml::source_position& at, const Error& error) const {
        return failAt(at, error.code == ErrorCode::kUsage ? ErrorCode::kInvalidInput : error.code,
                      error.message);
    }

    [[nodiscard]] Result<PlanFile> readPlan(const toml::table& root) const {
        const toml::node* version = root.get("version");
        if (version == nullptr) {
            return invalid({1, 1}, "a plan starts with version = 1");
        }
        if (version->value_exact<std::int64_t>() != kVersion) {
            return invalid(version->source().begin, "version must be 1, the only one that is known");
        }
        PlanFile plan;
        for (const toml::key* key : keysInOrder(root)) {
            const toml::node& node = *root.get(key->str());
            using Read = Result<void> (Reader::*)(const toml::node&, PlanFile&) const;
            constexpr std::array<Read, kTopKeys.size()> kReaders = {nullptr,
                                                                    &Reader::readQuality,
                                                                    &Reader::readPrefer,
                                                                    &Reader::readBudget,
                                                                    &Reader::readThickness,
                                                                    &Reader::readMaps};
            const auto* const found = std::ranges::find(kTopKeys, key->str());
            if (found == kTopKeys.end()) {
                const std::string guess = didYouMean(key->str(), kTopKeys);
                return invalid(key->source().begin,
                               "unknown key '" + cleanUtf8(key->str()) + "'" +
                                   (guess.empty() ? "; known are " + listed(kTopKeys) : guess));
            }
            if (const Read reader = kReaders.at(static_cast<std::size_t>(found - kTopKeys.begin()))) {
                RELIEF_TRY((this->*reader)(node, plan));
            }
        }
        if (plan.maps.empty()) {
            return invalid({1, 1}, "a plan needs at least one [[map]]");
        }
        return plan;
    }

    Result<void> readQuality(const toml::node& node, PlanFile& plan) const {
        const std::optional<Quality> word = wordIn<Quality>(node);
        if (!word) {
            return invalid(node.source().begin, "quality must be \"fast\", \"normal\" or \"best\"");
        }
        plan.quality = *word;
        return {};
    }

    Result<void> readPrefer(const toml::node& node, PlanFile& plan) const {
        const std::optional<Prefer> word = wordIn<Prefer>(node);
        if (!word) {
            return invalid(node.source().begin, "prefer must be \"neither\", \"inside\" or \"outside\"");
        }
        plan.prefer = *word;
        return {};
    }

    Result<void> readBudget(const toml::node& node, PlanFile& plan) const {
        const auto bytes = node.value_exact<std::int64_t>();
        if (!bytes || *bytes < 1) {
            return invalid(node.source().begin, "budget must be a whole number of bytes above 0");
        }
        plan.budget = static_cast<std::uint64_t>(*bytes);
        return {};
    }

    Result<void> readThickness(const toml::node& node, PlanFile& plan) const {
        const auto length = node.value<double>();
        if (!node.is_number() || !length || !(*length > 0.0 && *length <= kLengthMax)) {
            return invalid(node.source().begin, "thickness must be a length above 0 and at most 1e15");
        }
        plan.thickness = double{static_cast<float>(*length)};
        return {};
    }

    Result<void> readMaps(const toml::node& node, PlanFile& plan) const {
        const toml::array* maps = node.as_array();
        if (maps == nullptr) {
            return invalid(node.source().begin, "map must be a list of tables; write [[map]] before each");
        }
        const std::uint64_t maps_max = ContainerLimits{}.maps;
        if (maps->size() > maps_max) {
            return failAt(node.source().begin, ErrorCode::kLimit,
                          std::to_string(maps->size()) + " maps are more than the limit of " +
                              std::to_string(maps_max) + "; remove some");
        }
        for (const toml::node& map : *maps) {
            const toml::table* table = map.as_table();
            if (table == nullptr) {
                return invalid(map.source().begin, "a map must be a table; write [[map]] before each");
            }
            plan.maps.push_back({RELIEF_TRY(readMap(*table)), ""});
        }
        return {};
    }

    [[nodiscard]] Result<MapSpec> readMap(const toml::table& table) const {
        MapSpecBuilder builder;
        for (const char* needed : {"format", "size"}) {
            if (table.get(needed) == nullptr) {
                return invalid(table.source().begin, std::string("a map needs ") + needed);
            }
        }
        const toml::node& format = *table.get("format");
        const auto word = format.value_exact<std::string>();
        if (!word) {
            return invalid(format.source().begin, "format must be a string");
        }
        if (const Result<void> set = builder.setFormat(*word); !set) {
            return refused(format.source().begin, set.error());
        }
        for (const toml::key* key : keysInOrder(table)) {
            if (key->str() == "format") {
                continue;
            }
            if (!MapSpecBuilder::knows(key->str())) {
                // The builder has the message; the place is the key's, not the value's.
                return refused(key->source().begin, builder.set(key->str(), "").error());
            }
            const toml::node& node = *table.get(key->str());
            auto value = node.value_exact<std::string>();
            if (key->str() == "size" && node.is_integer()) {
                value = std::to_string(*node.value_exact<std::int64_t>());
            }
            if (!value) {
                return invalid(node.source().begin,
                               std::string(key->str()) + " must be a string, as after --map");
            }
            if (const Result<void> set = builder.set(key->str(), *value); !set) {
                return refused(node.source().begin, set.error());
            }
        }
        const Result<MapSpec> spec = builder.finish();
        if (!spec) {
            return refused(table.source().begin, spec.error());
        }
        return spec;
    }

    std::string file_;
};

}  // namespace

std::string planText(const PlanFile& plan) {
    std::string text =
        "# The maps of a bake, to be changed by hand: relief bake MESH -o OUT.relief --plan THIS_FILE\n"
        "version = " +
        std::to_string(kVersion) + "\nquality = \"" + std::string(wordOf(plan.quality)) + "\"\nprefer = \"" +
        std::string(wordOf(plan.prefer)) + "\"\n";
    text += plan.budget == 0 ? "" : "budget = " + std::to_string(plan.budget) + "\n";
    text += plan.thickness > 0.0 ? "thickness = " + shortest(static_cast<float>(plan.thickness)) + "\n" : "";
    for (const PlanFileMap& map : plan.maps) {
        text += "\n";
        if (!map.comment.empty()) {
            text += "# " + cleanUtf8(map.comment) + "\n";
        }
        const std::string spec = toString(map.spec);
        const std::size_t colon = spec.find(':');
        text += "[[map]]\nformat = \"" + spec.substr(0, colon) + "\"\n";
        for (const std::string_view pair : split(std::string_view(spec).substr(colon + 1), ',')) {
            const std::size_t equals = pair.find('=');
            text.append(pair.substr(0, equals)).append(" = \"").append(pair.substr(equals + 1)) += "\"\n";
        }
    }
    return text;
}

Result<PlanFile> parsePlan(std::string_view text, const fs::path& path) {
    // Without the quotes, as compilers write it.
    const std::string quoted = quotedPath(path);
    return Reader(path == "-" ? "standard input" : quoted.substr(1, quoted.size() - 2)).read(text);
}

Result<PlanFile> loadPlan(const fs::path& path) {
    const auto bytes = RELIEF_TRY(readFile(path, kPlanBytesMax));
    return parsePlan({reinterpret_cast<const char*>(bytes.data()), bytes.size()}, path);
}

}  // namespace relief

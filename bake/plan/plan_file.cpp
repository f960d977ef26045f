// SPDX-License-Identifier: Apache-2.0
#include "bake/plan/plan_file.h"

#include "formats/base/file_io.h"
#include "formats/base/text.h"
#include "formats/config/toml_reader.h"
#include "formats/container_limits.h"

namespace relief {
namespace {

namespace fs = std::filesystem;

constexpr std::uint64_t kPlanBytesMax = std::uint64_t{1} << 20;
constexpr int kVersion = 1;

struct PlanMaps {
    std::vector<PlanFileMap>& maps;
    ErrorCode& code;  // of a mistake in one
};

/// The message of a builder, with the place in the file. Wrong usage of an option is invalid input in a file.
[[noreturn]] void refuse(const Error& error, const TomlFile& file, const toml::source_position& at,
                         ErrorCode& code) {
    code = error.code == ErrorCode::kLimit ? ErrorCode::kLimit : ErrorCode::kInvalidInput;
    throw TomlMistake{file.name + ":" + std::to_string(at.line) + ":" + std::to_string(at.column) + ": " +
                      error.message};
}

MapSpec readSpec(const TomlValue& map, ErrorCode& code) {
    MapSpecBuilder builder;
    const auto need_key = [&](const char* key) {
        if (!map.find(key)) {
            map.fail(std::string("a map needs ") + key);
        }
    };
    need_key("format");
    const auto need = [&](const Result<void>& set, const toml::source_region& at) {
        if (!set) {
            refuse(set.error(), map.file(), at.begin, code);
        }
    };
    const TomlValue format = *map.find("format");
    need(builder.setFormat(format.text()), format.node().source());
    if (format.text() != mapFormatName(MapFormat::kPatches)) {
        need_key("size");
    } else if (!map.find("texel")) {
        need_key("bytes");
    }
    for (const toml::key* key : keysInOrder(*map.node().as_table())) {
        if (!MapSpecBuilder::knows(key->str()) && key->str() != "format") {
            need(builder.set(key->str(), ""), key->source());
        }
        const TomlValue value = *map.find(key->str());
        if (key->str() != "format") {
            const auto number = value.node().value_exact<std::int64_t>();
            const bool whole = (key->str() == "size" || key->str() == "bytes") && number;
            need(builder.set(key->str(), whole ? std::to_string(*number) : value.text()),
                 value.node().source());
        }
    }
    const Result<MapSpec> spec = builder.finish();
    if (!spec) {
        refuse(spec.error(), map.file(), map.node().source().begin, code);
    }
    return *spec;
}

void readMaps(const TomlValue& from, void* value, const FieldInfo& info) {
    const PlanMaps& into = *static_cast<const PlanMaps*>(value);
    if (from.array() != nullptr && from.array()->size() > info.rules.most) {
        into.code = ErrorCode::kLimit;
    }
    for (const TomlValue& map : from.tables(info)) {
        into.maps.push_back({readSpec(map, into.code), ""});
    }
    if (into.maps.empty()) {
        from.fail("a plan needs at least one [[map]]");
    }
}

const FieldCustom kPlanMapsField{.read = readMaps};

}  // namespace

template <>
inline constexpr const FieldCustom* kFieldCustom<PlanMaps> = &kPlanMapsField;

namespace {

struct PlanTop {
    int version = kVersion;
    PlanFile plan;
    ErrorCode code = ErrorCode::kInvalidInput;
};

void fields(FieldVisitor& visit, PlanTop& top) {
    visit("version", top.version, {"Version of the format, 1", {}, {kVersion, kVersion}, {}, kRequired});
    visit("quality", top.plan.quality, {"Work on the texels of planes"});
    visit("prefer", top.plan.prefer, {"The worse of two errors"});
    visit("budget", top.plan.budget, {"Bytes on the GPU that the maps were planned for", {}, kFromOne});
    visit("thickness", top.plan.thickness, {"Default of shells", {}, {0.0, 1e15, false}});
    visit("map", PlanMaps{top.plan.maps, top.code},
          {"A map of the bake",
           {},
           {},
           {},
           {.most = static_cast<std::size_t>(ContainerLimits{}.maps), .required = true}});
}

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
    PlanTop top;
    const std::string name = path == "-" ? "standard input" : oneLine(path.native());
    const Result<void> done = readTomlFile(text, {name, path.parent_path(), {}, "plan"},
                                           [&](const TomlValue& from) { readToml(from, top); });
    if (!done) {
        return fail(top.code, done.error().message);
    }
    top.plan.thickness = double{static_cast<float>(top.plan.thickness)};
    return std::move(top.plan);
}

Result<PlanFile> loadPlan(const fs::path& path) {
    const auto bytes = RELIEF_TRY(readFile(path, kPlanBytesMax));
    return parsePlan({reinterpret_cast<const char*>(bytes.data()), bytes.size()}, path);
}

}  // namespace relief

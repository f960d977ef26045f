// SPDX-License-Identifier: Apache-2.0
#include "bake/cli/command.h"

#include <spdlog/spdlog.h>

#include <CLI/CLI.hpp>
#include <filesystem>

#include "bake/verdict/report_text.h"
#include "formats/base/file_io.h"
#include "formats/base/result.h"
#include "formats/base/text.h"
#include "formats/container.h"
#include "formats/container_reader.h"
#include "runtime/command_line/command_line.h"

namespace relief {

CLI::App& addVerb(CLI::App& app, CommonOptions& common, const std::string& name,
                  const std::string& description, const std::string& example) {
    CLI::App* verb = app.add_subcommand(name, description);
    verb->footer(example);
    setUpVerbHelp(*verb);
    CLI::Option* quiet = verb->add_flag("-q,--quiet", common.quiet, "Print only errors");
    CLI::Option* verbose =
        verb->add_flag("-v,--verbose", common.verbose, "Also print details")->excludes(quiet);
    verb->add_flag_callback(
            "--warnings-only",
            [&common] {
                common.quiet = true;
                common.warnings = true;
            },
            "Print only warnings and errors")
        ->excludes(quiet)
        ->excludes(verbose);
    verb->parse_complete_callback([&common] {
        spdlog::set_level(common.warnings  ? spdlog::level::warn
                          : common.quiet   ? spdlog::level::err
                          : common.verbose ? spdlog::level::debug
                                           : spdlog::level::info);
    });
    return *verb;
}

Result<void> forEachFile(const std::vector<std::string>& files,
                         const std::function<Result<void>(const std::string& file)>& each) {
    std::size_t failures = 0;
    Error first{};
    for (const std::string& file : files) {
        Result<void> done = each(file);
        if (done) {
            continue;
        }
        if (files.size() == 1) {
            return done;
        }
        reportError(done.error());
        if (failures++ == 0) {
            first = {done.error().code, ", first " + inputText(file) + "; see the errors above"};
        }
    }
    if (failures == 0) {
        return {};
    }
    return fail(first.code, std::to_string(failures) + " of " + countText(files.size(), "file") + " failed" +
                                first.message);
}

void setAction(CLI::App& verb, Action& action, Action run) {
    onVerb(verb, [&action, run = std::move(run)] { action = run; });
}

void logWarnings(const std::vector<std::string>& warnings) {
    for (const std::string& warning : warnings) {
        spdlog::warn(warning);
    }
}

std::string inputText(const std::string& file) {
    return file == "-" ? "standard input" : quotedPath(file);
}

bool isWorldFile(const std::string& file) {
    return lowerCase(std::filesystem::path(file).extension().string()) == ".json";
}

std::string inputName(const std::string& file) {
    return file == "-" ? "standard input" : cleanUtf8(std::filesystem::path(file).filename().string());
}

void defineRelief(CLI::App& app, Action& action) {
    setUpHelp(app, "Print this help and exit; `relief VERB --help` describes a verb");
    app.description(
        "Bake meshes into depth-map colliders, and inspect them\n\n"
        "A collider is a small file of depth maps that stores the outer shape of a mesh. Programs and "
        "shaders look up the signed distance and normal of the surface near a point, so that particles can "
        "collide with the mesh on the GPU.\n"
        "After baking, `relief check` measures the collider against its mesh and suggests fixes, and `relief "
        "slice` and `relief view` show it. `relief-sim` collides particles with it. To use it in your "
        "engine, link the runtime library, or upload the files of `relief export --engine`.");
    app.footer(
        "relief bake bunny.obj -o bunny.relief\n"
        "relief check bunny.relief --mesh bunny.obj\n"
        "relief view bunny.relief --mesh bunny.obj -o bunny.html");
    app.require_subcommand(1);
    for (const auto& add : {addBake, addCheck, addInfo, addQuery, addSlice, addView, addExport}) {
        add(app, action);
    }
}

Result<void> runRelief(int argc, char** argv) {
    CLI::App app("", "relief");
    Action action;
    defineRelief(app, action);
    FileGuard files;
    if (!RELIEF_TRY(parseCommandLine(app, argumentsOf(argc, argv)))) {
        return {};
    }
    RELIEF_TRY(action(files));
    files.keepFolders();
    return {};
}

Result<ColliderFile> readColliderFile(const std::string& file, const ContainerLimits& limits) {
    std::vector<std::byte> bytes = RELIEF_TRY(readFile(file, containerSizeMax(limits)));
    RELIEF_TRY(rejectMesh(file, bytes));
    Collider collider = RELIEF_TRY(withPrefix(inputText(file), readContainer(bytes, limits)));
    return ColliderFile{std::move(bytes), std::move(collider)};
}

}  // namespace relief

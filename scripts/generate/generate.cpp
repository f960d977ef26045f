// SPDX-License-Identifier: Apache-2.0
// relief-generate ROOT [--check]: writes the files and sections derived from fields(); --check names the stale ones.
// relief-generate --schemas FOLDER: writes the JSON Schemas.
// relief-generate --dictionaries FOLDER: writes the dictionaries for the fuzz targets.
#include <cstdio>
#include <filesystem>
#include <string>

#include "bake/cli/command.h"
#include "formats/base/file_io.h"
#include "formats/base/text.h"
#include "formats/fields/generated.h"
#include "runtime/player/report.h"
#include "runtime/scene/scene_reference.h"

namespace relief {
namespace {

namespace fs = std::filesystem;

Result<std::string> readText(const fs::path& path) {
    const std::vector<std::byte> bytes = RELIEF_TRY(readFile(path));
    return std::string(textOf(bytes));
}

/// All derived texts. Each library that declares fields has its own function.
GeneratedTexts all() {
    GeneratedTexts texts;
    for (GeneratedTexts (*const of)() : {bakeTexts, playerSchemas, sceneReference}) {
        for (GeneratedText& text : of()) {
            texts.push_back(std::move(text));
        }
    }
    return texts;
}

/// Replaces the lines between the two markers of a section.
Result<std::string> withPart(const GeneratedText& generated, const std::string& file) {
    const std::size_t head = file.find("generated: " + generated.part + " ");
    const std::size_t foot = file.find("end of " + generated.part + " ");
    if (head == std::string::npos || foot == std::string::npos || foot < head) {
        return fail(ErrorCode::kInvalidInput, generated.path + " lacks the markers 'generated: " +
                                                  generated.part + "' and 'end of " + generated.part + "'");
    }
    const std::size_t begin = file.find('\n', head) + 1;
    const std::size_t end = file.rfind('\n', foot) + 1;
    return file.substr(0, begin) + generated.text + file.substr(end);
}

/// Writes the texts that the build generates with this extension.
Result<int> writeBuilt(const fs::path& folder, std::string_view extension) {
    fs::create_directories(folder);
    for (const GeneratedText& generated : all()) {
        if (generated.built && generated.path.ends_with(extension)) {
            RELIEF_TRY(writeText(folder / generated.path, generated.text));
        }
    }
    return 0;
}

Result<int> generate(const fs::path& root, bool check) {
    int stale = 0;
    for (const GeneratedText& generated : all()) {
        if (generated.built) {
            continue;
        }
        const fs::path path = root / generated.path;
        const std::string old = fs::exists(path) ? RELIEF_TRY(readText(path)) : std::string();
        const std::string text =
            generated.part.empty() ? generated.text : RELIEF_TRY(withPart(generated, old));
        if (text == old) {
            continue;
        }
        ++stale;
        if (check) {
            std::fprintf(stderr, "%s is stale; run scripts/generate.sh\n", generated.path.c_str());
        } else {
            RELIEF_TRY(writeText(path, text));
            std::printf("%s\n", generated.path.c_str());
        }
    }
    return stale;
}

}  // namespace
}  // namespace relief

int main(int argc, char** argv) {
    const bool check = argc == 3 && std::string_view(argv[2]) == "--check";
    const bool schemas = argc == 3 && std::string_view(argv[1]) == "--schemas";
    const bool dictionaries = argc == 3 && std::string_view(argv[1]) == "--dictionaries";
    if (argc != 2 && !check && !schemas && !dictionaries) {
        std::fputs(
            "usage: relief-generate ROOT [--check]\n"
            "       relief-generate --schemas|--dictionaries FOLDER\n",
            stderr);
        return 1;
    }
    const relief::Result<int> stale = schemas        ? relief::writeBuilt(argv[2], ".json")
                                      : dictionaries ? relief::writeBuilt(argv[2], ".dict")
                                                     : relief::generate(argv[1], check);
    if (!stale) {
        std::fprintf(stderr, "relief-generate: %s\n", stale.error().message.c_str());
        return 4;
    }
    return check && *stale > 0 ? 7 : 0;
}

// SPDX-License-Identifier: Apache-2.0
// Writes the colliders and queries of engine_cases.h for programs in other languages, and compares their answers:
//
//     relief_engine_cases write FOLDER [QUERIES [FILE.relief]]   0.case, 1.case, …
//     relief_engine_cases fused|compare|precise|exact FOLDER NAME [QUERIES [FILE.relief]]   0.NAME, …
//
// The last form fails if an answer differs by more than the Match permits: kFused, kRounded, kCells or kBits.
// FILE.relief adds a baked collider. A case is little-endian: u32 height, u32 queries; 80 bytes of constants;
// 2048 · height texels of 8 bytes; queries of 12 floats. Answers have 16 floats each. engine_cases.h names them.
#include <algorithm>
#include <array>
#include <cstdlib>
#include <cstring>
#include <filesystem>
#include <fstream>
#include <iostream>
#include <string>
#include <vector>

#include "formats/base/file_io.h"
#include "formats/container.h"
#include "tests/engines/engine_cases.h"

namespace {

using namespace relief;
using namespace relief::engines;

int fail(const std::string& text) {
    std::cerr << "relief_engine_cases: " << text << '\n';
    return 1;
}

bool write(const std::filesystem::path& path, const Case& one) {
    std::ofstream file(path, std::ios::binary);
    const auto put = [&](const void* from, std::size_t bytes) {
        file.write(static_cast<const char*>(from), static_cast<std::streamsize>(bytes));
    };
    const std::uint32_t head[] = {one.height(), static_cast<std::uint32_t>(one.queries.size())};
    put(head, sizeof(head));
    put(&one.constants, sizeof(one.constants));
    put(one.texels.data(), one.texels.size() * sizeof(one.texels[0]));
    put(one.queries.data(), one.queries.size() * sizeof(Query));
    return static_cast<bool>(file.flush());
}

}  // namespace

int main(int argc, char** argv) {
    const std::vector<std::string> words(argv + 1, argv + argc);
    const bool writes = !words.empty() && words[0] == "write";
    const std::string verb = words.empty() ? "" : words[0];
    // In the order of Match.
    constexpr std::array<const char*, 4> kVerbs{"fused", "compare", "precise", "exact"};
    const auto* const match = std::find(kVerbs.begin(), kVerbs.end(), verb);
    const std::size_t own = writes ? 2 : 3;  // words before the options
    if (words.size() < own || words.size() > own + 2 || (!writes && match == kVerbs.end())) {
        return fail(
            "usage: relief_engine_cases write FOLDER | fused|compare|precise|exact FOLDER NAME, then "
            "[QUERIES [FILE.relief]]");
    }
    const std::size_t count =
        words.size() > own ? std::strtoul(words[own].c_str(), nullptr, 10) : std::size_t{100'000};
    std::vector<Case> cases = makeCases(count);
    if (words.size() == own + 2) {
        Result<Collider> collider = loadCollider(words[own + 1]);
        if (!collider) {
            return fail(collider.error().message);
        }
        if (collider->maps.size() != 1 || collider->maps[0].format != MapFormat::kPatches) {
            return fail(words[own + 1] + ": is not one map of patches; bake it without --map and --paper");
        }
        cases.push_back(makeCase(words[own + 1], std::move(*collider), count, 7));
    }
    const auto allowed = static_cast<Match>(match - kVerbs.begin());
    bool equal = true;
    for (std::size_t i = 0; i < cases.size(); ++i) {
        const std::filesystem::path stem = std::filesystem::path(words[1]) / std::to_string(i);
        if (writes) {
            if (!write(stem.string() + ".case", cases[i])) {
                return fail(stem.string() + ".case: cannot be written");
            }
            continue;
        }
        const std::string path = stem.string() + "." + words[2];
        const auto bytes = readFile(path);
        if (!bytes) {
            return fail(bytes.error().message);
        }
        std::vector<Answer> answers(count);
        if (bytes->size() != count * sizeof(Answer)) {
            return fail(path + ": does not contain " + std::to_string(count) + " answers");
        }
        std::memcpy(answers.data(), bytes->data(), bytes->size());
        const Difference difference = compare(cases[i], answers);
        equal = equal && difference.isWithinBounds(allowed);
        std::cout << words[2] << ", " << cases[i].name << ": " << difference.text()
                  << (difference.isWithinBounds(allowed) ? "" : " - NOT EQUAL") << '\n';
    }
    return equal ? 0 : 7;
}

// SPDX-License-Identifier: Apache-2.0
// Splits the options of a level into those of its meshes.
#include <array>
#include <utility>

#include "bake/world/world_bake.h"

namespace relief {

Result<void> checkWorldRequest(const BakeRequest& request) {
    const std::array<std::pair<const char*, bool>, 8> single_mesh_options = {{
        {"--map", !request.map.empty()},
        {"--paper", request.paper},
        {"--resolution", request.resolution.has_value()},
        {"--decode", request.decode.has_value()},
        {"--depth", request.depth.has_value()},
        {"--max-error", request.max_error.has_value()},
        {"--animated", request.animated},
        {"--holes keep", request.holes == Holes::kKeep},
    }};
    for (const auto& [option, given] : single_mesh_options) {
        if (given) {
            return fail(ErrorCode::kUsage,
                        std::string(option) + " applies to a single mesh, not to a level; remove it");
        }
    }
    static_cast<void>(RELIEF_TRY(settingsOf(request)));
    return {};
}

BakeRequest requestOf(const BakeRequest& request, const std::vector<std::string>& names, TriangleMesh& mesh) {
    std::vector<std::uint8_t> number(names.size() + 1, 0);
    for (const std::uint8_t mark : mesh.marks) {
        number[mark] = 1;
    }
    BakeRequest own = request;
    own.mesh.clear();
    own.as.clear();
    std::size_t named = 0;
    std::uint8_t next = 0;
    for (const std::string& word : request.as) {
        const bool has_name = word.find('=') != std::string::npos;
        named += has_name ? 1 : 0;
        if (!has_name || number[named] != 0) {
            own.as.push_back(word);
        }
        if (has_name && number[named] != 0) {
            number[named] = ++next;
        }
    }
    number[0] = 0;
    for (std::uint8_t& mark : mesh.marks) {
        mark = number[mark];
    }
    if (next == 0) {
        mesh.marks.clear();
    }
    return own;
}

}  // namespace relief

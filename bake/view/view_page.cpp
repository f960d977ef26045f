#include "bake/view/view_page.h"

#include <algorithm>
#include <bit>
#include <cstdint>
#include <nlohmann/json.hpp>

#include "bake/report/report_text.h"
#include "formats/fields/json.h"

namespace relief {
namespace {

using Json = nlohmann::ordered_json;

constexpr std::string_view kPlaceBegin = R"(<script type="application/json" id="relief-page-data">)";
constexpr std::string_view kPlaceEmpty = "null";
constexpr std::string_view kPlaceEnd = "</script>";

// Vertices and corners go as they lie in memory.
static_assert(std::endian::native == std::endian::little);
static_assert(sizeof(glm::vec3) == 12 && sizeof(glm::uvec3) == 12);

/// RFC 4648, with padding and without line ends.
std::string base64(std::span<const std::byte> bytes) {
    constexpr const char* kDigits = "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";
    std::string text;
    text.reserve((bytes.size() + 2) / 3 * 4);
    for (std::size_t i = 0; i < bytes.size(); i += 3) {
        const std::size_t count = std::min<std::size_t>(3, bytes.size() - i);
        std::uint32_t group = 0;
        for (std::size_t j = 0; j < 3; ++j) {
            group = group << 8 | (j < count ? std::to_integer<std::uint32_t>(bytes[i + j]) : 0U);
        }
        for (std::size_t j = 0; j < 4; ++j) {
            text += j <= count ? kDigits[group >> (18 - 6 * j) & 63U] : '=';
        }
    }
    return text;
}

std::uint64_t meshBytes(const TriangleMesh& mesh) {
    return std::uint64_t{12} * (mesh.positions.size() + mesh.triangles.size());
}

Result<void> checkSize(const ViewPageInput& input) {
    std::uint64_t rest = input.container.size() + (input.scene ? input.scene->size() : 0);
    for (const auto& [name, bytes] : input.files) {
        rest += bytes.size();
    }
    const std::uint64_t mesh = input.mesh != nullptr ? meshBytes(*input.mesh) : 0;
    if (rest + mesh <= kViewBytesMax) {
        return {};
    }
    const std::string limit = "; a page holds " + bytesText(kViewBytesMax);
    if (rest <= kViewBytesMax) {
        return fail(ErrorCode::kLimit,
                    input.mesh->name + " has " + std::to_string(input.mesh->triangles.size()) +
                        " triangles, " + bytesText(mesh) + limit +
                        "; leave out the page or the mesh, or give it with fewer triangles");
    }
    return fail(ErrorCode::kLimit, input.name + " has " + bytesText(rest) + limit +
                                       "; bake with a smaller --budget, or smaller maps");
}

Json jsonMesh(const TriangleMesh& mesh) {
    return {{"name", mesh.name},
            {"vertices", base64(std::as_bytes(std::span(mesh.positions)))},
            {"triangles", base64(std::as_bytes(std::span(mesh.triangles)))}};
}

Json jsonFiles(const ViewPageInput& input) {
    Json files = Json::object();
    for (const auto& [name, bytes] : input.files) {
        files[name] = base64(bytes);
    }
    return files;
}

/// Ready to stand between <script> and </script>: whatever a name says, it ends nothing there.
std::string scriptText(const Json& json) {
    const std::string text = json.dump(-1, ' ', false, Json::error_handler_t::replace);
    std::string safe;
    safe.reserve(text.size());
    for (const char c : text) {
        if (c == '<') {
            safe += "\\u003c";
        } else {
            safe += c;
        }
    }
    return safe;
}

}  // namespace

Result<std::string> viewPage(std::string_view page, const std::string& page_name,
                             const ViewPageInput& input) {
    const std::string place = std::string(kPlaceBegin).append(kPlaceEmpty).append(kPlaceEnd);
    const std::size_t at = page.find(place);
    if (at == std::string_view::npos || page.find(place, at + 1) != std::string_view::npos) {
        return invalidInput(page_name + " is no page for `relief view`: its place for data, " + place +
                            ", is not there once; make it anew with scripts/build.sh web");
    }
    RELIEF_TRY(checkSize(input));
    const Json json = {
        {"format", 2},
        {"name", input.name},
        {"collider", input.shows.empty() ? Json(base64(input.container)) : Json(nullptr)},
        {"shows", input.shows.empty() ? Json(nullptr) : Json(input.shows)},
        {"mesh", input.mesh != nullptr ? jsonMesh(*input.mesh) : Json(nullptr)},
        {"check", input.check != nullptr ? *input.check : Json(nullptr)},
        {"scene", input.scene ? Json(*input.scene) : Json(nullptr)},
        {"files", input.scene ? jsonFiles(input) : Json(nullptr)},
        {"serve", input.events.empty() ? Json(nullptr) : Json(input.events)},
    };
    const std::size_t data = at + kPlaceBegin.size();
    std::string text(page.substr(0, data));
    text += scriptText(json);
    return text.append(page.substr(data + kPlaceEmpty.size()));
}

}  // namespace relief

// SPDX-License-Identifier: Apache-2.0
#include "runtime/page/page.h"

#include <algorithm>
#include <bit>
#include <cstdlib>

#include "formats/base/file_io.h"
#include "formats/base/text.h"
#include "formats/world/collider_info.h"
#include "runtime/layout/gpu_image.h"
#include "shaders/shader_text.h"

namespace relief {
namespace {

namespace fs = std::filesystem;

Result<fs::path> findPlayer() {
    if (const char* named = std::getenv("RELIEF_VIEW_PAGE"); named != nullptr && *named != '\0') {
        return fs::path(named);
    }
    std::error_code error;
    const fs::path folder = fs::read_symlink("/proc/self/exe", error).parent_path();
    for (const char* place : {"../share/relief/view.html", "../../web/bin/view.html"}) {
        const fs::path page = folder / place;
        if (fs::is_regular_file(page, error)) {
            return page;
        }
    }
    return fail(ErrorCode::kUnsupported,
                "the browser player for pages of scenes and worlds is missing; build it with "
                "scripts/build.sh web, or set RELIEF_VIEW_PAGE to its file");
}

/// The place for data in a page, and the format of the data, which depends on the release.
struct DataPlace {
    std::string text;
    std::uint64_t format;
};

const DataPlace& dataPlace() {
    static const DataPlace place = [] {
        const std::string page = viewPage();
        const auto between = [&](std::string_view first, std::string_view last) {
            const std::size_t at = page.find(first);
            return page.substr(at, page.find(last, at + first.size()) - at);
        };
        constexpr std::string_view kFormat = "data-format=\"";
        return DataPlace{between("<script type=\"application/json\"", "\n"),
                         parseUnsigned(between(kFormat, "\"").substr(kFormat.size())).value()};
    }();
    return place;
}
constexpr std::string_view kEmpty = "null";

// Vertices and corners are copied from memory.
static_assert(std::endian::native == std::endian::little);
static_assert(sizeof(glm::vec3) == 12 && sizeof(glm::uvec3) == 12);

/// Serialises JSON for a <script> element; no string can end the element.
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

/// Maximum data of a page in bytes, before encoding; browsers fail to load larger pages.
constexpr std::uint64_t kViewBytesMax = std::uint64_t{128} << 20;

/// Returns a collider for a page: its block, textures and GLSL (gpu_image.h), and facts.
Result<Json> colliderJson(const Collider& collider) {
    const GpuImage image = RELIEF_TRY(gpuImage(collider));
    const std::string core = RELIEF_TRY(shaderText("collider/collider.glsl"));
    Json textures = Json::array();
    for (const TexelKind kind : {kFloatTexels, kFixedTexels, kFrontBackTexels}) {
        const GpuTexture& texture = image.textures[kind];
        textures.push_back(
            {{"width", texture.width},
             {"height", texture.height},
             {"texels", isUsed(collider, kind) ? Json(base64(texture.texels)) : Json(nullptr)}});
    }
    return Json{{"info", colliderInfo(collider)},
                {"animated", !collider.animation.empty()},
                {"glsl", std::string(kShaderLicence) + image.defines + core},
                {"block", base64(image.block)},
                {"textures", textures}};
}

std::string megabytes(std::uint64_t bytes) {
    return std::to_string(bytes / 1'000'000) + " MB";
}

Result<void> checkSize(const Page& page) {
    std::uint64_t rest = page.container.size() + (page.scene ? page.scene->size() : 0) +
                         (page.collider != nullptr ? page.collider->texelBytes() : 0);
    for (const auto& [name_in_scene, file] : page.files) {
        rest += file.size();
    }
    const std::uint64_t mesh_bytes =
        page.mesh ? page.mesh->vertices.size_bytes() + page.mesh->triangles.size_bytes() : 0;
    if (rest + mesh_bytes <= kViewBytesMax) {
        return {};
    }
    const std::string limit = "; the maximum of a page is " + megabytes(kViewBytesMax);
    if (rest <= kViewBytesMax) {
        return fail(ErrorCode::kLimit,
                    page.mesh->name + " has " + std::to_string(page.mesh->triangles.size()) + " triangles, " +
                        megabytes(mesh_bytes) + limit + "; simplify the mesh, or omit the page or the mesh");
    }
    return fail(ErrorCode::kLimit, page.name + " has " + megabytes(rest) + limit +
                                       "; bake with a smaller --budget, or smaller maps");
}

Result<Json> dataOf(const Page& page) {
    Json shown = nullptr;
    if (page.collider != nullptr) {
        shown = RELIEF_TRY(withPrefix(page.name, colliderJson(*page.collider)));
    } else if (page.shows.empty()) {
        shown = base64(page.container);
    }
    Json all = {{"format", dataPlace().format},
                {"name", page.name},
                {"bytes", page.bytes},
                {"collider", shown},
                {"shows", page.shows.empty() ? Json(nullptr) : Json(page.shows)},
                {"mesh", nullptr},
                {"check", page.check},
                {"scene", page.scene ? Json(*page.scene) : Json(nullptr)},
                {"files", page.scene ? Json::object() : Json(nullptr)}};
    if (page.mesh) {
        all["mesh"] = {{"name", page.mesh->name},
                       {"vertices", base64(std::as_bytes(page.mesh->vertices))},
                       {"triangles", base64(std::as_bytes(page.mesh->triangles))}};
    }
    for (const auto& [name_in_scene, file] : page.files) {
        all["files"][name_in_scene] = base64(std::as_bytes(std::span(file)));
    }
    return all;
}

}  // namespace

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

Result<std::string> readForPage(FileGuard& files, const fs::path& path) {
    RELIEF_TRY(files.reads(path));
    const std::vector<std::byte> bytes = RELIEF_TRY(readFile(path, kViewBytesMax));
    return std::string(reinterpret_cast<const char*>(bytes.data()), bytes.size());
}

Result<std::string> playerPage(FileGuard& files) {
    const fs::path file = RELIEF_TRY(findPlayer());
    std::string text = RELIEF_TRY(readForPage(files, file));
    const std::string& place = dataPlace().text;
    const std::size_t at = text.find(place);
    if (at == std::string::npos || text.find(place, at + 1) != std::string::npos) {
        return invalidInput(quotedPath(file) +
                            " is a page of another release; run scripts/build.sh web again");
    }
    return text;
}

std::string relativeName(const fs::path& file, const fs::path& scene) {
    return file.lexically_normal().lexically_relative(scene.parent_path().lexically_normal());
}

Result<std::string> Page::make(const std::string& html) const {
    RELIEF_TRY(checkSize(*this));
    const std::string& place = dataPlace().text;
    const std::size_t data = html.find(place) + place.find(kEmpty);
    return html.substr(0, data) + scriptText(RELIEF_TRY(dataOf(*this))) + html.substr(data + kEmpty.size());
}

}  // namespace relief

// The page of `relief view`: a template of runtime/web, and what it is to show put in as JSON.
#pragma once

#include <cstddef>
#include <map>
#include <nlohmann/json_fwd.hpp>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "bake/mesh/mesh.h"
#include "formats/base/result.h"

namespace relief {

/// Bytes of everything that one page holds, before they become text: more, and browsers give up.
inline constexpr std::uint64_t kViewBytesMax = std::uint64_t{128} << 20;

struct ViewPageInput {
    std::string name;                               ///< of what is shown, without its folder
    std::span<const std::byte> container;           ///< what is shown; empty: `shows`
    std::string shows;                              ///< which of `files` is shown; empty: `container`
    const TriangleMesh* mesh = nullptr;             ///< null: none
    const nlohmann::ordered_json* check = nullptr;  ///< the report of `relief check`; null: none
    std::optional<std::string> scene;               ///< text of a scene.toml
    std::map<std::string, std::vector<std::byte>>
        files;           ///< that the scene names, by the names it has for them
    std::string events;  ///< address of the server's events; empty: no server
};

/// HTML. The same input gives the same bytes.
/// \param page  HTML with one place for data: `<script type="application/json" id="relief-page-data">null</script>`.
/// \param page_name  for messages.
/// Errors: kInvalidInput (no such place in the page, or several), kLimit (kViewBytesMax).
[[nodiscard]] Result<std::string> viewPage(std::string_view page, const std::string& page_name,
                                           const ViewPageInput& input);

}  // namespace relief

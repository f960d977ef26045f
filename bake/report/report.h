// What `bake` and `info` say of a collider: the same JSON, and the same tables for people.
#pragma once

#include <nlohmann/json_fwd.hpp>
#include <string>

#include "formats/collider.h"
#include "formats/container.h"

namespace relief {

[[nodiscard]] nlohmann::ordered_json jsonBounds(const Bounds& bounds);

/// Format, projection, compare, size, bytes, transform and flags.
/// \param payload  how it lies in the file.
[[nodiscard]] nlohmann::ordered_json jsonMap(const DepthMap& map, std::size_t index,
                                             const PayloadInfo& payload);

/// version, file_size, bounds, unit, texel_bytes, maps, provenance.
[[nodiscard]] nlohmann::ordered_json jsonCollider(const Collider& collider, const ContainerInfo& info);
/// The same as text.
[[nodiscard]] std::string colliderJson(const Collider& collider, const ContainerInfo& info);

/// "12.3 MB", "640 B": powers of 1000.
[[nodiscard]] std::string bytesText(std::uint64_t bytes);

/// The options of a bake one by one: "--map cube:size=16", "--quality normal".
[[nodiscard]] std::vector<std::string> optionList(const std::string& options);

/// Lines of a table for people, columns aligned, the first row a heading. Text columns go left, columns whose
/// heading ends in '>' right (the mark is not printed).
[[nodiscard]] std::string table(const std::vector<std::vector<std::string>>& rows);

}  // namespace relief

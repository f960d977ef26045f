// Triangles that a glTF file holds compressed by Draco (KHR_draco_mesh_compression).
#pragma once

#include <cstddef>
#include <cstdint>
#include <glm/vec3.hpp>
#include <optional>
#include <span>
#include <vector>

namespace relief {

struct DracoMesh {
    std::vector<glm::vec3> positions;   ///< may be no numbers
    std::vector<glm::uvec3> triangles;  ///< of positions that exist
};

/// \param attribute  Draco's number for the positions. \param triangles_max  more is an error, and so are thrice as many
/// positions.
/// \return nullopt if these bytes hold nothing like that.
[[nodiscard]] std::optional<DracoMesh> readDraco(std::span<const std::byte> bytes, std::uint64_t attribute,
                                                 std::uint64_t triangles_max);

}  // namespace relief

// Another poser of glTF, straight from the document and as short as the specification allows, in double precision: what the
// import of animated meshes is compared with.
#pragma once

#include <cstddef>
#include <filesystem>
#include <glm/vec3.hpp>
#include <nlohmann/json.hpp>
#include <optional>
#include <string>
#include <vector>

namespace relief::test {

/// For valid files of nodes, meshes of triangles, skins of one set of joints, morph targets and animations.
class GltfPoser {
  public:
    explicit GltfPoser(const std::filesystem::path& path);

    [[nodiscard]] std::size_t animations() const;
    [[nodiscard]] double seconds(std::size_t animation) const;
    /// The corners of all triangles, in the order in which the scene shows them.
    /// \param animation  nullopt: the rest pose.
    [[nodiscard]] std::vector<glm::dvec3> corners(std::optional<std::size_t> animation, double seconds) const;

  private:
    [[nodiscard]] std::vector<double> accessor(std::size_t index) const;

    nlohmann::json document_;
    std::vector<std::string> buffers_;
};

}  // namespace relief::test

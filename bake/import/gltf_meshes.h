// The surfaces of a glTF file's meshes, each as it is modelled. Errors name a place in the document, and no file.
#pragma once

#include <cstdint>
#include <glm/vec3.hpp>
#include <map>
#include <optional>
#include <string>
#include <tuple>
#include <vector>

#include "bake/import/gltf_buffers.h"
#include "bake/import/gltf_json.h"
#include "bake/import/gltf_skin.h"
#include "bake/import/import_parts.h"
#include "formats/base/result.h"

namespace relief {

/// The triangles of a primitive, and the positions that they use.
struct GltfPrimitive {
    std::vector<glm::vec3> positions;          ///< may be no numbers
    std::vector<glm::uvec3> triangles;         ///< of positions
    std::string material;                      ///< its name; "" for none
    std::optional<GltfInfluences> influences;  ///< of these positions; read only where a skin asks for them
};

struct GltfMesh {
    std::string name;  ///< "" for none
    std::vector<GltfPrimitive> primitives;
};

class GltfMeshes {
  public:
    /// \param buffers  borrowed. \param triangle_max  of all meshes that are read, together.
    GltfMeshes(const GltfValue& document, GltfBuffers& buffers, std::uint64_t triangle_max)
        : document_(document), buffers_(&buffers), triangle_max_(triangle_max) {}

    /// Reads a mesh. \param skinned  whether a skin asks for it. Errors: kInvalidInput, kUnsupported, kLimit.
    [[nodiscard]] Result<GltfMesh> read(const GltfValue& mesh, bool skinned);

    /// What those that were read hold; `meshes` and `unplaced` are not set.
    [[nodiscard]] MeshParts parts() const;
    /// Without the file's name.
    [[nodiscard]] const std::vector<std::string>& warnings() const { return warnings_; }

  private:
    /// What tells the vertices of one accessor from those of another: exporters make many accessors of one view.
    using Key = std::tuple<std::uint64_t, std::uint64_t, std::uint64_t, std::uint64_t, bool, std::uint64_t>;
    struct Vertices {
        std::vector<glm::vec3> positions;
        std::vector<std::uint8_t> uses;
    };

    Result<void> readPrimitive(const GltfValue& place, bool skinned, GltfMesh& mesh);
    Result<Vertices*> vertices(const GltfValue& accessor, std::uint64_t index);
    /// \return the vertices that become out.positions.
    Result<std::vector<std::uint32_t>> readTriangles(const GltfValue& place, std::uint64_t mode,
                                                     Vertices& vertices, GltfPrimitive& out);
    Result<void> readDracoTriangles(const GltfValue& place, const GltfValue& draco, std::uint64_t position,
                                    GltfPrimitive& out);
    Result<void> countTriangles(const GltfValue& place, std::uint64_t count);
    /// \return the vertices that become out.positions.
    std::vector<std::uint32_t> useOnly(const Vertices& vertices, std::vector<glm::uvec3> triangles,
                                       GltfPrimitive& out);
    void warn(const std::string& text);

    GltfValue document_;
    GltfBuffers* buffers_;
    std::uint64_t triangle_max_;
    std::uint64_t triangles_ = 0;
    std::uint64_t vertex_count_ = 0;
    std::map<Key, Vertices> vertices_;
    std::vector<std::uint32_t> new_index_;  // scratch of useOnly, all kUnused between its calls
    MeshParts parts_;
    std::vector<std::string> warnings_;
};

}  // namespace relief

#include "bake/import/gltf_draco.h"

#include <draco/compression/decode.h>

#include <algorithm>
#include <array>
#include <memory>

namespace relief {

std::optional<DracoMesh> readDraco(std::span<const std::byte> bytes, std::uint64_t attribute,
                                   std::uint64_t triangles_max) {
    draco::DecoderBuffer buffer;
    buffer.Init(reinterpret_cast<const char*>(bytes.data()), bytes.size());
    draco::Decoder decoder;
    draco::StatusOr<std::unique_ptr<draco::Mesh>> decoded = decoder.DecodeMeshFromBuffer(&buffer);
    if (!decoded.ok() || decoded.value() == nullptr || attribute > UINT32_MAX) {
        return std::nullopt;
    }
    const draco::Mesh& source = *decoded.value();
    const draco::PointAttribute* const positions =
        source.GetAttributeByUniqueId(static_cast<std::uint32_t>(attribute));
    const bool mapped = positions != nullptr && (positions->is_mapping_identity() ||
                                                 positions->indices_map_size() >= source.num_points());
    if (!mapped || positions->num_components() != 3 || source.num_faces() > triangles_max ||
        source.num_points() > 3 * triangles_max) {
        return std::nullopt;
    }
    DracoMesh mesh;
    mesh.positions.reserve(source.num_points());
    for (draco::PointIndex i(0); i < source.num_points(); ++i) {
        const draco::AttributeValueIndex value = positions->mapped_index(i);
        std::array<float, 3> xyz{};
        if (value.value() >= positions->size() || !positions->ConvertValue<float, 3>(value, xyz.data())) {
            return std::nullopt;
        }
        mesh.positions.emplace_back(xyz[0], xyz[1], xyz[2]);
    }
    mesh.triangles.reserve(source.num_faces());
    for (draco::FaceIndex i(0); i < source.num_faces(); ++i) {
        const draco::Mesh::Face& face = source.face(i);
        const glm::uvec3 triangle(face[0].value(), face[1].value(), face[2].value());
        if (std::max({triangle.x, triangle.y, triangle.z}) >= mesh.positions.size()) {
            return std::nullopt;
        }
        mesh.triangles.push_back(triangle);
    }
    return mesh;
}

}  // namespace relief

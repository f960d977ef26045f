#include "bake/import/gltf_meshes.h"

#include <algorithm>
#include <array>
#include <limits>
#include <optional>
#include <utility>

#include "bake/import/gltf_accessor.h"
#include "bake/import/gltf_draco.h"

namespace relief {
namespace {

enum Mode : std::uint64_t { kPoints, kLines, kLineLoop, kLineStrip, kTriangles, kStrip, kFan };
constexpr std::uint8_t kByTriangle = 1;
constexpr std::uint8_t kByOther = 2;
constexpr std::uint32_t kUnused = std::numeric_limits<std::uint32_t>::max();

std::uint64_t trianglesOf(std::uint64_t mode, std::uint64_t corners) {
    return mode == kTriangles ? corners / 3 : corners < 3 ? 0 : corners - 2;
}

std::uint64_t linesOf(std::uint64_t mode, std::uint64_t corners) {
    return mode == kLines ? corners / 2 : corners < 2 ? 0 : mode == kLineLoop ? corners : corners - 1;
}

/// The corners of a triangle, by number in its primitive. Of strips every other one is turned over.
glm::uvec3 cornersOf(std::uint64_t mode, std::uint32_t triangle) {
    switch (mode) {
        case kStrip:
            return triangle % 2 == 0 ? glm::uvec3(triangle, triangle + 1, triangle + 2)
                                     : glm::uvec3(triangle + 1, triangle, triangle + 2);
        case kFan:
            return {0, triangle + 1, triangle + 2};
        default:
            return {3 * triangle, 3 * triangle + 1, 3 * triangle + 2};
    }
}

GltfInfluences influencesOf(const GltfInfluences& all, const std::vector<std::uint32_t>& vertices) {
    GltfInfluences some{all.per_vertex, {}};
    some.all.reserve(all.per_vertex * vertices.size());
    for (const std::uint32_t vertex : vertices) {
        const auto from = all.all.begin() + static_cast<std::ptrdiff_t>(all.per_vertex * vertex);
        some.all.insert(some.all.end(), from, from + static_cast<std::ptrdiff_t>(all.per_vertex));
    }
    return some;
}

}  // namespace

void GltfMeshes::warn(const std::string& text) {
    if (std::find(warnings_.begin(), warnings_.end(), text) == warnings_.end()) {
        warnings_.push_back(text);
    }
}

Result<GltfMesh> GltfMeshes::read(const GltfValue& mesh, bool skinned) {
    GltfMesh out;
    out.name = RELIEF_TRY(mesh.text("name")).value_or("");
    const GltfList primitives = RELIEF_TRY(mesh.objects("primitives"));
    for (std::size_t i = 0; i < primitives.size(); ++i) {
        const GltfValue place = RELIEF_TRY(primitives.at(i));
        RELIEF_TRY(readPrimitive(place, skinned, out));
    }
    return out;
}

Result<void> GltfMeshes::readPrimitive(const GltfValue& place, bool skinned, GltfMesh& mesh) {
    const std::optional<GltfValue> attributes = RELIEF_TRY(place.object("attributes"));
    const std::uint64_t mode = RELIEF_TRY(place.whole("mode")).value_or(kTriangles);
    if (!attributes || mode > kFan) {
        return place.wrong(attributes ? "has a mode that is not 0 to 6" : "has no attributes");
    }
    if (RELIEF_TRY(place.objects("targets")).size() > 0) {
        warn("it is morphed; baked as it is modelled, without its targets");
    }
    GltfPrimitive out;
    if (const std::optional<std::uint64_t> material = RELIEF_TRY(place.whole("material"))) {
        const GltfList materials = RELIEF_TRY(document_.objects("materials"));
        const GltfValue named = RELIEF_TRY(materials.named(*material, place, "material"));
        out.material = RELIEF_TRY(named.text("name")).value_or("");
    }
    const std::optional<std::uint64_t> position = RELIEF_TRY(attributes->whole("POSITION"));
    if (!position) {
        warn("a primitive without positions is left out");
        return {};
    }
    const GltfList accessors = RELIEF_TRY(document_.objects("accessors"));
    const GltfValue accessor = RELIEF_TRY(accessors.named(*position, *attributes, "POSITION"));
    const std::optional<GltfValue> extensions = RELIEF_TRY(place.object("extensions"));
    std::optional<GltfValue> draco;
    if (extensions) {
        draco = RELIEF_TRY(extensions->object("KHR_draco_mesh_compression"));
    }
    if (draco && mode != kTriangles && mode != kStrip) {
        return place.wrong("is compressed by Draco, which holds triangles, but its mode is another");
    }
    if (draco) {
        const std::uint64_t count = RELIEF_TRY(accessorCount(accessor));
        RELIEF_TRY(readDracoTriangles(place, *draco, count, out));
    } else {
        Vertices* const used = RELIEF_TRY(vertices(accessor, *position));
        const std::vector<std::uint32_t> kept = RELIEF_TRY(readTriangles(place, mode, *used, out));
        if (skinned) {
            const std::optional<GltfInfluences> all =
                RELIEF_TRY(readInfluences(document_, *attributes, *buffers_, used->positions.size()));
            out.influences = all ? std::optional(influencesOf(*all, kept)) : std::nullopt;
        }
    }
    if (!out.triangles.empty()) {
        mesh.primitives.push_back(std::move(out));
    }
    return {};
}

Result<GltfMeshes::Vertices*> GltfMeshes::vertices(const GltfValue& accessor, std::uint64_t index) {
    const bool plain = accessor.has("bufferView") && !accessor.has("sparse");
    const Key key{plain ? RELIEF_TRY(accessor.neededWhole("bufferView")) : 0,
                  RELIEF_TRY(accessor.whole("byteOffset")).value_or(0),
                  RELIEF_TRY(accessorCount(accessor)),
                  RELIEF_TRY(accessor.neededWhole("componentType")),
                  RELIEF_TRY(accessor.flag("normalized")),
                  plain ? 0 : index + 1};
    const auto found = vertices_.find(key);
    if (found != vertices_.end()) {
        return &found->second;
    }
    Vertices read;
    read.positions = RELIEF_TRY(readPositions(accessor, *buffers_, 3 * triangle_max_ - vertex_count_));
    read.uses.resize(read.positions.size(), 0);
    vertex_count_ += read.positions.size();
    return &vertices_.emplace(key, std::move(read)).first->second;
}

Result<void> GltfMeshes::countTriangles(const GltfValue& place, std::uint64_t count) {
    if (count > triangle_max_ - triangles_) {
        return place.wrong("is beyond the limit of " + std::to_string(triangle_max_) +
                               " triangles for all meshes; simplify the mesh, or raise --max-triangles",
                           ErrorCode::kLimit);
    }
    triangles_ += count;
    return {};
}

Result<std::vector<std::uint32_t>> GltfMeshes::readTriangles(const GltfValue& place, std::uint64_t mode,
                                                             Vertices& vertices, GltfPrimitive& out) {
    // Without indices, the vertices as they come.
    std::optional<std::vector<std::uint32_t>> indices;
    std::uint64_t corners = vertices.positions.size();
    if (const std::optional<std::uint64_t> index = RELIEF_TRY(place.whole("indices"))) {
        const GltfList accessors = RELIEF_TRY(document_.objects("accessors"));
        const GltfValue accessor = RELIEF_TRY(accessors.named(*index, place, "indices"));
        indices = RELIEF_TRY(readIndices(accessor, *buffers_, 3 * triangle_max_));
        corners = indices->size();
        for (const std::uint32_t vertex : *indices) {
            if (vertex >= vertices.positions.size()) {
                return accessor.wrong("holds the index " + std::to_string(vertex) +
                                      " of a vertex that does not exist: there are " +
                                      std::to_string(vertices.positions.size()));
            }
        }
    }
    const auto vertexOf = [&indices](std::uint64_t corner) {
        return indices ? (*indices)[corner] : static_cast<std::uint32_t>(corner);
    };
    const bool surface = mode >= kTriangles;
    for (std::uint64_t i = 0; i < corners; ++i) {
        vertices.uses[vertexOf(i)] |= surface ? kByTriangle : kByOther;
    }
    parts_.points += mode == kPoints ? corners : 0;
    parts_.lines += surface || mode == kPoints ? 0 : linesOf(mode, corners);
    if (!surface) {
        return std::vector<std::uint32_t>();
    }
    if (mode == kTriangles && corners % 3 != 0) {
        return place.wrong("has " + std::to_string(corners) + " corners, which is no multiple of 3");
    }
    const std::uint64_t count = trianglesOf(mode, corners);
    RELIEF_TRY(countTriangles(place, count));
    parts_.polygons += count;
    std::vector<glm::uvec3> triangles;
    triangles.reserve(count);
    for (std::uint32_t i = 0; i < count; ++i) {
        const glm::uvec3 corner = cornersOf(mode, i);
        triangles.emplace_back(vertexOf(corner.x), vertexOf(corner.y), vertexOf(corner.z));
    }
    return useOnly(vertices, std::move(triangles), out);
}

std::vector<std::uint32_t> GltfMeshes::useOnly(const Vertices& vertices, std::vector<glm::uvec3> triangles,
                                               GltfPrimitive& out) {
    new_index_.resize(std::max(new_index_.size(), vertices.positions.size()), kUnused);
    std::vector<std::uint32_t> used;
    for (const glm::uvec3& t : triangles) {
        for (const std::uint32_t vertex : {t.x, t.y, t.z}) {
            if (new_index_[vertex] == kUnused) {
                new_index_[vertex] = 0;
                used.push_back(vertex);
            }
        }
    }
    std::sort(used.begin(), used.end());
    out.positions.reserve(used.size());
    for (const std::uint32_t vertex : used) {
        new_index_[vertex] = static_cast<std::uint32_t>(out.positions.size());
        out.positions.push_back(vertices.positions[vertex]);
    }
    for (glm::uvec3& t : triangles) {
        t = {new_index_[t.x], new_index_[t.y], new_index_[t.z]};
    }
    for (const std::uint32_t vertex : used) {
        new_index_[vertex] = kUnused;
    }
    out.triangles = std::move(triangles);
    return used;
}

Result<void> GltfMeshes::readDracoTriangles(const GltfValue& place, const GltfValue& draco,
                                            std::uint64_t position_count, GltfPrimitive& out) {
    const GltfView view = RELIEF_TRY(buffers_->view(draco));
    const std::optional<GltfValue> attributes = RELIEF_TRY(draco.object("attributes"));
    if (!attributes) {
        return draco.wrong("has no attributes");
    }
    const std::uint64_t attribute = RELIEF_TRY(attributes->neededWhole("POSITION"));
    std::optional<DracoMesh> mesh = readDraco(view.bytes, attribute, triangle_max_ - triangles_);
    // Its accessors say what it must hold.
    bool same = mesh && mesh->positions.size() == position_count;
    if (const std::optional<std::uint64_t> index = RELIEF_TRY(place.whole("indices")); index && same) {
        const GltfList accessors = RELIEF_TRY(document_.objects("accessors"));
        const GltfValue accessor = RELIEF_TRY(accessors.named(*index, place, "indices"));
        const std::uint64_t corners = RELIEF_TRY(accessorCount(accessor));
        same = RELIEF_TRY(place.whole("mode")).value_or(kTriangles) == kStrip ||
               corners == 3 * mesh->triangles.size();
    }
    if (!same) {
        return draco.wrong("holds no mesh of Draco as its primitive announces it; export it without Draco");
    }
    RELIEF_TRY(countTriangles(place, mesh->triangles.size()));
    parts_.polygons += mesh->triangles.size();
    Vertices vertices{std::move(mesh->positions), {}};
    const std::size_t count = vertices.positions.size();
    useOnly(vertices, std::move(mesh->triangles), out);
    parts_.vertices += count;
    parts_.unused += count - out.positions.size();
    parts_.loose += count - out.positions.size();
    return {};
}

MeshParts GltfMeshes::parts() const {
    MeshParts parts = parts_;
    for (const auto& [key, vertices] : vertices_) {
        parts.vertices += vertices.uses.size();
        for (const std::uint8_t use : vertices.uses) {
            parts.unused += (use & kByTriangle) == 0 ? 1 : 0;
            parts.loose += use == 0 ? 1 : 0;
        }
    }
    return parts;
}

}  // namespace relief

// SPDX-License-Identifier: Apache-2.0
// Holds a reader's result: surfaces, and the nodes that place them. scene_polygons.h adds polygons to it, and
// scene_flattener.h merges it into one mesh.
#pragma once

#include <array>
#include <cstdint>
#include <glm/mat3x3.hpp>
#include <glm/vec3.hpp>
#include <optional>
#include <string>
#include <vector>

#include "bake/import/import_job.h"
#include "bake/import/import_units.h"
#include "bake/mesh/mesh.h"
#include "formats/base/result.h"
#include "formats/polygons/polygon_mesh.h"

namespace relief {

static_assert(kPolygonTrianglesMax == kTriangleMax);

/// p -> linear · p + offset
struct Transform {
    glm::dmat3 linear{1.0};
    glm::dvec3 offset{0.0};

    [[nodiscard]] glm::dvec3 apply(const glm::dvec3& p) const { return linear * p + offset; }
    [[nodiscard]] bool mirrors() const;
    /// The scale is 0 along some direction.
    [[nodiscard]] bool flattens() const;
};
/// A similarity transform without its translation.
struct RigidPose {
    std::array<double, 4> rotation{};  ///< unit quaternion x, y, z, w, with w ≥ 0
    double scale = 1.0;
};
/// Extracts rotation and uniform scale. \return nullopt for other transforms, including mirrors.
[[nodiscard]] std::optional<RigidPose> rigidPose(const glm::dmat3& linear);

/// Applies `inner` first.
[[nodiscard]] Transform operator*(const Transform& outer, const Transform& inner);

/// Triangles of one material.
struct ScenePart {
    std::vector<glm::vec3> positions;   ///< may be NaN
    std::vector<glm::uvec3> triangles;  ///< valid indices into positions
    std::string material{};             ///< for SurfaceName
    std::vector<std::string> names{};   ///< for --as: of its mesh, group and material
};

/// Copies to the part only the positions that its triangles use, in order. \return their indices in `positions`.
std::vector<std::uint32_t> compact(const std::vector<glm::vec3>& positions, ScenePart& part);

/// The surface response of a node (formats/materials.h).
struct NodeResponse {
    std::string name;  ///< material name for parts without one
    float restitution = 1.0F;
    float friction = 0.0F;
    friend auto operator<=>(const NodeResponse&, const NodeResponse&) = default;
};

/// Whether the file shows a node's parts.
enum class Shown : std::uint8_t {
    kYes,
    kHidden,      ///< the node or an ancestor is hidden
    kLowerLevel,  ///< a lower level of detail of another node
};

/// Places parts and child nodes. A node may be placed several times.
struct SceneNode {
    std::optional<Transform> transform{};  ///< to the parent
    Shown is_shown = Shown::kYes;
    bool posed = false;                ///< its parts are in scene space, regardless of transforms
    std::vector<std::string> names{};  ///< for --as; they select the node and all its descendants
    std::string shown{};               ///< SurfaceName::node; the next two members are for SurfaceName, too
    std::optional<NodeResponse> response{};
    std::optional<std::uint32_t> index{};  ///< nullopt: each placement counts as a separate node
    std::vector<std::uint32_t> parts{};
    std::vector<std::uint32_t> children{};
};

struct ImportScene {
    std::vector<ScenePart> parts;
    std::vector<SceneNode> nodes;
    std::vector<std::uint32_t> roots;
    SourceFrame frame;
    MeshParts counts;  ///< of the whole file; flatten() computes `meshes` and `unplaced` if they are 0
    std::vector<std::string> warnings;
};

/// A warning, without the file name.
inline constexpr const char* kAnimatedVisibility =
    "its animations show and hide objects; baked with the visibility of its nodes";

/// Returns " ('NAME')" for one object, " (first 'NAME')" for several, "" if the name is empty.
[[nodiscard]] std::string firstName(const std::string& name, std::uint64_t count);

/// Counts objects that an import skips because the file does not show them.
class LeftOutObjects {
  public:
    /// Counts the object if it is skipped. \param name  as stored in the file. \return whether it is skipped.
    bool leaveOut(Shown shown, const std::string& name, HiddenAs hidden);
    /// Adds one line for each kind to `warnings`.
    void warn(std::vector<std::string>& warnings) const;
    [[nodiscard]] bool any() const { return counts_ != std::array<std::uint64_t, 2>{}; }

  private:
    std::array<std::uint64_t, 2> counts_{};     // hidden objects, lower levels of detail
    std::array<std::string, 2> first_names_{};  // by the same index
};

/// Returns the error "no triangles…". \param left_out  any() of LeftOutObjects.
[[nodiscard]] tl::unexpected<Error> noTriangles(bool left_out);

/// Returns the error "it has more than N triangles…" (kLimit).
[[nodiscard]] tl::unexpected<Error> tooManyTriangles(const ImportJob& job);

}  // namespace relief

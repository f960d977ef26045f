// SPDX-License-Identifier: Apache-2.0
// The result of a reader, surfaces and the nodes that place them, and its conversion to one TriangleMesh.
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
    /// A scale of 0 along some direction.
    [[nodiscard]] bool flattens() const;
};
/// A transform that keeps shapes, but for their size.
struct RigidPose {
    std::array<double, 4> rotation{};  ///< a unit quaternion x, y, z, w, with w ≥ 0
    double scale = 1.0;
};
/// \return nullopt for other transforms, mirrors included. The shift is not looked at.
[[nodiscard]] std::optional<RigidPose> rigidPose(const glm::dmat3& linear);

/// First `inner`, then `outer`.
[[nodiscard]] Transform operator*(const Transform& outer, const Transform& inner);

/// Triangles of one material.
struct ScenePart {
    std::vector<glm::vec3> positions;   ///< may be NaN
    std::vector<glm::uvec3> triangles;  ///< of positions that exist
    std::string material{};             ///< of SurfaceName
    std::vector<std::string> names{};   ///< that --as can select it by: of its mesh, group, material
};

/// Gives the part those of the positions that its triangles use, in their order. \return them, by their index.
std::vector<std::uint32_t> compact(const std::vector<glm::vec3>& positions, ScenePart& part);

/// The response of a node's surface (formats/materials.h).
struct NodeResponse {
    std::string name;  ///< of the material of parts that have none
    float restitution = 1.0F;
    float friction = 0.0F;
    friend auto operator<=>(const NodeResponse&, const NodeResponse&) = default;
};

/// Whether the file shows the parts of a node.
enum class Shown : std::uint8_t {
    kYes,
    kHidden,       ///< it or a node above it is hidden
    kLesserLevel,  ///< of detail; another node has the most detailed one
};

/// A place of parts and of other nodes, which may have several places themselves.
struct SceneNode {
    std::optional<Transform> transform{};  ///< to its parent
    Shown is_shown = Shown::kYes;
    bool posed = false;                ///< its parts are in scene space, whatever the transforms
    std::vector<std::string> names{};  ///< that --as can select all below it by
    std::string shown{};               ///< of SurfaceName, as are the next two
    std::optional<NodeResponse> response{};
    std::optional<std::uint32_t> index{};  ///< nullopt: each place of the node counts for itself
    std::vector<std::uint32_t> parts{};
    std::vector<std::uint32_t> children{};
};

struct ImportScene {
    std::vector<ScenePart> parts;
    std::vector<SceneNode> nodes;
    std::vector<std::uint32_t> roots;
    SourceFrame frame;
    MeshParts
        counts;  ///< of the whole file; flatten() counts `meshes` and those that no node places, if they are 0
    std::vector<std::string> warnings;
};

/// Counts what the mesh holds. \param mesh  whose corners exist.
[[nodiscard]] MeshParts partsOf(const PolygonMesh& mesh);

/// Counts the polygons, cuts them into triangles, and adds these as parts below a node of the file's name.
/// \param apart  whether each corner becomes a vertex of its own; true for a mesh that has groups.
/// Errors: kLimit (more triangles than the job allows).
[[nodiscard]] Result<void> addPolygons(const PolygonMesh& polygons, bool apart, const ImportJob& job,
                                       ImportScene& scene);

/// The polygons in triangles, as one part without names.
[[nodiscard]] ScenePart cutPolygons(const PolygonMesh& polygons);

/// The error of a file with vertices or lines, but no polygon; nullopt for all others.
[[nodiscard]] std::optional<std::string> partsRefusal(const MeshParts& parts);
/// Lines, points, free forms and meshes that are left out, and many loose vertices: each a line without the file's name.
void warnOfParts(const MeshParts& parts, std::vector<std::string>& warnings);

/// Everything that the scene shows, in metres and +y up where frame or job state unit and axis, with warnings of omitted
/// parts, and with marks for the job's names. All triangles are counted before anything is allocated: a small file can place
/// one mesh very often.
/// Errors, naming no file: kInvalidInput (nothing to show, a node within itself, an invalid frame), kUsage (a name that no
/// triangle has), kLimit (more triangles than the job allows, or thrice as many vertices).
[[nodiscard]] Result<TriangleMesh> flatten(ImportScene scene, const ImportJob& job);

/// The same as a level: TriangleMesh::level_meshes and level_bodies. A mesh that is placed with a shear, unequal scales or a
/// mirror counts as another, to which that has been applied; of a rotation, one scale and a shift it is a body.
/// Errors: also kLimit (more meshes or bodies than a world may have).
[[nodiscard]] Result<TriangleMesh> flattenLevel(ImportScene scene, const ImportJob& job);

/// A warning, without the file's name.
inline constexpr const char* kAnimatedVisibility =
    "its animations show and hide objects; it is baked as its nodes are without them";

/// " ('NAME')" of one object, " (first 'NAME')" of several, nothing if the name is empty.
[[nodiscard]] std::string firstName(const std::string& name, std::uint64_t count);

/// Objects that an import leaves out because the file does not show them.
class LeftOutObjects {
  public:
    /// Counts an object that is left out. \param name  as stored in the file. \return whether it is left out.
    bool leaveOut(Shown shown, const std::string& name, HiddenAs hidden);
    /// One line for each kind. \param warnings  receives them.
    void warn(std::vector<std::string>& warnings) const;
    [[nodiscard]] bool any() const { return counts_ != std::array<std::uint64_t, 2>{}; }

  private:
    std::array<std::uint64_t, 2> counts_{};     // hidden ones, lesser levels
    std::array<std::string, 2> first_names_{};  // the same
};

/// "no triangles…". \param left_out  any() of LeftOutObjects.
[[nodiscard]] tl::unexpected<Error> noTriangles(bool left_out);

/// "it has more than N triangles…", kLimit.
[[nodiscard]] tl::unexpected<Error> tooManyTriangles(const ImportJob& job);

}  // namespace relief

// SPDX-License-Identifier: Apache-2.0
// Holds the result of a reader (surfaces, and the nodes that place them), and flattens it to one TriangleMesh.
#pragma once

#include <array>
#include <cstdint>
#include <glm/mat3x3.hpp>
#include <glm/vec3.hpp>
#include <optional>
#include <string>
#include <vector>

#include "bake/import/import_job.h"
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

struct ScenePart {
    std::vector<glm::vec3> positions;   ///< may be NaN
    std::vector<glm::uvec3> triangles;  ///< valid indices into positions
    std::string material{};             ///< for SurfaceName
    std::vector<std::string> names{};   ///< of its mesh, group and material, for --as
};

/// Copies the used entries of `positions` to part.positions, in order, and renumbers the corners of part.triangles.
/// \return the indices in `positions` of the copied positions.
std::vector<std::uint32_t> compact(const std::vector<glm::vec3>& positions, ScenePart& part);

/// The surface response of a node (formats/materials.h).
struct SurfaceResponse {
    std::string name;  ///< material name for parts without one
    float restitution = 1.0F;
    float friction = 0.0F;
    friend auto operator<=>(const SurfaceResponse&, const SurfaceResponse&) = default;
};

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
    std::string shown{};  ///< becomes SurfaceName::node; the next two members also go into SurfaceName
    std::optional<SurfaceResponse> response{};
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

/// Counts the contents of a mesh. \param mesh  its corners are valid indices.
[[nodiscard]] MeshParts partsOf(const PolygonMesh& mesh);

/// Counts the polygons, triangulates them, and adds them as parts below a node with the file's name.
/// \param apart  each corner becomes a separate vertex; true for a mesh with groups.
/// Errors: kLimit (more triangles than the job allows).
[[nodiscard]] Result<void> addPolygons(const PolygonMesh& polygons, bool apart, const ImportJob& job,
                                       ImportScene& scene);

/// Triangulates the polygons into one part without names.
[[nodiscard]] ScenePart triangulatePolygons(const PolygonMesh& polygons);

/// Returns the error for a file with vertices or lines, but without polygons; nullopt for other files.
[[nodiscard]] std::optional<std::string> partsError(const MeshParts& parts);
/// Warns about skipped lines, points, free-form shapes and meshes, and about many loose vertices; one line each,
/// without the file name.
void warnAboutParts(const MeshParts& parts, std::vector<std::string>& warnings);

/// Merges all shown parts of the scene into one mesh, sets TriangleMesh::marks, and warns about skipped parts.
/// Converts to metres and +Y up if the frame or the job specifies unit and axis. Counts all triangles before
/// allocating, because a small file can place one mesh many times.
/// Errors, without the file name: kInvalidInput (nothing to show, a node within itself, an invalid frame), kUsage (a
/// name without triangles), kLimit (triangles exceed the job's limit, or vertices three times it).
[[nodiscard]] Result<TriangleMesh> flatten(ImportScene scene, const ImportJob& job);

/// Like flatten(), but fills TriangleMesh::level_meshes and level_bodies. Rotation, uniform scale and translation
/// become a body's pose. Shear, non-uniform scale and mirrors are applied to the mesh, which then counts as a separate
/// mesh.
/// Errors: also kLimit (more meshes or bodies than a world may have).
[[nodiscard]] Result<TriangleMesh> flattenLevel(ImportScene scene, const ImportJob& job);

void warnOnce(std::vector<std::string>& warnings, const std::string& warning);

/// A warning, without the file name.
inline constexpr const char* kAnimatedVisibility =
    "its animations show and hide objects; baked with the visibility of its nodes";

/// Returns " ('NAME')" for one object, " (first 'NAME')" for several, "" if the name is empty.
[[nodiscard]] std::string firstName(const std::string& name, std::uint64_t count);

/// Counts hidden objects and lower levels of detail that an import skips.
class SkippedObjects {
  public:
    /// Counts the object if it is skipped. \param name  as stored in the file. \return whether it is skipped.
    bool leaveOut(Shown shown, const std::string& name, HiddenMode hidden);
    void warn(std::vector<std::string>& warnings) const;
    [[nodiscard]] bool any() const { return counts_ != std::array<std::uint64_t, 2>{}; }

  private:
    std::array<std::uint64_t, 2> counts_{};     // hidden objects, lower levels of detail
    std::array<std::string, 2> first_names_{};  // by the same index
};

/// Returns the error "no triangles…". \param left_out  any() of SkippedObjects.
[[nodiscard]] tl::unexpected<Error> noTriangles(bool left_out);

/// Returns the error "it has more than N triangles…" (kLimit).
[[nodiscard]] tl::unexpected<Error> tooManyTriangles(const ImportJob& job);

}  // namespace relief

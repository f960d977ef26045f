// SPDX-License-Identifier: Apache-2.0
// A collider: a set of depth maps that together represent the outer shape of an object, and its evaluation at a point.
// CPU reference of shaders/collider/collider.glsl.
#pragma once

#include <cstdint>
#include <glm/vec3.hpp>
#include <limits>
#include <optional>
#include <string>
#include <vector>

#include "formats/depth_map.h"
#include "formats/materials.h"

namespace relief {

/// An axis-aligned box in object space. min > max on every axis means empty.
struct Bounds {
    glm::vec3 min{std::numeric_limits<float>::max()};
    glm::vec3 max{-std::numeric_limits<float>::max()};

    void add(const glm::vec3& p);
    [[nodiscard]] glm::vec3 size() const { return max - min; }
    [[nodiscard]] glm::vec3 center() const { return 0.5F * min + 0.5F * max; }
    [[nodiscard]] float longestSide() const;
    /// Returns the largest magnitude of a coordinate.
    [[nodiscard]] float farthest() const;
    /// Returns a corner. \param i  0 to 7: bits 0, 1 and 2 select the maximum of x, y and z.
    [[nodiscard]] glm::vec3 corner(unsigned i) const {
        return {(i & 1U) != 0 ? max.x : min.x, (i & 2U) != 0 ? max.y : min.y, (i & 4U) != 0 ? max.z : min.z};
    }
    /// Returns whether the boxes share a point; boundaries are included.
    [[nodiscard]] bool meets(const Bounds& other) const;
    [[nodiscard]] bool contains(const glm::vec3& p) const { return meets({p, p}); }
    friend bool operator==(const Bounds&, const Bounds&) = default;
};

/// A recorded bake option: a field of BakeRequest with its value in the syntax of `relief bake`.
struct RecordedOption {
    std::string name;   ///< "max_error"
    std::string value;  ///< "2"; clean UTF-8

    /// Returns "--max-error 2", quoted for a shell; only the name for a flag whose value is "true".
    [[nodiscard]] std::string text() const;
    friend bool operator==(const RecordedOption&, const RecordedOption&) = default;
};

/// Origin of a collider. Independent of time, machine and folder.
struct Provenance {
    std::string mesh_name;  ///< file name without folder; UTF-8
    std::string mesh_hash;  ///< XXH3-128 of the mesh file, 32 lower-case hexadecimal digits; or ""
    std::uint64_t triangles = 0;
    std::string tool_version;             ///< "relief 0.1.0"
    std::vector<RecordedOption> options;  ///< effective options; a list has one entry for each element

    /// Returns "--map front-back:dir=+x,size=512x512,… --quality normal", quoted for a shell.
    [[nodiscard]] std::string optionsText() const;
    friend bool operator==(const Provenance&, const Provenance&) = default;
};

struct Collider {
    Bounds bounds;     ///< of the mesh, object units
    std::string unit;  ///< unit of length: "m", or "" if the source has none
    Provenance provenance;
    std::vector<DepthMap> maps;
    /// An animated mesh (animation/animated_mesh.h), not validated; the maps represent its rest pose. Empty for static
    /// colliders.
    std::vector<std::byte> animation{};
    Materials materials{};  ///< surface materials; empty if uniform

    /// Returns the texel bytes of all maps, in memory and on the GPU.
    [[nodiscard]] std::uint64_t texelBytes() const;
    [[nodiscard]] bool hasPatches() const;
    friend bool operator==(const Collider&, const Collider&) = default;
};

/// The combined vote at a point.
struct FieldSample {
    /// Signed distance in object units, positive outside. kFarOutside if the point is outside at an unknown distance, or
    /// if all maps abstain.
    float distance = kFarOutside;
    glm::vec3 normal{0.0F};  ///< of the deciding surface; zero if distance is kFarOutside
    int map = -1;            ///< deciding map, the first on ties; −1 if all maps abstain

    [[nodiscard]] bool inside() const { return map >= 0 && distance < 0.0F; }
};

/// Combines the votes of all maps (rule 2 of the paper).
/// \param p  object space, finite.
[[nodiscard]] FieldSample evaluate(const Collider& collider, const glm::vec3& p);

/// The data that a simulation step needs: inside or outside, and the normal if inside.
struct InsideSample {
    bool inside = false;
    glm::vec3 normal{0.0F};  ///< of the inside vote whose distance is closest to 0; zero if outside
    /// Inside: the map of that vote. Outside: the first map that classifies the point as outside, or −1.
    int map = -1;
};

/// Returns the same side as evaluate(), and the same normal and map if inside, but stops at the first map that
/// classifies `p` as outside. The first element of Collider::maps should be the map that decides most often.
[[nodiscard]] InsideSample evaluateInside(const Collider& collider, const glm::vec3& p);
/// Returns false only if all points of a box are outside. Tests only maps of patches with `encloses`; returns true if
/// there are none. \param box  object space, finite
[[nodiscard]] bool mayBeInside(const Collider& collider, const Bounds& box);

/// Returns a box that contains the solid: the intersection of the volumes of maps with `encloses` and
/// `empty_is_outside`; nullopt if none.
[[nodiscard]] std::optional<Bounds> insideBox(const Collider& collider);
/// Returns a box that contains Collider::bounds and, if there is one, insideBox(). The solid of ground extends below
/// `bounds`.
[[nodiscard]] Bounds solidBox(const Collider& collider);

/// Returns the side of the finest texel of all maps, in object units, but at least 1/2048 of the longest side.
[[nodiscard]] float finestTexel(const Collider& collider);

}  // namespace relief

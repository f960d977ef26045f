// SPDX-License-Identifier: Apache-2.0
// A collider: a set of depth maps that together represent the outer shape of an object, and its value at
// a point. CPU truth of shaders/collider/collider.glsl.
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

/// An axis-aligned box in object space. min > max on every axis means "holds nothing".
struct Bounds {
    glm::vec3 min{std::numeric_limits<float>::max()};
    glm::vec3 max{-std::numeric_limits<float>::max()};

    void add(const glm::vec3& p);
    [[nodiscard]] glm::vec3 size() const { return max - min; }
    [[nodiscard]] glm::vec3 center() const { return 0.5F * min + 0.5F * max; }
    [[nodiscard]] float longestSide() const;
    /// They have a point in common; sides belong to both.
    [[nodiscard]] bool meets(const Bounds& other) const;
    [[nodiscard]] bool contains(const glm::vec3& p) const { return meets({p, p}); }
    friend bool operator==(const Bounds&, const Bounds&) = default;
};

/// An option of the bake: a field of BakeRequest, and its value as `relief bake` takes it.
struct RecordedOption {
    std::string name;   ///< "max_error"
    std::string value;  ///< "2"; clean UTF-8

    /// "--max-error 2", quoted for a shell; of a flag, whose value is "true", its name alone.
    [[nodiscard]] std::string text() const;
    friend bool operator==(const RecordedOption&, const RecordedOption&) = default;
};

/// Where a collider comes from. Nothing in it depends on time, machine or folder.
struct Provenance {
    std::string mesh_name;  ///< file name without its folder; UTF-8
    std::string mesh_hash;  ///< XXH3-128 of the mesh file's bytes, 32 lower-case hexadecimal digits; or ""
    std::uint64_t triangles = 0;
    std::string tool_version;             ///< "relief 0.1.0"
    std::vector<RecordedOption> options;  ///< the effective ones; a list has one for each element

    /// "--map front-back:dir=+x,size=512x512,… --quality normal", quoted for a shell.
    [[nodiscard]] std::string optionsText() const;
    friend bool operator==(const Provenance&, const Provenance&) = default;
};

struct Collider {
    Bounds bounds;     ///< of the mesh, object units
    std::string unit;  ///< of lengths: "m", or "" where the source does not say
    Provenance provenance;
    std::vector<DepthMap> maps;
    /// An animated mesh (animation/animated_mesh.h), unchecked, whose pose at rest the maps are of; empty: it does not move.
    std::vector<std::byte> animation{};
    Materials materials{};  ///< of its surface; empty: it is all the same

    /// Bytes of all maps' texels, in memory and on the GPU.
    [[nodiscard]] std::uint64_t texelBytes() const;
    /// Whether any map is of patches.
    [[nodiscard]] bool hasPatches() const;
    friend bool operator==(const Collider&, const Collider&) = default;
};

/// The combined vote for a point.
struct FieldSample {
    /// Signed distance in object units, positive outside; kFarOutside where P is known to be outside and no
    /// more; meaningless where map is −1.
    float distance = 0.0F;
    glm::vec3 normal{0.0F};  ///< of the deciding surface; zero where distance is kFarOutside
    int map = -1;            ///< the deciding map; the first of equals; −1 where every map abstains

    [[nodiscard]] bool inside() const { return map >= 0 && distance < 0.0F; }
};

/// Combines the votes of all maps by the paper's rule 2.
/// \param p  object space, finite.
[[nodiscard]] FieldSample evaluate(const Collider& collider, const glm::vec3& p);

/// What a step of a simulation needs: the sign, and the normal where it is negative.
struct InsideSample {
    bool inside = false;
    glm::vec3 normal{0.0F};  ///< of the largest negative vote; zero where P is not inside
    int map = -1;  ///< inside: the map of that vote; outside: the first that sees P outside; or −1
};

/// The same as evaluate(…).inside(), and its normal and map where that is true, but stops at the first map
/// that sees P outside: put the map that decides most often first.
[[nodiscard]] InsideSample evaluateInside(const Collider& collider, const glm::vec3& p);

/// A box that holds all that is inside, by the volumes of maps that know what lies beyond them; none where no map does.
[[nodiscard]] std::optional<Bounds> insideBox(const Collider& collider);
/// The box of the mesh and of all that is inside, as far as the maps know it. Ground goes deeper than the mesh that it stands
/// for, and so than the bounds.
[[nodiscard]] Bounds solidBox(const Collider& collider);

/// The side, in object units, of the finest texel among the maps, but no less than 1/2048 of the longest
/// side.
[[nodiscard]] float finestTexel(const Collider& collider);

}  // namespace relief

// SPDX-License-Identifier: Apache-2.0
// Small animated glTF files in closed form.
#pragma once

#include <cstddef>
#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "tests/bake/import/gltf_cases.h"

namespace relief::test {

/// Builds a GLB with one scene.
class GltfBuilder {
  public:
    GltfBuilder();

    /// \return the accessor. \param type  "SCALAR", "VEC3", … \param component  5120 to 5126. \param count  of numbers
    std::size_t accessor(const char* type, int component, std::size_t count, const std::string& data,
                         bool normalized);
    std::size_t floats(const char* type, const std::vector<float>& values);
    std::size_t bytes(const char* type, const std::vector<int>& values, bool normalized = false);
    /// Normalized 16-bit integers; values from −1 to 1.
    std::size_t shares(const char* type, const std::vector<double>& values);
    std::size_t indices(const std::vector<int>& values);
    /// A mesh with one primitive: a box from `low` to `high` with 8 vertices.
    std::size_t box(const glm::vec3& low, const glm::vec3& high);
    /// An animation with one channel. \return its index
    std::size_t animate(std::size_t node, const char* path, std::size_t times, std::size_t values,
                        const char* curve = "LINEAR", const char* name = nullptr);

    nlohmann::json json;
    [[nodiscard]] GltfCase file() const;

  private:
    std::string buffer_;
};

/// Corner i of a box. Bits 0, 1 and 2 select low or high along x, y and z.
[[nodiscard]] glm::vec3 boxCorner(const glm::vec3& low, const glm::vec3& high, int i);

/// A bar, 2 long along y and 1 wide, with two joints. The upper half bends left by 90 degrees in one second. Both
/// joints move the middle vertices equally.
[[nodiscard]] GltfBuilder bendingBar();

/// Three boxes: a base that moves along x, an arm on it that rotates about z, and a mirrored hand.
[[nodiscard]] GltfBuilder robot();

/// A cube with two morph targets: 0 stretches it along x, 1 has no positions. The node's weights are 0.5 and 0.
[[nodiscard]] GltfBuilder morphingCube();

}  // namespace relief::test

// SPDX-License-Identifier: Apache-2.0
// Small glTF files that move, made of numbers.
#pragma once

#include <cstddef>
#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "tests/bake/import/gltf_cases.h"

namespace relief::test {

/// A GLB with one scene, to be filled.
class GltfScribe {
  public:
    GltfScribe();

    /// \return the accessor. \param type  "SCALAR", "VEC3", …
    std::size_t floats(const char* type, const std::vector<float>& values);
    std::size_t bytes(const char* type, const std::vector<int>& values, bool normalized = false);
    /// Of 16 bits, from −1 to 1.
    std::size_t shares(const char* type, const std::vector<double>& values);
    std::size_t indices(const std::vector<int>& values);
    /// A mesh of one primitive: a box from `low` to `high`, each corner once.
    std::size_t box(const glm::vec3& low, const glm::vec3& high);
    /// An animation of one channel. \return its index.
    std::size_t animate(std::size_t node, const char* path, std::size_t times, std::size_t values,
                        const char* curve = "LINEAR", const char* name = nullptr);

    nlohmann::json json;
    [[nodiscard]] GltfCase file() const;

  private:
    std::size_t accessor(const char* type, int component, std::size_t count, const std::string& data,
                         bool normalized);
    std::string buffer_;
};

/// Corner i of a box: its bits choose between low and high, x first.
[[nodiscard]] glm::vec3 boxCorner(const glm::vec3& low, const glm::vec3& high, int i);

/// A bar of 2 along y, and 1 wide, of two joints: the upper half bends to the left by 90 degrees within a second. Vertices at
/// the middle are moved by both alike.
[[nodiscard]] GltfScribe bendingBar();

/// Three boxes: a base that moves along x, an arm on it that turns about z, and one that is mirrored.
[[nodiscard]] GltfScribe robot();

/// A cube with two targets: 0 stretches it along x, 1 has no positions; node weights 0.5 and 0.
[[nodiscard]] GltfScribe morphingCube();

}  // namespace relief::test

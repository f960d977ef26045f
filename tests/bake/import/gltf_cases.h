// SPDX-License-Identifier: Apache-2.0
// Small glTF files of every kind that the specification allows, by a seed, and what may go wrong with them.
#pragma once

#include <cstdint>
#include <filesystem>
#include <nlohmann/json.hpp>
#include <string>

#include "tests/bake/meshes.h"

namespace relief::test {

/// The same numbers everywhere.
class Dice {
  public:
    explicit Dice(std::uint64_t seed) : state_(seed) {}
    /// 0 … sides − 1.
    std::uint64_t roll(std::uint64_t sides);
    bool once(std::uint64_t in) { return roll(in) == 0; }
    int from(int least, int most);

  private:
    std::uint64_t state_;
};

enum class GltfContainer { kBinary, kDataUri, kFileBeside };

struct GltfCase {
    nlohmann::json document;
    std::string buffer;
    GltfContainer container = GltfContainer::kBinary;
};

/// Trees of nodes with matrices, or translations, rotations and scales; meshes used often, skinned ones; triangles, strips,
/// fans, lines and points; positions as floats and quantised, apart and sparse; indices of three sizes, sparse or none.
[[nodiscard]] GltfCase makeGltf(Dice& dice);

/// Changes one value somewhere in the document: takes it out, doubles it, or puts another in its place.
/// \return what it did, for messages.
std::string mutateGltf(nlohmann::json& document, Dice& dice);

/// Writes it and its buffer. \return its path.
std::filesystem::path writeGltf(const GltfCase& gltf, const TemporaryFolder& folder, const std::string& name);

}  // namespace relief::test

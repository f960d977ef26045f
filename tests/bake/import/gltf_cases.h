// SPDX-License-Identifier: Apache-2.0
// glTF files as a document and a buffer, and mutations of them.
#pragma once

#include <cstdint>
#include <filesystem>
#include <nlohmann/json.hpp>
#include <string>

#include "tests/bake/meshes.h"

namespace relief::test {

/// A portable random number generator.
class Dice {
  public:
    explicit Dice(std::uint64_t seed) : state_(seed) {}
    /// 0 … sides − 1.
    std::uint64_t roll(std::uint64_t sides);
    bool once(std::uint64_t in) { return roll(in) == 0; }

  private:
    std::uint64_t state_;
};

enum class GltfContainer { kBinary, kDataUri, kFileBeside };

struct GltfCase {
    nlohmann::json document;
    std::string buffer;
    GltfContainer container = GltfContainer::kBinary;
};

/// Changes one value of the document: removes, duplicates or replaces it.
/// \return a description of the change, for messages
std::string mutateGltf(nlohmann::json& document, Dice& dice);

/// Writes the document and its buffer. \return the path
std::filesystem::path writeGltf(const GltfCase& gltf, const TemporaryFolder& folder, const std::string& name);

}  // namespace relief::test

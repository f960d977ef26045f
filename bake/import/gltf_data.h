// SPDX-License-Identifier: Apache-2.0
// The bytes of a glTF file, and the numbers in them: the chunks of a GLB, the buffers in it, in the JSON or beside it, and
// accessors, sparse and quantised ones too. Errors name a place in the document, and no file.
#pragma once

#include <cstddef>
#include <cstdint>
#include <glm/vec3.hpp>
#include <map>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "bake/import/gltf_json.h"
#include "bake/import/import_files.h"
#include "formats/base/result.h"

namespace relief {

/// The contents of a file, borrowed.
struct GltfChunks {
    std::string_view json;
    std::optional<std::span<const std::byte>> binary;  ///< of a GLB
    std::vector<std::string> warnings;                 ///< without the file's name
};

/// Takes a GLB apart; any other file is JSON. Errors: kInvalidInput, kUnsupported (another version).
[[nodiscard]] Result<GltfChunks> gltfChunks(std::span<const std::byte> bytes);

/// A file, taken apart and parsed; borrows its bytes.
struct GltfDocument {
    GltfChunks chunks;
    std::shared_ptr<const nlohmann::json> json;  ///< an object
};
/// Errors: those of gltfChunks and parseGltfJson.
[[nodiscard]] Result<GltfDocument> openGltf(std::span<const std::byte> bytes);

/// The bytes that a data URI holds. \param uri  "data:…". Errors, without a place: kInvalidInput.
[[nodiscard]] Result<std::vector<std::byte>> dataUriBytes(std::string_view uri);

/// Of a bufferView.
struct GltfView {
    std::span<const std::byte> bytes;
    std::optional<std::uint64_t> stride;  ///< bytes, more than 0
};

/// Buffers are read, and compressed views unpacked, when a view is first used.
class GltfBuffers {
  public:
    /// All is borrowed.
    GltfBuffers(const GltfChunks& chunks, ImportFiles& files) : chunks_(chunks), files_(files) {}

    /// The view that `from` names by its bufferView. Errors: kInvalidInput, kUnsupported (a compression).
    [[nodiscard]] Result<GltfView> view(const GltfValue& from);

  private:
    [[nodiscard]] Result<std::span<const std::byte>> part(const GltfValue& place);
    [[nodiscard]] Result<std::vector<std::byte>> read(const std::string& uri);

    const GltfChunks& chunks_;
    ImportFiles& files_;
    std::map<std::uint64_t, std::vector<std::byte>> read_;      // buffers
    std::map<std::uint64_t, std::vector<std::byte>> unpacked_;  // views (EXT_meshopt_compression)
};

enum class GltfUse : std::uint8_t {
    kPositions,  ///< glm::vec3, of floats or whole numbers of 8 or 16 bits (KHR_mesh_quantization)
    kIndices,    ///< std::uint32_t
    kJoints,     ///< glm::vec4 of whole numbers
    kWeights,    ///< glm::vec4
    kMatrices,   ///< glm::mat4
    kVectors,    ///< glm::vec3 of floats
    kRotations,  ///< glm::vec4: of floats, or normalized whole numbers of 8 or 16 bits
    kDeltas,     ///< as positions; those of an accessor without data are 0
    kTimes,      ///< float
    kMorphs,     ///< float, or normalized whole numbers of 8 or 16 bits
};

/// The elements of an accessor. Floats may be no numbers.
/// \tparam T  of the use. \param count_max  more is an error. Errors: kInvalidInput, kUnsupported, kLimit.
template <class T>
[[nodiscard]] Result<std::vector<T>> readAccessor(const GltfValue& accessor, GltfUse use,
                                                  GltfBuffers& buffers, std::uint64_t count_max);

}  // namespace relief

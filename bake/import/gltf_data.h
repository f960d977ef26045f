// SPDX-License-Identifier: Apache-2.0
// Reads the binary data of a glTF file: GLB chunks, buffers (embedded, as data URIs, or in separate files), and
// accessors, including sparse and quantized ones. Errors name the place in the document, not the file.
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

/// The chunks of a file, borrowed.
struct GltfChunks {
    std::string_view json;
    std::optional<std::span<const std::byte>> binary;  ///< the BIN chunk of a GLB
    std::vector<std::string> warnings;                 ///< without the file name
};

/// Splits a GLB into its chunks; any other file is JSON. Errors: kInvalidInput, kUnsupported (another GLB version).
[[nodiscard]] Result<GltfChunks> gltfChunks(std::span<const std::byte> bytes);

/// A parsed file; borrows its bytes.
struct GltfDocument {
    GltfChunks chunks;
    std::shared_ptr<const nlohmann::json> json;  ///< always an object
};
/// Splits and parses a file. Errors: those of gltfChunks and parseGltfJson.
[[nodiscard]] Result<GltfDocument> openGltf(std::span<const std::byte> bytes);

/// Decodes a data URI.
/// \param uri  "data:…".
/// Errors, without a place: kInvalidInput.
[[nodiscard]] Result<std::vector<std::byte>> dataUriBytes(std::string_view uri);

/// The bytes of a bufferView.
struct GltfView {
    std::span<const std::byte> bytes;
    std::optional<std::uint64_t> stride;  ///< bytes between elements, above 0
};

/// Reads buffers and unpacks compressed views on first use.
class GltfBuffers {
  public:
    /// Borrows both arguments.
    GltfBuffers(const GltfChunks& chunks, ImportFiles& files) : chunks_(chunks), files_(files) {}

    /// Returns the view that the member `bufferView` of `from` references. Errors: kInvalidInput, kUnsupported (a
    /// compression).
    [[nodiscard]] Result<GltfView> view(const GltfValue& from);

  private:
    [[nodiscard]] Result<std::span<const std::byte>> part(const GltfValue& place);
    [[nodiscard]] Result<std::vector<std::byte>> read(const std::string& uri);

    const GltfChunks& chunks_;
    ImportFiles& files_;
    std::map<std::uint64_t, std::vector<std::byte>> read_;      // by buffer index
    std::map<std::uint64_t, std::vector<std::byte>> unpacked_;  // by view index (EXT_meshopt_compression)
};

enum class GltfUse : std::uint8_t {
    kPositions,  ///< glm::vec3, from floats or 8- or 16-bit integers (KHR_mesh_quantization)
    kIndices,    ///< std::uint32_t
    kJoints,     ///< glm::vec4, from integers
    kWeights,    ///< glm::vec4
    kMatrices,   ///< glm::mat4
    kVectors,    ///< glm::vec3, from floats
    kRotations,  ///< glm::vec4, from floats or normalized 8- or 16-bit integers
    kDeltas,     ///< as kPositions; 0 for an accessor without data
    kTimes,      ///< float
    kMorphs,     ///< float, or normalized 8- or 16-bit integers
};

/// Reads the elements of an accessor. Floats may be NaN or infinite.
/// \tparam T  the type listed for `use`.
/// \param count_max  more elements are an error.
/// Errors: kInvalidInput, kUnsupported, kLimit.
template <class T>
[[nodiscard]] Result<std::vector<T>> readAccessor(const GltfValue& accessor, GltfUse use,
                                                  GltfBuffers& buffers, std::uint64_t count_max);

}  // namespace relief

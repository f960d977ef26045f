// SPDX-License-Identifier: Apache-2.0
// Reads the JSON and the binary data of a glTF file. JSON is parsed strictly, into values that track their position.
// Binary data are GLB chunks, buffers (embedded, as data URIs, or in separate files), and accessors, including sparse,
// quantized and compressed ones. Errors name the place in the document, such as "meshes[0].primitives[2].mode", not the
// file.
#pragma once

#include <cstddef>
#include <cstdint>
#include <glm/vec3.hpp>
#include <map>
#include <memory>
#include <nlohmann/json_fwd.hpp>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "bake/import/import_files.h"
#include "formats/base/result.h"

namespace relief {

/// Parses like parseStrictJson(), but accepts trailing spaces and zero bytes.
[[nodiscard]] Result<nlohmann::json> parseGltfJson(std::string_view text);

/// An object of the document. A member of the wrong type, including null, is an error (kInvalidInput).
class GltfValue {
  public:
    /// Borrows the document. \param document  an object.
    explicit GltfValue(const nlohmann::json& document) : document_(&document), json_(&document) {}

    /// Returns the error "PATH WHAT".
    [[nodiscard]] tl::unexpected<Error> wrong(const std::string& what,
                                              ErrorCode code = ErrorCode::kInvalidInput) const;

    [[nodiscard]] bool has(const char* name) const;
    [[nodiscard]] std::uint64_t index() const { return index_; }

    /// Reads a member; nullopt if it is missing. T is bool, std::uint64_t, std::string, or a vector of one of these or
    /// of float.
    template <class T>
    [[nodiscard]] Result<std::optional<T>> get(const char* name) const;
    /// Reads a member, or returns `otherwise` if it is missing.
    template <class T>
    [[nodiscard]] Result<T> get(const char* name, T otherwise) const {
        return RELIEF_TRY(get<T>(name)).value_or(std::move(otherwise));
    }
    [[nodiscard]] Result<std::uint64_t> number(const char* name) const;
    /// Reads a list of exactly `count` numbers; empty if it is missing.
    [[nodiscard]] Result<std::vector<float>> numbers(const char* name, std::size_t count) const;

    [[nodiscard]] Result<std::optional<GltfValue>> object(const char* name) const;
    /// Reads a list of objects; empty if it is missing.
    [[nodiscard]] Result<std::vector<GltfValue>> objects(const char* name) const;
    /// Resolves the index in `member` to an object of the document's `list`; nullopt if the member is missing.
    [[nodiscard]] Result<std::optional<GltfValue>> named(const char* member, const char* list) const;
    /// Like named(), but fails if the member is missing.
    [[nodiscard]] Result<GltfValue> needed(const char* member, const char* list) const;
    /// Returns entry `index` of the document's `list`. \param member  the member that holds the index, for messages.
    [[nodiscard]] Result<GltfValue> at(std::uint64_t index, const char* list, const char* member) const;

  private:
    [[nodiscard]] std::string pathOf(const char* name) const;
    [[nodiscard]] Result<GltfValue> child(const nlohmann::json& json, std::string path,
                                          std::uint64_t index = 0) const;

    const nlohmann::json* document_;
    const nlohmann::json* json_;
    std::string path_;  // "" for the document itself
    std::uint64_t index_ = 0;
};

/// The chunks of a file, borrowed.
struct GltfChunks {
    std::string_view json;
    std::optional<std::span<const std::byte>> binary;  ///< the BIN chunk of a GLB
    std::vector<std::string> warnings;                 ///< without the file name
};

/// A parsed file; borrows its bytes.
struct GltfDocument {
    GltfChunks chunks;
    std::shared_ptr<const nlohmann::json> json;  ///< always an object
};
/// Splits and parses a file. Errors: those of parseGltfJson; kInvalidInput, kUnsupported (another GLB version).
[[nodiscard]] Result<GltfDocument> openGltf(std::span<const std::byte> bytes);

/// Decodes a data URI.
/// \param uri  "data:…".
/// Errors, without a place in the document: kInvalidInput.
[[nodiscard]] Result<std::vector<std::byte>> dataUriBytes(std::string_view uri);

struct GltfView {
    std::span<const std::byte> bytes;
    std::optional<std::uint64_t> stride;  ///< bytes between elements, above 0
};

/// Reads buffers and unpacks compressed views on first use.
class GltfBuffers {
  public:
    /// Borrows both arguments.
    GltfBuffers(const GltfChunks& chunks, ImportFiles& files) : chunks_(chunks), files_(files) {}

    /// Returns the view that the member `bufferView` of `from` references. Errors: kInvalidInput, kUnsupported (another
    /// compression, or those of unpackMeshopt()).
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

/// Decompresses a buffer view.
/// \param extension  the extension object of the buffer view.
/// \param packed     the bytes that `extension` references; untrusted.
/// \param size       bytes of the unpacked view.
/// Errors: kInvalidInput, kUnsupported (a mode or filter).
[[nodiscard]] Result<std::vector<std::byte>> unpackMeshopt(const GltfValue& extension,
                                                           std::span<const std::byte> packed,
                                                           std::uint64_t size);

}  // namespace relief

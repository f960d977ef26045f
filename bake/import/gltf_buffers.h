// The bytes of a glTF file: the chunks of a GLB, and the buffers, in it, in the JSON or beside it. Errors name a place in
// the document, and no file.
#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "bake/import/gltf_json.h"
#include "bake/import/import_files.h"
#include "formats/base/result.h"

namespace relief {

/// What a file holds, borrowed.
struct GltfChunks {
    std::string_view json;
    std::optional<std::span<const std::byte>> binary;  ///< of a GLB
    std::vector<std::string> warnings;                 ///< without the file's name
};

/// Takes a GLB apart; any other file is JSON. Errors: kInvalidInput, kUnsupported (another version).
[[nodiscard]] Result<GltfChunks> gltfChunks(std::span<const std::byte> bytes);

/// The bytes that a data URI holds. \param uri  "data:…". Errors, without a place: kInvalidInput, kUnsupported.
[[nodiscard]] Result<std::vector<std::byte>> dataUriBytes(std::string_view uri);

/// The path that a relative reference means: "a%20b.bin" -> "a b.bin". Errors, without a place: kInvalidInput.
[[nodiscard]] Result<std::string> uriPath(std::string_view uri);

/// Of a bufferView.
struct GltfView {
    std::span<const std::byte> bytes;
    std::optional<std::uint64_t> stride;  ///< bytes, more than 0
};

/// Buffers are read when a view of theirs is asked for.
class GltfBuffers {
  public:
    /// Looks through all buffers and views. All arguments are borrowed. Errors: kInvalidInput.
    [[nodiscard]] static Result<GltfBuffers> open(const GltfValue& document, const GltfChunks& chunks,
                                                  ImportFiles& files);

    /// The view that `from` names by its bufferView. Errors: kInvalidInput, kUnsupported (it is compressed).
    [[nodiscard]] Result<GltfView> view(const GltfValue& from);

  private:
    struct Buffer {
        std::uint64_t length = 0;  // as declared
        bool loaded = false;
        std::vector<std::byte> owned;
        std::span<const std::byte> bytes;
    };
    struct View {
        std::uint64_t buffer = 0;
        std::uint64_t offset = 0;
        std::uint64_t length = 0;
        std::optional<std::uint64_t> stride;
        bool compressed = false;
    };

    GltfBuffers(GltfList buffers, const GltfChunks& chunks, ImportFiles& files)
        : list_(buffers), chunks_(&chunks), files_(&files) {}
    Result<void> readBuffers();
    Result<void> readViews(const GltfList& views);
    Result<void> load(std::uint64_t index);
    Result<void> loadFile(Buffer& buffer, const GltfValue& place, const std::string& uri);

    GltfList list_;
    const GltfChunks* chunks_;
    ImportFiles* files_;
    std::vector<Buffer> buffers_;
    std::vector<View> views_;
};

}  // namespace relief

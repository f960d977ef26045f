// SPDX-License-Identifier: Apache-2.0
// A tetrahedron with corners at the origin and at 1, 2 and 3 along x, y and z, as text in several mesh formats. Every
// rotation, mirroring or scale changes its bounds. Also helpers shared by import tests.
#pragma once

#include <gtest/gtest.h>

#include <functional>
#include <string>
#include <string_view>
#include <vector>

#include "bake/import/mesh_import.h"

#include "tests/results.h"

namespace relief::test {

[[nodiscard]] std::string tetrahedronObj();
[[nodiscard]] std::string tetrahedronPly();
[[nodiscard]] std::string tetrahedronOff();
[[nodiscard]] std::string tetrahedronStl();
[[nodiscard]] std::string tetrahedronBinaryStl(const std::string& header);
/// \param master_scale  1 means none
[[nodiscard]] std::string tetrahedron3ds(float master_scale = 1.0F);
/// \param asset  the elements <unit> and <up_axis>, or empty
[[nodiscard]] std::string tetrahedronDae(const std::string& asset);
/// \param up    0, 1 or 2 for x, y or z. \param sign  1 or -1. \param unit  in centimetres
[[nodiscard]] std::string tetrahedronFbx(int up, int sign, const std::string& unit);

/// JSON fragments of a glTF file with the tetrahedron.
struct GltfParts {
    std::string nodes = R"({"mesh":0})";
    std::string roots = "0";
    std::string primitive = R"("attributes":{"POSITION":0},"indices":1)";
    std::string position = R"("bufferView":0,"componentType":5126,"count":4,"type":"VEC3")";
    std::string indices = R"("bufferView":1,"componentType":5123,"count":12,"type":"SCALAR")";
    std::string more{};  ///< members of the document, each followed by a comma
    std::string uri{};   ///< of the buffer; default: a data URI
};
[[nodiscard]] std::string tetrahedronGltf(const GltfParts& parts = {});
/// JSON of this many nodes with the tetrahedron.
[[nodiscard]] std::string manyNodes(std::size_t count);
/// The 72 bytes of the tetrahedron's buffer.
[[nodiscard]] std::string tetrahedronBuffer();
[[nodiscard]] std::string base64(std::string_view bytes);

/// Replaces every `from`, which must occur.
[[nodiscard]] std::string replaced(std::string text, const std::string& from, const std::string& to);

/// Imports the only file of a folder, with this name and contents: in this process, or in a worker.
[[nodiscard]] Result<TriangleMesh> importText(const std::string& name, std::string_view contents,
                                              const ImportOptions& options = {});
[[nodiscard]] Result<TriangleMesh> importTextInWorker(const std::string& name, std::string_view contents,
                                                      const ImportOptions& options = {});

/// Like importText(), for files that must be read.
[[nodiscard]] TriangleMesh imported(const std::string& name, std::string_view contents,
                                    const ImportOptions& options = {});

/// Expects a one-line message with these words and advice.
void expectFault(const Error& error, const std::string& words, ErrorCode code = ErrorCode::kInvalidInput);
template <class T>
void expectRejected(const Result<T>& result, const std::string& words,
                    ErrorCode code = ErrorCode::kInvalidInput) {
    if (result) {
        ADD_FAILURE() << "read: " << words;
    } else {
        expectFault(result.error(), words, code);
    }
}
/// A rejected file, and words of its message.
struct Wrong {
    std::string text;
    std::string words;
    ErrorCode code = ErrorCode::kInvalidInput;
};
/// Expects each file to be rejected; its name is `name`, which the message must contain.
void expectWrong(const std::string& name, const std::vector<Wrong>& cases);
/// Applies each lie to a copy of the honest mesh, as a compromised worker could. All results must be rejected.
/// \param accepts  returns whether the reader accepts a mesh
void expectInvalidRejected(const TriangleMesh& honest,
                           const std::vector<std::function<void(TriangleMesh&)>>& lies,
                           const std::function<bool(TriangleMesh)>& accepts);
/// Whether a warning contains these words.
[[nodiscard]] bool warns(const TriangleMesh& mesh, const std::string& words);
/// Negative if triangles face inwards.
[[nodiscard]] double signedVolume(const TriangleMesh& mesh);

}  // namespace relief::test

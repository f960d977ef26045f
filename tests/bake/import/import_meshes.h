// SPDX-License-Identifier: Apache-2.0
// A tetrahedron with corners at the origin and at 1, 2 and 3 along x, y and z, as text in several mesh
// formats: no turn, mirroring or scale leaves its bounds as they are. And what tests of imports share.
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
/// \param master_scale  1 is none.
[[nodiscard]] std::string tetrahedron3ds(float master_scale = 1.0F);
/// \param asset  the elements <unit> and <up_axis>, or nothing.
[[nodiscard]] std::string tetrahedronDae(const std::string& asset);
/// \param up    0, 1 or 2 for x, y or z. \param sign  1 or -1. \param unit  in centimetres.
[[nodiscard]] std::string tetrahedronFbx(int up, int sign, const std::string& unit);

/// What a glTF file around the tetrahedron may say otherwise; each is JSON.
struct GltfParts {
    std::string nodes = R"({"mesh":0})";
    std::string roots = "0";
    std::string primitive = R"("attributes":{"POSITION":0},"indices":1)";
    std::string position = R"("bufferView":0,"componentType":5126,"count":4,"type":"VEC3")";
    std::string indices = R"("bufferView":1,"componentType":5123,"count":12,"type":"SCALAR")";
    std::string more{};  ///< members of the document, each followed by a comma
    std::string uri{};   ///< of the buffer; the bytes themselves by default
};
[[nodiscard]] std::string tetrahedronGltf(const GltfParts& parts = {});
/// The tetrahedron in so many nodes.
[[nodiscard]] std::string manyNodes(std::size_t count);
/// The 72 bytes of its buffer.
[[nodiscard]] std::string tetrahedronBuffer();
[[nodiscard]] std::string base64(std::string_view bytes);

/// Text with every `from` replaced, of which there must be one.
[[nodiscard]] std::string replaced(std::string text, const std::string& from, const std::string& to);

/// Imports a file of this name and contents, which is alone in its folder: in this process, or by a worker.
[[nodiscard]] Result<TriangleMesh> importText(const std::string& name, std::string_view contents,
                                              const ImportOptions& options = {});
[[nodiscard]] Result<TriangleMesh> importTextInWorker(const std::string& name, std::string_view contents,
                                                      const ImportOptions& options = {});

/// By importText; it must be read.
[[nodiscard]] TriangleMesh imported(const std::string& name, std::string_view contents,
                                    const ImportOptions& options = {});

/// Of one line, with a cure, which holds these words.
void expectFault(const Error& error, const std::string& words, ErrorCode code = ErrorCode::kInvalidInput);
template <class T>
void expectRefused(const Result<T>& result, const std::string& words,
                   ErrorCode code = ErrorCode::kInvalidInput) {
    if (result) {
        ADD_FAILURE() << "read: " << words;
    } else {
        expectFault(result.error(), words, code);
    }
}
/// A file that is refused, and words of its error.
struct Wrong {
    std::string text;
    std::string words;
    ErrorCode code = ErrorCode::kInvalidInput;
};
/// Files of this name, which their errors have.
void expectWrong(const std::string& name, const std::vector<Wrong>& cases);
/// Each lie makes a mesh that a compromised worker could send; none may be accepted.
/// \param accepts  returns whether the reader accepts a mesh.
void expectLiesRefused(const TriangleMesh& honest,
                       const std::vector<std::function<void(TriangleMesh&)>>& lies,
                       const std::function<bool(TriangleMesh)>& accepts);
/// Whether one of its warnings holds these words.
[[nodiscard]] bool warns(const TriangleMesh& mesh, const std::string& words);
/// Negative where triangles look inwards.
[[nodiscard]] double signedVolume(const TriangleMesh& mesh);

}  // namespace relief::test

// What the import worker hands to its parent: a mesh or an error, as bytes that the parent checks like any
// file.
//
//     u64 size of the table   u64 0   the table (import_message.fbs), padded to a multiple of 16
//     positions and triangles, 12 bytes each        marks, a byte each        labels, 4 bytes each        and no byte more
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include "bake/mesh/mesh.h"
#include "formats/base/result.h"

namespace relief {

/// A message before its arrays are written behind it.
struct ImportMessage {
    std::vector<std::byte> head;  ///< everything before the positions
    std::uint64_t size = 0;       ///< bytes of the whole message
};

/// \param raw  as importRaw gives it.
[[nodiscard]] ImportMessage makeImportMessage(const Result<TriangleMesh>& raw);

/// Writes the whole message. \param target  message.size bytes.
void writeImportMessage(const ImportMessage& message, const Result<TriangleMesh>& raw,
                        std::span<std::byte> target);

/// Reads a message that may hold anything. Indices and coordinates are left to finishMesh, and what marks mean to
/// ImportSource::finish; there are none of these and of labels, or one for each triangle.
/// \param bytes  aligned to 16 bytes, and not changed meanwhile.
/// \param triangle_max  at most kTriangleMax. More, or more than thrice as many positions, are no message: nothing is
/// allocated for them.
/// \return what the worker's importRaw gave. Errors: the worker's own, as one line; kInvalidInput, saying no
/// file's name, for a message that is none.
[[nodiscard]] Result<TriangleMesh> readImportMessage(std::span<const std::byte> bytes,
                                                     std::uint64_t triangle_max = kTriangleMax);

}  // namespace relief

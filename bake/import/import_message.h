// SPDX-License-Identifier: Apache-2.0
// A mesh or an error as bytes, from the import worker to its parent, which checks them like any file: a u32 that is 0 or an
// ErrorCode; then the members of a TriangleMesh (import_message.cpp: exchange), or the error's text. A u64 precedes each text,
// list and array: its length. The byte order is the machine's.
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>

#include "bake/mesh/mesh.h"
#include "formats/base/result.h"

namespace relief {

/// \param raw  as importRaw gives it. \return bytes of its message.
[[nodiscard]] std::uint64_t importMessageSize(const Result<TriangleMesh>& raw);

/// Writes the whole message. \param target  importMessageSize(raw) bytes.
void writeImportMessage(const Result<TriangleMesh>& raw, std::span<std::byte> target);

/// Reads a message that may hold anything. Indices and coordinates are left to finishMesh, and the meaning of marks to
/// ImportSource::finish; there are none of these and of labels, or one for each triangle.
/// \param bytes  not changed meanwhile.
/// \param triangle_max  at most kTriangleMax. More, or more than thrice as many positions, are no message: nothing is
/// allocated for them.
/// \return what the worker's importRaw gave. Errors: the worker's own, as one line; kInvalidInput, without a file's name,
/// for other bytes.
[[nodiscard]] Result<TriangleMesh> readImportMessage(std::span<const std::byte> bytes,
                                                     std::uint64_t triangle_max = kTriangleMax);

}  // namespace relief

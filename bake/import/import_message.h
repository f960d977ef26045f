// SPDX-License-Identifier: Apache-2.0
// Serializes a mesh or an error from the import worker to its parent, which validates it like any file. Layout: a u32
// that is 0 or an ErrorCode, then the members of a TriangleMesh (exchange() in import_message.cpp) or the error text. A
// u64 length precedes each text, list and array. Byte order is native.
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>

#include "bake/mesh/mesh.h"
#include "formats/base/result.h"

namespace relief {

/// Returns the size of the message in bytes. \param raw  the result of importRaw.
[[nodiscard]] std::uint64_t importMessageSize(const Result<TriangleMesh>& raw);

/// Writes the whole message. \param target  importMessageSize(raw) bytes.
void writeImportMessage(const Result<TriangleMesh>& raw, std::span<std::byte> target);

/// Reads and validates an untrusted message. Marks and labels are empty or have one entry per triangle. Indices and
/// coordinates are validated by finishMesh, the meaning of marks by ImportSource::finish.
/// \param bytes         must not change during the call.
/// \param triangle_max  at most kTriangleMax. A message with more triangles, or with more than three times as many
/// positions, is rejected before allocation.
/// \return the worker's result of importRaw. Errors: the worker's error, as one line; kInvalidInput, without the file
/// name, for a malformed message.
[[nodiscard]] Result<TriangleMesh> readImportMessage(std::span<const std::byte> bytes,
                                                     std::uint64_t triangle_max = kTriangleMax);

}  // namespace relief

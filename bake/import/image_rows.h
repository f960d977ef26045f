// SPDX-License-Identifier: Apache-2.0
// Reads height map images (PNG and EXR) row by row, decoded in a worker process like meshes. Besides png_rows.cpp, only
// runtime/files/png.cpp uses libpng.
#pragma once

#include <cstddef>
#include <memory>
#include <span>

#include "bake/import/import_job.h"
#include "bake/import/sample_rows.h"
#include "formats/base/result.h"

namespace relief {

[[nodiscard]] bool isPng(std::span<const std::byte> bytes);
/// Whether the bytes start with a PNG or EXR signature.
[[nodiscard]] bool isImage(std::span<const std::byte> bytes);

/// Decodes an image in a worker (the program relief-import), sandboxed, with limits on memory and time. The worker
/// decodes a few rows ahead. Rows are untrusted.
/// \param image  sharedBytes() of the file, borrowed during the call.
/// Errors here and when reading rows, without the file name: those of openImageRows; kInvalidInput (the importer
/// crashed), kLimit (memory, processor time or wall time exceeded), kFailure (the worker could not be started, or was
/// killed from outside).
[[nodiscard]] Result<std::unique_ptr<SampleRows>> openImageRowsInWorker(int image,
                                                                        const ImportLimits& limits);

/// Decodes an image in this process, which a hostile image may crash; defined in the library bake_assimp.
/// \param bytes  isImage(); must outlive the rows.
/// Errors, without the file name: those of openPngRows and openExrRows.
[[nodiscard]] Result<std::unique_ptr<SampleRows>> openImageRows(std::span<const std::byte> bytes);

/// Opens a PNG image. A colour that the tRNS chunk makes transparent is a hole.
/// \param bytes  untrusted; must outlive the rows.
/// Errors, without the file name: kInvalidInput (libpng's message), kUnsupported (a palette, fewer than 8 bits,
/// interlacing); reading a row also kUnsupported (red, green and blue that differ, alpha that is not opaque).
[[nodiscard]] Result<std::unique_ptr<SampleRows>> openPngRows(std::span<const std::byte> bytes);

/// Opens an EXR image.
/// \param bytes  untrusted; must outlive the rows.
/// Errors, without the file name: kInvalidInput (OpenEXR's message), kUnsupported (several channels or parts).
[[nodiscard]] Result<std::unique_ptr<SampleRows>> openExrRows(std::span<const std::byte> bytes);

}  // namespace relief

// SPDX-License-Identifier: Apache-2.0
// Images of heights row by row, PNG and EXR, decoded by a process of their own, as meshes are imported.
#pragma once

#include <cstddef>
#include <memory>
#include <span>

#include "bake/import/import_job.h"
#include "bake/import/sample_rows.h"
#include "formats/base/result.h"

namespace relief {

[[nodiscard]] bool isPng(std::span<const std::byte> bytes);
/// Whether the bytes begin as those of a PNG or an EXR do.
[[nodiscard]] bool isImage(std::span<const std::byte> bytes);

/// Decodes in a worker (the program relief-import), within limits of memory and time and without rights, a few rows ahead. Rows
/// are as untrusted as the image.
/// \param image  sharedBytes() of the file, borrowed during the call.
/// Errors, without the file's name: those of openImageRows; kInvalidInput (the importer crashed), kLimit (memory, or time that
/// was spent or waited for), kFailure (the worker could not be started, or was killed from outside); of rows, too.
[[nodiscard]] Result<std::unique_ptr<SampleRows>> openImageRowsInWorker(int image,
                                                                        const ImportLimits& limits);

/// Decodes in this process, which a hostile image may crash. In the library bake_assimp.
/// \param bytes  isImage(); must outlive the rows.
/// Errors, without the file's name: those of openPngRows and openExrRows.
[[nodiscard]] Result<std::unique_ptr<SampleRows>> openImageRows(std::span<const std::byte> bytes);

}  // namespace relief

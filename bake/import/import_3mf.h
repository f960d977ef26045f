// 3MF (core specification 1.3, and production 1.1): a ZIP archive of models, which are objects and what places them.
#pragma once

#include <cstddef>
#include <span>

#include "bake/import/import_assembly.h"
#include "formats/base/result.h"

namespace relief {

/// The scene is what the model's <build> has. Objects in other models of the archive are read where one names them.
/// Errors, without the file's name: kInvalidInput; kUnsupported (an extension that the file requires).
[[nodiscard]] Result<AssemblyFile> read3mf(std::span<const std::byte> bytes);

}  // namespace relief

// SPDX-License-Identifier: Apache-2.0
#include "bake/import/image_rows.h"

#include "bake/import/exr_rows.h"
#include "bake/import/png_rows.h"

namespace relief {

Result<std::unique_ptr<SampleRows>> openImageRows(std::span<const std::byte> bytes) {
    return isPng(bytes) ? openPngRows(bytes) : openExrRows(bytes);
}

}  // namespace relief

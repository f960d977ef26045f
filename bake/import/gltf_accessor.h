// Numbers of a glTF file: positions and indices, sparse ones and quantised ones too. Errors name a place in the document,
// and no file.
#pragma once

#include <cstdint>
#include <glm/vec3.hpp>
#include <vector>

#include "bake/import/gltf_buffers.h"
#include "bake/import/gltf_json.h"
#include "formats/base/result.h"

namespace relief {

/// Of an accessor; may be 0. Errors: kInvalidInput.
[[nodiscard]] Result<std::uint64_t> accessorCount(const GltfValue& accessor);

/// VEC3 of floats, or of whole numbers of 8 or 16 bits (KHR_mesh_quantization). May be no numbers.
/// \param count_max  more is an error. Errors: kInvalidInput, kUnsupported, kLimit.
[[nodiscard]] Result<std::vector<glm::vec3>> readPositions(const GltfValue& accessor, GltfBuffers& buffers,
                                                           std::uint64_t count_max);

/// SCALAR of unsigned whole numbers, none of them the largest of its type, which would restart a primitive.
/// \param count_max  more is an error. Errors: kInvalidInput, kUnsupported, kLimit.
[[nodiscard]] Result<std::vector<std::uint32_t>> readIndices(const GltfValue& accessor, GltfBuffers& buffers,
                                                             std::uint64_t count_max);

/// Four for each vertex, as whole numbers. Errors: kInvalidInput, kUnsupported, kLimit.
[[nodiscard]] Result<std::vector<float>> readJoints(const GltfValue& accessor, GltfBuffers& buffers,
                                                    std::uint64_t count_max);
/// Four for each vertex. May be no numbers. Errors: kInvalidInput, kUnsupported, kLimit.
[[nodiscard]] Result<std::vector<float>> readWeights(const GltfValue& accessor, GltfBuffers& buffers,
                                                     std::uint64_t count_max);
/// Sixteen for each matrix, by columns. May be no numbers. Errors: kInvalidInput, kUnsupported, kLimit.
[[nodiscard]] Result<std::vector<float>> readMatrices(const GltfValue& accessor, GltfBuffers& buffers,
                                                      std::uint64_t count_max);

}  // namespace relief

// SPDX-License-Identifier: Apache-2.0
#include "bake/import/gltf_data.h"

#include <meshoptimizer.h>

#include <string>

#include "formats/base/text.h"

namespace relief {
namespace {

/// The library checks the following limits only with assert().
constexpr std::uint64_t kStrideMax = 256;
/// Maximum compression ratio of attributes.
constexpr std::uint64_t kRatioMax = 256;

struct MeshoptPacking {
    std::string mode;
    std::string filter;
    std::uint64_t count = 0;
    std::uint64_t stride = 0;

    [[nodiscard]] bool attributes() const { return mode == "ATTRIBUTES"; }
    [[nodiscard]] bool triangles() const { return mode == "TRIANGLES"; }
};

Result<void> checkPacking(const GltfValue& extension, const MeshoptPacking& packing, std::uint64_t packed,
                          std::uint64_t size) {
    const std::uint64_t stride = packing.stride;
    if (!packing.attributes() && !packing.triangles() && packing.mode != "INDICES") {
        return extension.wrong("has the mode '" + cleanUtf8(packing.mode, 20) +
                                   "', which is not supported; export it uncompressed",
                               ErrorCode::kUnsupported);
    }
    const bool stride_fits = packing.attributes() ? stride > 0 && stride % 4 == 0 && stride <= kStrideMax
                                                  : stride == 2 || stride == 4;
    if (!stride_fits || (packing.triangles() && packing.count % 3 != 0)) {
        return extension.wrong("has a byteStride or a count that its mode, " + packing.mode +
                               ", does not allow");
    }
    // Division cannot overflow.
    if (packing.count != size / stride || size % stride != 0) {
        return extension.wrong("unpacks to a length that differs from its buffer view's");
    }
    const std::uint64_t least = packing.attributes()  ? size / kRatioMax
                                : packing.triangles() ? packing.count / 3
                                                      : packing.count;
    if (packed < least) {
        return extension.wrong("has too few bytes for its count");
    }
    const std::string& filter = packing.filter;
    if (filter != "NONE" && filter != "OCTAHEDRAL" && filter != "QUATERNION" && filter != "EXPONENTIAL") {
        return extension.wrong(
            "has the filter '" + cleanUtf8(filter, 20) + "', which is not supported; export it uncompressed",
            ErrorCode::kUnsupported);
    }
    const bool fits = filter == "OCTAHEDRAL"   ? stride == 4 || stride == 8
                      : filter == "QUATERNION" ? stride == 8
                                               : true;
    if ((filter != "NONE" && !packing.attributes()) || !fits) {
        return extension.wrong("has a filter that does not fit its mode and byteStride");
    }
    return {};
}

}  // namespace

Result<std::vector<std::byte>> unpackMeshopt(const GltfValue& extension, std::span<const std::byte> packed,
                                             std::uint64_t size) {
    MeshoptPacking packing;
    packing.mode = RELIEF_TRY(extension.get<std::string>("mode", ""));
    packing.filter = RELIEF_TRY(extension.get<std::string>("filter", "NONE"));
    packing.count = RELIEF_TRY(extension.number("count"));
    packing.stride = RELIEF_TRY(extension.number("byteStride"));
    RELIEF_TRY(checkPacking(extension, packing, packed.size(), size));
    std::vector<std::byte> bytes(size);
    const auto* const from = reinterpret_cast<const unsigned char*>(packed.data());
    const int failed =
        packing.attributes()
            ? meshopt_decodeVertexBuffer(bytes.data(), packing.count, packing.stride, from, packed.size())
        : packing.triangles()
            ? meshopt_decodeIndexBuffer(bytes.data(), packing.count, packing.stride, from, packed.size())
            : meshopt_decodeIndexSequence(bytes.data(), packing.count, packing.stride, from, packed.size());
    if (failed != 0) {
        return extension.wrong("has bytes that meshopt cannot unpack; export it again");
    }
    if (packing.filter == "OCTAHEDRAL") {
        meshopt_decodeFilterOct(bytes.data(), packing.count, packing.stride);
    } else if (packing.filter == "QUATERNION") {
        meshopt_decodeFilterQuat(bytes.data(), packing.count, packing.stride);
    } else if (packing.filter == "EXPONENTIAL") {
        meshopt_decodeFilterExp(bytes.data(), packing.count, packing.stride);
    }
    return bytes;
}

}  // namespace relief

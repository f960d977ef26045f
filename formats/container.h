// SPDX-License-Identifier: Apache-2.0
// Converts a Collider to and from the bytes of a `.relief` file. README.md in this folder specifies the layout and is
// authoritative.
#pragma once

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <span>
#include <vector>

#include "formats/base/result.h"
#include "formats/collider.h"
#include "formats/container_limits.h"

namespace relief {

struct ContainerWriteOptions {
    /// zstd level of the payloads, 1…19; 0 disables compression. Payloads that zstd does not shrink are stored
    /// uncompressed.
    int compression_level = 0;
};

/// Encodes a collider. The same collider, options and zstd version give the same bytes. Enforces the default
/// ContainerLimits.
/// Errors: kInvalidInput (violates an invariant of validate.h), kLimit, kUsage (compression level).
[[nodiscard]] Result<std::vector<std::byte>> writeContainer(const Collider& collider,
                                                            const ContainerWriteOptions& options = {});

/// Decodes untrusted bytes. Returns a collider that satisfies every invariant of validate.h, or an error that states
/// what is wrong and where. Sizes are checked against `bytes` and `limits` before any allocation.
/// Errors: kInvalidInput, kUnsupported (another major version), kLimit.
[[nodiscard]] Result<Collider> readContainer(std::span<const std::byte> bytes,
                                             const ContainerLimits& limits = {});

/// Combines readFile and readContainer; messages name the file.
[[nodiscard]] Result<Collider> loadCollider(const std::filesystem::path& path,
                                            const ContainerLimits& limits = {});
/// Combines writeContainer and writeFile.
[[nodiscard]] Result<void> saveCollider(const std::filesystem::path& path, const Collider& collider,
                                        const ContainerWriteOptions& options = {});

struct ContainerInfo {
    std::uint16_t major = 0;
    std::uint16_t minor = 0;
    std::uint64_t file_size = 0;
    std::vector<PayloadInfo> payloads;  ///< one for each map, in map order
};
/// Reads only header and metadata, with the checks of readContainer. Payloads are neither hashed nor decompressed.
[[nodiscard]] Result<ContainerInfo> readContainerInfo(std::span<const std::byte> bytes,
                                                      const ContainerLimits& limits = {});

// Detects the most common user error: a mesh given instead of a baked collider.

/// Fails with kInvalidInput if the file name has the extension of a mesh or a world. The message starts with the path:
/// "'a.obj' is a mesh, not a collider; bake it first: relief bake …".
[[nodiscard]] Result<void> rejectMeshName(const std::filesystem::path& path);

/// Likewise, but accepts any name if the first byte is that of the container signature.
[[nodiscard]] Result<void> rejectMesh(const std::filesystem::path& path, std::span<const std::byte> bytes);

}  // namespace relief

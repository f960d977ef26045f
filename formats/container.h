// SPDX-License-Identifier: Apache-2.0
// A Collider as the bytes of a `.relief` file and back. Layout: README.md beside this file, which wins where
// the two disagree.
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
    /// zstd level of the payloads, 1…19; 0 stores them as they are. A payload that zstd does not shrink is stored as it is, too.
    int compression_level = 0;
};

/// The same collider, options and zstd version give the same bytes. Keeps the default ContainerLimits.
/// Errors: kInvalidInput (an invariant of validate.h is broken), kLimit, kUsage (compression level).
[[nodiscard]] Result<std::vector<std::byte>> writeContainer(const Collider& collider,
                                                            const ContainerWriteOptions& options = {});

/// Reads untrusted bytes: whatever they are, the answer is a collider that keeps every invariant of
/// validate.h, or an error that says what is wrong and where. Nothing is allocated before its size has been
/// checked against `bytes` and `limits`.
/// Errors: kInvalidInput, kUnsupported (another major version), kLimit.
[[nodiscard]] Result<Collider> readContainer(std::span<const std::byte> bytes,
                                             const ContainerLimits& limits = {});

/// readFile and readContainer; messages name the file.
[[nodiscard]] Result<Collider> loadCollider(const std::filesystem::path& path,
                                            const ContainerLimits& limits = {});
/// writeContainer and writeFile.
[[nodiscard]] Result<void> saveCollider(const std::filesystem::path& path, const Collider& collider,
                                        const ContainerWriteOptions& options = {});

struct ContainerInfo {
    std::uint16_t major = 0;
    std::uint16_t minor = 0;
    std::uint64_t file_size = 0;
    std::vector<PayloadInfo> payloads;  ///< one a map, in the maps' order
};
/// Header and metadata alone, checked like readContainer's; payloads are neither hashed nor decompressed.
[[nodiscard]] Result<ContainerInfo> readContainerInfo(std::span<const std::byte> bytes,
                                                      const ContainerLimits& limits = {});

// A mesh where a baked collider is needed: the commonest mix-up, and its cure.

/// Fails with kInvalidInput if the name is that of a mesh: "it is a mesh; bake it first: relief bake …", the path in
/// front.
[[nodiscard]] Result<void> refuseMeshName(const std::filesystem::path& path);

/// The same, unless the contents begin as a container does, whatever its name.
[[nodiscard]] Result<void> refuseMesh(const std::filesystem::path& path, std::span<const std::byte> bytes);

}  // namespace relief

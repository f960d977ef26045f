// SPDX-License-Identifier: Apache-2.0
// Reports all problems of a container as numbered issues. readContainer rejects a file at any error; inspection
// continues with everything that is still readable, adds warnings, and reports which sections can be trusted.
// README.md in this folder, "Validation", lists the codes; their meaning never changes.
#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>
#include <vector>

#include "formats/base/result.h"
#include "formats/collider.h"
#include "formats/container_limits.h"
#include "formats/issue.h"

namespace relief {

struct MapInspection {
    PartState state = PartState::kUnreadable;
    std::optional<DepthMap> frame;  ///< without texels; set if valid
    std::optional<PayloadInfo> payload;
    /// Fraction of texels with a surface (at least one in front-back maps), 0…1; 1 for patches.
    /// Set if the texels are valid.
    std::optional<double> coverage;
};

struct Inspection {
    std::vector<Issue> issues;  ///< in file order
    PartState header = PartState::kUnreadable;
    PartState metadata = PartState::kUnreadable;
    std::vector<MapInspection> maps;  ///< as many as the metadata lists, valid or not
    std::uint64_t file_size = 0;      ///< actual size in bytes
    std::uint16_t major = 0;          ///< 0 if the header is unreadable; likewise `minor`
    std::uint16_t minor = 0;

    [[nodiscard]] std::size_t count(Severity severity) const;
    /// Returns whether readContainer rejects the file.
    [[nodiscard]] bool damaged() const;
    /// Returns kUnsupported for another major version, kLimit if every error is an exceeded limit, else kInvalidInput.
    [[nodiscard]] ErrorCode errorCode() const;
};

/// Checks every byte. Uses about as much memory as readContainer.
/// Errors: kLimit if the collider does not fit into memory.
[[nodiscard]] Result<Inspection> inspectContainer(std::span<const std::byte> bytes,
                                                  const ContainerLimits& limits = {});

}  // namespace relief

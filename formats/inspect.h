// SPDX-License-Identifier: Apache-2.0
// All that is wrong with a container, as numbered issues. readContainer refuses a file with any error; this goes on
// with whatever can still be read, adds suspicions, and names the parts of the file that may be trusted. README.md
// beside this file, "Issues", lists the codes; they keep their meaning from version to version.
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
    std::optional<DepthMap> frame;  ///< without texels; set where it is valid
    std::optional<PayloadInfo> payload;
    /// The share of texels that hold a surface (a front-back map's: at least one), 0…1. Set where the texels
    /// were read.
    std::optional<double> coverage;
};

struct Inspection {
    std::vector<Issue> issues;  ///< in the order of the file
    PartState header = PartState::kUnreadable;
    PartState metadata = PartState::kUnreadable;
    std::vector<MapInspection> maps;  ///< as many as the metadata has, believed or not
    std::uint64_t file_size = 0;      ///< bytes that there are
    std::uint16_t major = 0;          ///< 0 where the header is unreadable, as is `minor`
    std::uint16_t minor = 0;

    [[nodiscard]] std::size_t count(Severity severity) const;
    /// Whether readContainer refuses the file.
    [[nodiscard]] bool damaged() const;
    /// kInvalidInput; kUnsupported for another major version, kLimit if limits are all that is wrong.
    [[nodiscard]] ErrorCode errorCode() const;
};

/// Looks at every byte. Takes about as much memory as readContainer does.
/// Errors: kLimit, where even that does not fit into memory.
[[nodiscard]] Result<Inspection> inspectContainer(std::span<const std::byte> bytes,
                                                  const ContainerLimits& limits = {});

}  // namespace relief

// SPDX-License-Identifier: Apache-2.0
// The report of `relief bake --json`.
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "bake/pipeline/bake.h"
#include "bake/report/bake_report.h"
#include "bake/report/collider_report.h"
#include "bake/report/parts_report.h"

namespace relief {

/// `relief bake --json`
struct BakeJson {
    const BakeResult& result = kNone<BakeResult>;
    const ContainerInfo& info = kNone<ContainerInfo>;
    std::string output = {};     ///< as on the command line
    std::uint32_t compress = 0;  ///< level of zstd

    [[nodiscard]] ColliderReport<BakedMapReport> collider() const {
        const Baked& baked = result.baked;
        ColliderReport<BakedMapReport> report{
            baked.collider, info, {}, result.animated ? &*result.animated : nullptr};
        for (std::size_t i = 0; i < baked.collider.maps.size(); ++i) {
            report.maps.push_back({{i, baked.collider.maps[i], info.payloads[i]}, baked.report.maps[i]});
        }
        return report;
    }
};

void fields(FieldVisitor& visit, const BakeJson& report);

}  // namespace relief

// SPDX-License-Identifier: Apache-2.0
// Point lists of an emitter (PLY or text) and of `relief query`.
#include <cmath>
#include <string_view>

#include "bake/report/points_csv.h"
#include "runtime/births/point_list.h"
#include "tests/fuzz/target.h"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
    const auto bytes = std::as_bytes(std::span(data, size));
    if (const auto list = relief::parsePointList(bytes, "points.ply")) {
        mustHold(!list->positions.empty(), "a list has points");
        mustHold(list->normals.empty() || list->normals.size() == list->positions.size(),
                 "one normal per point");
        for (const glm::vec3& p : list->positions) {
            for (int k = 0; k < 3; ++k) {
                mustHold(std::abs(p[k]) <= static_cast<float>(relief::kPointCoordinateMax), "in range");
            }
        }
    } else {
        mustHold(list.error().message.starts_with("points.ply"), "an error names the file");
        mustBeLine(list.error().message);
    }
    const std::string_view text(reinterpret_cast<const char*>(data), size);
    if (const auto points = relief::parsePoints(text, "points.csv"); !points) {
        mustHold(points.error().message.starts_with("points.csv"), "an error names the file");
        mustBeLine(points.error().message);
    }
    return 0;
}

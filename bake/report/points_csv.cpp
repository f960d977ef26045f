// SPDX-License-Identifier: Apache-2.0
#include "bake/report/points_csv.h"

#include <algorithm>
#include <optional>

#include "formats/base/text.h"
#include "formats/base/text_scanner.h"

namespace relief {
namespace {

constexpr std::size_t kQuotedMax = 40;  // maximum bytes of an invalid line that its message quotes

/// Whether a first line is a header: three fields, none of which looks like a number.
bool isHeader(std::span<const std::string_view> fields) {
    return fields.size() == 3 && std::ranges::none_of(fields, [](std::string_view field) {
               return field.empty() || field.find_first_of("+-.0123456789") == 0 || field == "nan" ||
                      field == "inf";
           });
}

std::optional<glm::vec3> parsePoint(std::span<const std::string_view> fields) {
    if (fields.size() != 3) {
        return std::nullopt;
    }
    glm::vec3 point;
    for (int i = 0; i < 3; ++i) {
        const std::optional<float> value = parseFloat(fields[static_cast<std::size_t>(i)]);
        if (!value) {
            return std::nullopt;
        }
        point[i] = *value;
    }
    return point;
}

}  // namespace

Result<std::vector<glm::vec3>> parsePoints(std::string_view text, const std::string& name) {
    std::vector<glm::vec3> points;
    CsvReader reader(text);
    bool header_allowed = true;
    while (reader.next()) {
        if (const std::optional<glm::vec3> point = parsePoint(reader.fields())) {
            points.push_back(*point);
        } else if (!header_allowed || !isHeader(reader.fields())) {
            const std::string_view line = reader.line();
            return invalidInput(
                name + ":" + std::to_string(reader.number()) + ": '" + cleanUtf8(line.substr(0, kQuotedMax)) +
                (line.size() > kQuotedMax ? "…" : "") + "' is not a point; write three finite numbers x,y,z");
        }
        header_allowed = false;
    }
    return points;
}

std::string formatSamples(std::span<const glm::vec3> points, std::span<const FieldSample> samples,
                          std::string_view decides) {
    std::string text = "x,y,z,f,nx,ny,nz," + std::string(decides) + "\n";
    const auto addVector = [&](const glm::vec3& v) {
        for (int i = 0; i < 3; ++i) {
            appendShortest(text, v[i]);
            text += ',';
        }
    };
    for (std::size_t i = 0; i < points.size(); ++i) {
        addVector(points[i]);
        const FieldSample& sample = samples[i];
        if (sample.map < 0) {
            text += ",,,,\n";
            continue;
        }
        if (sample.distance >= kFarOutside) {
            text += "inf";
        } else {
            appendShortest(text, sample.distance);
        }
        text += ',';
        addVector(sample.normal);
        text += std::to_string(sample.map);
        text += '\n';
    }
    return text;
}

}  // namespace relief

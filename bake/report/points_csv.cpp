#include "bake/report/points_csv.h"

#include <algorithm>
#include <optional>

#include "formats/base/text.h"

namespace relief {
namespace {

constexpr std::size_t kQuotedMax = 40;  // bytes of a bad line shown in its message

bool startsLikeANumber(std::string_view field) {
    return !field.empty() &&
           (field[0] == '+' || field[0] == '-' || field[0] == '.' || (field[0] >= '0' && field[0] <= '9'));
}

/// A first line of words: three fields, none of which is meant as a number.
bool isHeader(const std::vector<std::string_view>& fields) {
    return fields.size() == 3 && std::none_of(fields.begin(), fields.end(), [](std::string_view field) {
               const std::string_view word = trimmed(field);
               return word.empty() || startsLikeANumber(word) || word == "nan" || word == "inf";
           });
}

std::optional<glm::vec3> parsePoint(const std::vector<std::string_view>& fields) {
    if (fields.size() != 3) {
        return std::nullopt;
    }
    glm::vec3 point;
    for (int i = 0; i < 3; ++i) {
        const std::optional<float> value = parseFloat(trimmed(fields[static_cast<std::size_t>(i)]));
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
    if (text.starts_with("\xef\xbb\xbf")) {
        text.remove_prefix(3);
    }
    bool header_allowed = true;
    for (std::size_t number = 1; !text.empty(); ++number) {
        const std::size_t end = text.find('\n');
        const std::string_view line = trimmed(text.substr(0, end));
        text.remove_prefix(end == std::string_view::npos ? text.size() : end + 1);
        if (line.empty() || line[0] == '#') {
            continue;
        }
        // Not split() at once: a hostile line could have millions of commas.
        const bool too_many = std::count(line.begin(), line.end(), ',') > 2;
        const std::vector<std::string_view> fields =
            too_many ? std::vector<std::string_view>() : split(line, ',');
        if (const std::optional<glm::vec3> point = parsePoint(fields)) {
            points.push_back(*point);
        } else if (!header_allowed || !isHeader(fields)) {
            const bool cut = line.size() > kQuotedMax;
            return fail(ErrorCode::kInvalidInput,
                        name + ":" + std::to_string(number) + ": '" + cleanUtf8(line.substr(0, kQuotedMax)) +
                            (cut ? "…" : "") + "' is no point; write three finite numbers x,y,z");
        }
        header_allowed = false;
    }
    return points;
}

std::string formatSamples(std::span<const glm::vec3> points, std::span<const FieldSample> samples) {
    std::string text = "x,y,z,f,nx,ny,nz,map\n";
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

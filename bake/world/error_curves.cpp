// SPDX-License-Identifier: Apache-2.0
#include "bake/world/error_curves.h"

#include <cmath>

#include "bake/recipe/bake_cache.h"
#include "formats/base/file_io.h"
#include "formats/base/text.h"
#include "formats/fields/json_value.h"
#include "formats/fields/strict_json.h"

namespace relief {
namespace {

namespace fs = std::filesystem;

constexpr const char* kFormat = "relief-curves";
constexpr int kVersion = 1;
constexpr JsonLimits kLimits{.depth = 3, .values = 8'000'000};

/// \return nullopt if the values are not a curve.
template <class Values>
std::optional<ErrorCurve> curveOf(const Values& values) {
    if (!values.is_array() || values.empty() || values.size() % 2 != 0) {
        return std::nullopt;
    }
    ErrorCurve curve;
    for (std::size_t i = 0; i < values.size(); i += 2) {
        if (!values[i].is_number() || !values[i + 1].is_number()) {
            return std::nullopt;
        }
        const ErrorPoint point{values[i].template get<double>(), values[i + 1].template get<double>()};
        const bool first = curve.empty();
        if (!(point.bytes > (first ? 0.0 : curve.back().bytes)) || !(point.wrong >= 0.0) ||
            !std::isfinite(point.bytes) || !std::isfinite(point.wrong) ||
            (!first && point.wrong >= curve.back().wrong)) {
            return std::nullopt;
        }
        curve.push_back(point);
    }
    return curve;
}

}  // namespace

Result<ErrorCurves> parseErrorCurves(std::string_view text) {
    const auto json = RELIEF_TRY(parseStrictJson(text, kLimits));
    const auto member = [&](const char* name) { return json.is_object() ? json.find(name) : json.end(); };
    const auto format = member("format");
    const auto version = member("version");
    const auto curves = member("curves");
    if (format == json.end() || *format != kFormat || version == json.end() || *version != kVersion ||
        curves == json.end() || !curves->is_object()) {
        return invalidInput("it is not a file of error curves, or has an unsupported version");
    }
    ErrorCurves all;
    for (const auto& [key, values] : curves->items()) {
        std::optional<ErrorCurve> curve = curveOf(values);
        if (!curve) {
            return invalidInput("it contains a curve that does not decrease");
        }
        all.emplace(key, std::move(*curve));
    }
    return all;
}

std::string errorCurvesText(const ErrorCurves& curves) {
    Json by_key = Json::object();
    for (const auto& [key, curve] : curves) {
        Json values = Json::array();
        for (const ErrorPoint& point : curve) {
            values.push_back(point.bytes);
            values.push_back(point.wrong);
        }
        by_key[key] = std::move(values);
    }
    return jsonLine({{"format", kFormat}, {"version", kVersion}, {"curves", std::move(by_key)}});
}

Result<ErrorCurves> loadErrorCurves(const fs::path& folder) {
    const fs::path path = folder / kErrorCurvesName;
    const auto bytes = RELIEF_TRY(readCacheFile(path));
    return bytes ? withPrefix(quotedPath(path), parseErrorCurves(textOf(*bytes))) : ErrorCurves{};
}

Result<void> saveErrorCurves(const fs::path& folder, const ErrorCurves& curves) {
    return writeCacheFile(folder / kErrorCurvesName, errorCurvesText(curves));
}

}  // namespace relief

#include "bake/report/accuracy_report.h"

#include <cstdio>
#include <nlohmann/json.hpp>

#include "bake/report/report.h"

namespace relief {
namespace {

using Json = nlohmann::ordered_json;

std::string percentText(double value) {
    return shortNumber(value) + " %";
}

}  // namespace

std::string shortNumber(double value) {
    char text[32];
    std::snprintf(text, sizeof(text), "%.4g", value);
    return text;
}

std::string roughly(double value) {
    char text[32];
    std::snprintf(text, sizeof(text), value >= 99.5 ? "%.3g" : "%.2g", value);
    return text;
}

std::string lengthText(double value, const std::string& unit) {
    return roughly(value) + (unit.empty() ? "" : " " + unit);
}

Json jsonWrong(const WrongShare& share) {
    return {{"wrong_percent", share.total()},
            {"false_inside_percent", share.false_inside},
            {"false_outside_percent", share.false_outside}};
}

Json jsonFieldAccuracy(const FieldAccuracy& accuracy, double longest_side) {
    const double to_percent = 100.0 / longest_side;
    return {{"near", jsonWrong(accuracy.near)},
            {"uniform", jsonWrong(accuracy.uniform)},
            {"distance_error",
             {{"mean", accuracy.distance_mean},
              {"p99", accuracy.distance_p99},
              {"mean_percent", accuracy.distance_mean * to_percent},
              {"p99_percent", accuracy.distance_p99 * to_percent}}},
            {"far_percent", accuracy.far_percent},
            {"unknown_percent", accuracy.unknown_percent},
            {"normal_error_degrees", {{"mean", accuracy.normal_mean}, {"p99", accuracy.normal_p99}}},
            {"no_normal_percent", accuracy.no_normal_percent}};
}

Json jsonColliderAccuracy(const ColliderAccuracy& accuracy, double longest_side) {
    Json json = jsonFieldAccuracy(accuracy.field, longest_side);
    json["unseen_area_percent"] = accuracy.unseen_percent;
    json["buried_area_percent"] = accuracy.buried_percent;
    json["gpu_bytes"] = accuracy.gpu_bytes;
    return json;
}

Json jsonSamples(const TruthSamples& samples) {
    return {{"samples", samples.options.samples},
            {"seed", samples.options.seed},
            {"sigma", samples.options.sigma_share * samples.longest_side},
            {"sigma_percent", 100.0 * samples.options.sigma_share},
            {"step", kSurfaceStep * samples.longest_side},
            {"longest_side", samples.longest_side}};
}

std::string accuracyText(const ColliderAccuracy& accuracy, const TruthSamples& samples,
                         const std::string& unit) {
    const FieldAccuracy& field = accuracy.field;
    const std::string units = " " + (unit.empty() ? std::string("object units") : unit);
    const auto wrongRow = [](const char* where, const WrongShare& share) {
        return std::vector<std::string>{where, percentText(share.total()), percentText(share.false_inside),
                                        percentText(share.false_outside)};
    };
    const auto length = [&](double value) {
        return shortNumber(value) + units + " (" + percentText(100.0 * value / samples.longest_side) + ")";
    };
    std::string text = table({{"points on the wrong side", "all>", "false inside>", "false outside>"},
                              wrongRow("near the surface", field.near),
                              wrongRow("anywhere in the box", field.uniform)});
    text += "\n";
    text +=
        table({{"error", "mean", "99 % stay below"},
               {"signed distance near the surface", length(field.distance_mean), length(field.distance_p99)},
               {"normal at the surface", shortNumber(field.normal_mean) + " degrees",
                shortNumber(field.normal_p99) + " degrees"}});
    text += "\n";
    std::vector<std::vector<std::string>> rows = {
        {"near the surface, outside without a distance", percentText(field.far_percent)},
        {"near the surface, no map votes", percentText(field.unknown_percent)},
        {"on the surface, no normal", percentText(field.no_normal_percent)},
        {"surface that no map sees", percentText(accuracy.unseen_percent)}};
    if (accuracy.buried_percent > 0.0) {
        rows.push_back({"surface inside the object, left out", percentText(accuracy.buried_percent)});
    }
    rows.push_back({"on the GPU", bytesText(accuracy.gpu_bytes)});
    text += table(rows);
    text += "\nLengths in percent are of the longest side, " + shortNumber(samples.longest_side) + units +
            ". " + std::to_string(samples.options.samples) + " points of each kind, seed " +
            std::to_string(samples.options.seed) + "; those near\nthe surface lie " +
            percentText(100.0 * samples.options.sigma_share) + " of it away (standard deviation).\n";
    return text;
}

}  // namespace relief

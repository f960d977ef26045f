#include "bake/report/inspect_report.h"

#include <cstdio>
#include <nlohmann/json.hpp>

#include "bake/report/report.h"
#include "runtime/tool/json_text.h"

namespace relief {
namespace {

using Json = nlohmann::ordered_json;

std::string plural(std::size_t count, const char* what) {
    return std::to_string(count) + " " + what + (count == 1 ? "" : "s");
}

const char* verdict(const Inspection& inspection) {
    return inspection.damaged() ? "damaged" : inspection.issues.empty() ? "sound" : "suspicious";
}

std::string mapText(const MapInspection& map) {
    const DepthMap& frame = *map.frame;
    const std::string size = std::to_string(frame.width) + "x" + std::to_string(frame.height);
    return (frame.faceCount() == 1 ? size : "6x" + size);
}

std::string coverageText(const MapInspection& map) {
    if (!map.coverage) {
        return "-";
    }
    char text[32];
    std::snprintf(text, sizeof(text), "%.1f %%", 100.0 * *map.coverage);
    return text;
}

bool usable(PartState state) {
    return state == PartState::kSound || state == PartState::kSuspicious;
}

std::string trustText(const Inspection& inspection) {
    if (!inspection.damaged()) {
        return "";
    }
    std::string maps;
    std::size_t count = 0;
    for (std::size_t i = 0; i < inspection.maps.size(); ++i) {
        if (usable(inspection.maps[i].state)) {
            maps += (count++ == 0 ? " " : ", ") + std::to_string(i);
        }
    }
    if (inspection.metadata != PartState::kSound) {
        return "Nothing of it can be trusted: what describes the maps is " +
               std::string(partStateName(inspection.metadata)) + ".\n";
    }
    return count == 0 ? "What describes the maps can be trusted, none of the maps can.\n"
                      : "Can be trusted: what describes the maps, and of them" + maps + ".\n";
}

}  // namespace

std::string inspectionText(const Inspection& inspection, const std::string& name) {
    std::string text = name + ": " + verdict(inspection);
    const std::pair<Severity, const char*> counted[] = {
        {Severity::kFatal, "fatal issue"}, {Severity::kError, "error"}, {Severity::kWarning, "warning"}};
    const char* separator = "; ";
    for (const auto& [severity, what] : counted) {
        if (const std::size_t count = inspection.count(severity); count > 0) {
            text += separator + plural(count, what);
            separator = ", ";
        }
    }
    text += "\n";
    for (const Issue& issue : inspection.issues) {
        text += issue.id() + " " + severityName(issue.severity()) + ": " +
                (issue.map >= 0 ? "map " + std::to_string(issue.map) + ": " : "") + issue.message +
                (issue.offset ? " (byte " + std::to_string(*issue.offset) + ")" : "") + "\n";
    }
    if (!inspection.maps.empty()) {
        std::vector<std::vector<std::string>> rows = {
            {"map", "is", "format", "size>", "stored>", "covered>"}};
        for (std::size_t i = 0; i < inspection.maps.size(); ++i) {
            const MapInspection& map = inspection.maps[i];
            rows.push_back({std::to_string(i), partStateName(map.state),
                            map.frame ? mapFormatName(map.frame->format) : "-",
                            map.frame ? mapText(map) : "-",
                            map.payload ? bytesText(map.payload->stored_size) : "-", coverageText(map)});
        }
        text += table(rows);
    }
    return text + trustText(inspection);
}

std::string inspectionJson(const Inspection& inspection, const std::string& name) {
    Json issues = Json::array();
    for (const Issue& issue : inspection.issues) {
        issues.push_back({{"code", issue.id()},
                          {"severity", severityName(issue.severity())},
                          {"map", issue.map >= 0 ? Json(issue.map) : Json(nullptr)},
                          {"offset", issue.offset ? Json(*issue.offset) : Json(nullptr)},
                          {"message", issue.message}});
    }
    Json maps = Json::array();
    for (std::size_t i = 0; i < inspection.maps.size(); ++i) {
        const MapInspection& map = inspection.maps[i];
        const auto ofFrame = [&](auto value) { return map.frame ? Json(value(*map.frame)) : Json(nullptr); };
        maps.push_back({{"index", i},
                        {"state", partStateName(map.state)},
                        {"format", ofFrame([](const DepthMap& m) { return mapFormatName(m.format); })},
                        {"width", ofFrame([](const DepthMap& m) { return m.width; })},
                        {"height", ofFrame([](const DepthMap& m) { return m.height; })},
                        {"offset", map.payload ? Json(map.payload->offset) : Json(nullptr)},
                        {"stored_bytes", map.payload ? Json(map.payload->stored_size) : Json(nullptr)},
                        {"coverage", map.coverage ? Json(*map.coverage) : Json(nullptr)}});
    }
    const bool known = inspection.major != 0;
    return jsonText(
        {{"file", name},
         {"file_size", inspection.file_size},
         {"version", known ? Json(std::to_string(inspection.major) + "." + std::to_string(inspection.minor))
                           : Json(nullptr)},
         {"verdict", verdict(inspection)},
         {"fatal", inspection.count(Severity::kFatal)},
         {"errors", inspection.count(Severity::kError)},
         {"warnings", inspection.count(Severity::kWarning)},
         {"header", partStateName(inspection.header)},
         {"metadata", partStateName(inspection.metadata)},
         {"issues", issues},
         {"maps", maps}});
}

}  // namespace relief

#include "bake/report/inspect_report.h"

#include "bake/report/report_text.h"

namespace relief {
namespace {

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
               std::string(wordOf(inspection.metadata)) + ".\n";
    }
    return count == 0 ? "What describes the maps can be trusted, none of the maps can.\n"
                      : "Can be trusted: what describes the maps, and of them" + maps + ".\n";
}

}  // namespace

std::string_view inspectionVerdict(const Inspection& inspection) {
    return inspection.damaged() ? "damaged" : inspection.issues.empty() ? "sound" : "suspicious";
}

std::string inspectionText(const Inspection& inspection, const std::string& name) {
    std::string text = name + ": ";
    text += inspectionVerdict(inspection);
    const std::pair<Severity, const char*> counted[] = {
        {Severity::kFatal, "fatal issue"}, {Severity::kError, "error"}, {Severity::kWarning, "warning"}};
    const char* separator = "; ";
    for (const auto& [severity, what] : counted) {
        if (const std::size_t count = inspection.count(severity); count > 0) {
            text += separator + countText(count, what);
            separator = ", ";
        }
    }
    text += "\n";
    for (const Issue& issue : inspection.issues) {
        text += issue.id() + " " + std::string(wordOf(issue.severity())) + ": " +
                (issue.map >= 0 ? "map " + std::to_string(issue.map) + ": " : "") + issue.message +
                (issue.offset ? " (byte " + std::to_string(*issue.offset) + ")" : "") + "\n";
    }
    if (!inspection.maps.empty()) {
        std::vector<std::vector<std::string>> rows = {
            {"map", "is", "format", "size>", "stored>", "covered>"}};
        for (std::size_t i = 0; i < inspection.maps.size(); ++i) {
            const MapInspection& map = inspection.maps[i];
            const bool patches = map.frame && map.frame->format == MapFormat::kPatches;
            rows.push_back({std::to_string(i), std::string(wordOf(map.state)),
                            map.frame ? mapFormatName(map.frame->format) : "-",
                            map.frame ? sizeText(*map.frame) : "-",
                            map.payload ? bytesText(map.payload->stored_size) : "-",
                            map.coverage && !patches ? shareText(*map.coverage) : "-"});
        }
        text += table(rows);
    }
    return text + trustText(inspection);
}

std::vector<MapInspectionReport> InspectionReport::maps() const {
    std::vector<MapInspectionReport> rows;
    for (std::size_t i = 0; i < inspection.maps.size(); ++i) {
        rows.push_back({i, inspection.maps[i]});
    }
    return rows;
}

}  // namespace relief

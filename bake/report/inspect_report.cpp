// SPDX-License-Identifier: Apache-2.0
#include "bake/report/inspect_report.h"

#include "bake/verdict/report_text.h"

namespace relief {
namespace {

std::string usableText(const Inspection& inspection) {
    if (!inspection.damaged()) {
        return "";
    }
    std::string maps;
    std::size_t count = 0;
    for (std::size_t i = 0; i < inspection.maps.size(); ++i) {
        const PartState state = inspection.maps[i].state;
        if (state == PartState::kSound || state == PartState::kSuspicious) {
            maps += (count++ == 0 ? " " : ", ") + std::to_string(i);
        }
    }
    if (inspection.metadata != PartState::kSound) {
        return "Nothing in the file is usable: the description of the maps is " +
               std::string(wordOf(inspection.metadata)) + ".\n";
    }
    return count == 0 ? "The description of the maps is usable; none of the maps is.\n"
                      : "Usable: the description of the maps, and maps" + maps + ".\n";
}

/// Returns "sound", "suspicious" or "damaged".
std::string_view inspectionVerdict(const Inspection& inspection) {
    return inspection.damaged() ? "damaged" : inspection.issues.empty() ? "sound" : "suspicious";
}

}  // namespace

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
                            map.coverage && !patches ? fractionText(*map.coverage) : "-"});
        }
        text += table(rows);
    }
    return text + usableText(inspection);
}

void fields(FieldVisitor& visit, const Issue& issue) {
    visit("code", issue.id(),
          {.help = "Code of the issue; the meaning of a code never changes", .pattern = "^RLF-[0-9]{4}$"});
    visit("severity", issue.severity(), {"Severity of the code"});
    visit("map", onlyIf(issue.map >= 0, issue.map),
          {"Index of the map; null if the issue is not about a map", {}, kFromZero});
    visit("offset", issue.offset, {"Byte offset in the file; null if not applicable"});
    visit("message", issue.message, {"Message in one line"});
}

namespace {

struct MapInspectionReport {
    std::size_t index = 0;
    const MapInspection& map = kNone<MapInspection>;
};

void fields(FieldVisitor& visit, const MapInspectionReport& report) {
    const std::optional<DepthMap>& frame = report.map.frame;
    const std::optional<PayloadInfo>& payload = report.map.payload;
    visit("index", report.index, {"Index in the container"});
    visit("state", report.map.state,
          {"unverified: the map is intact, but the metadata that describes it has a wrong checksum"});
    visit(
        "format", frame ? std::optional(mapFormatName(frame->format)) : std::nullopt,
        {.help = "Format of the texels; null if the map's description is invalid", .words = kMapFormatWords});
    visit("width", frame ? std::optional(frame->width) : std::nullopt, {"Width", "texels"});
    visit("height", frame ? std::optional(frame->height) : std::nullopt, {"Height", "texels"});
    visit("offset", payload ? std::optional(payload->offset) : std::nullopt,
          {"First byte of the payload, according to the metadata"});
    visit("stored_bytes", payload ? std::optional(payload->stored_size) : std::nullopt,
          {"Size of the payload, according to the metadata", "bytes"});
    visit(
        "coverage", report.map.coverage,
        {"Fraction of the texels that store a surface; null if they could not be read", {}, kFractionRange});
}

}  // namespace

void fields(FieldVisitor& visit, const InspectionReport& report) {
    const Inspection& all = report.inspection;
    std::vector<MapInspectionReport> maps;
    for (std::size_t i = 0; i < all.maps.size(); ++i) {
        maps.push_back({i, all.maps[i]});
    }
    visit("file", report.name, {"File name without its folder, or standard input"});
    visit("file_bytes", all.file_size, {"Size of the file", "bytes"});
    visit("version", onlyIf(all.major != 0, std::to_string(all.major) + "." + std::to_string(all.minor)),
          {.help = "Version of the container format; null if the header is unreadable",
           .pattern = "^[0-9]+\\.[0-9]+$"});
    visit(
        "verdict", inspectionVerdict(all),
        {.help = "Verdict; readers reject damaged files", .words = kWords<"sound", "suspicious", "damaged">});
    visit("fatal", all.count(Severity::kFatal), {"Issues that prevent reading the rest of the file"});
    visit("errors", all.count(Severity::kError), {"Issues for which readers reject the file"});
    visit("warnings", all.count(Severity::kWarning), {"Issues that readers accept"});
    visit("header", all.header, {"State of the first 64 bytes"});
    visit("metadata", all.metadata, {"State of the description of the maps"});
    visit("issues", all.issues, {"Issues, in the order of the file"});
    visit("maps", maps, {"Maps listed in the metadata"});
}

}  // namespace relief

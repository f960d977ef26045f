// A container by itself, as `relief check FILE` reports it.
#pragma once

#include <string>
#include <vector>

#include "bake/report/collider_report.h"
#include "formats/inspect.h"

namespace relief {

/// "sound", "suspicious" or "damaged"
[[nodiscard]] std::string_view inspectionVerdict(const Inspection& inspection);

/// A line for the verdict, a line for each issue, a table of the maps, and which parts can be trusted.
/// \param name  of the file, for people
[[nodiscard]] std::string inspectionText(const Inspection& inspection, const std::string& name);

// --- The same as fields.

template <class Visitor, FieldsOf<Issue> I>
void fields(Visitor& visit, I& issue) {
    visit("code", issue.id(),
          {.help = "Code of the issue; codes keep their meaning", .pattern = "^RLF-[0-9]{4}$"});
    visit("severity", issue.severity(), {"Severity of the code"});
    visit("map", onlyIf(issue.map >= 0, issue.map),
          {"Index of the map; null if the issue is not about a map", {}, kFromZero});
    visit("offset", issue.offset, {"Byte of the file; null if there is none to name"});
    visit("message", issue.message, {"One line for people"});
}

struct MapInspectionReport {
    std::size_t index = 0;
    const MapInspection& map = kNone<MapInspection>;
};

template <class Visitor, FieldsOf<MapInspectionReport> R>
void fields(Visitor& visit, R& report) {
    const std::optional<DepthMap>& frame = report.map.frame;
    const std::optional<PayloadInfo>& payload = report.map.payload;
    visit("index", report.index, {"Position in the container"});
    visit("state", report.map.state, {"How far the map can be trusted"});
    visit(
        "format", frame ? std::optional(mapFormatName(frame->format)) : std::nullopt,
        {.help = "Format of the texels; null if the map's description is invalid", .words = kMapFormatWords});
    visit("width", frame ? std::optional(frame->width) : std::nullopt, {"Width", "texels"});
    visit("height", frame ? std::optional(frame->height) : std::nullopt, {"Height", "texels"});
    visit("offset", payload ? std::optional(payload->offset) : std::nullopt,
          {"First byte of the payload, according to the metadata"});
    visit("stored_bytes", payload ? std::optional(payload->stored_size) : std::nullopt,
          {"Size of the payload, according to the metadata", "bytes"});
    visit("coverage", report.map.coverage,
          {"Share of the texels that hold a surface; null if they could not be read", {}, kShareRange});
}

/// `relief check FILE --json`
struct InspectionReport {
    const Inspection& inspection = kNone<Inspection>;
    std::string name;  ///< of the file

    [[nodiscard]] std::vector<MapInspectionReport> maps() const;
};

template <class Visitor, FieldsOf<InspectionReport> R>
void fields(Visitor& visit, R& report) {
    const Inspection& all = report.inspection;
    visit("file", report.name, {"File name without its folder, or standard input"});
    visit("file_size", all.file_size, {"Size of the file", "bytes"});
    visit("version", onlyIf(all.major != 0, std::to_string(all.major) + "." + std::to_string(all.minor)),
          {.help = "Version of the container format; null if the header is unreadable",
           .pattern = "^[0-9]+\\.[0-9]+$"});
    visit("verdict", inspectionVerdict(all),
          {.help = "Readers refuse damaged files", .words = kWords<"sound", "suspicious", "damaged">});
    visit("fatal", all.count(Severity::kFatal), {"Issues behind which nothing can be read"});
    visit("errors", all.count(Severity::kError), {"Issues for which readers refuse the file"});
    visit("warnings", all.count(Severity::kWarning), {"Issues that readers accept"});
    visit("header", all.header, {"State of the first 64 bytes"});
    visit("metadata", all.metadata, {"State of the description of the maps"});
    visit("issues", all.issues, {"Issues, in the order of the file"});
    visit("maps", report.maps(), {"Maps, as many as the metadata lists"});
}

}  // namespace relief

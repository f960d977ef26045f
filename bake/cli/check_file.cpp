#include "bake/cli/check_file.h"

#include "bake/cli/command.h"
#include "bake/report/inspect_report.h"
#include "formats/bake_first.h"
#include "formats/base/error_context.h"
#include "formats/base/file_io.h"
#include "formats/container_reader.h"
#include "formats/fields/json.h"
#include "runtime/command_line/command_line.h"

namespace relief {

Result<void> checkFile(const std::string& file, bool json, const ContainerLimits& limits) {
    const std::vector<std::byte> bytes = RELIEF_TRY(readFile(file, containerSizeMax(limits)));
    const std::string quoted = shownInput(file);
    const Inspection inspection = RELIEF_TRY(inFront(quoted, inspectContainer(bytes, limits)));
    const std::string name = inputName(file);
    const Result<void> printed = printOut(json ? jsonText(jsonOf(InspectionReport{inspection, name}))
                                               : inspectionText(inspection, name));
    if (!printed || !inspection.damaged()) {
        return printed;
    }
    RELIEF_TRY(refuseMesh(file, bytes));
    for (const Issue& issue : inspection.issues) {
        if (issue.severity() != Severity::kWarning) {
            const std::string map = issue.map >= 0 ? "map " + std::to_string(issue.map) + ": " : "";
            return fail(inspection.errorCode(), quoted + " cannot be used: " + issue.id() + ", " + map +
                                                    issue.message + "; copy it again, or bake it again");
        }
    }
    return {};
}

}  // namespace relief

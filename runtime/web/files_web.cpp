// The readers of runtime/files that need libraries which no browser build has, but for pictures (png_web.cpp).
#include "runtime/files/flow_file.h"

namespace relief {

bool hasSliceNumber(const std::string&) {
    return true;  // loadFlow() refuses all of them
}

std::vector<std::filesystem::path> flowPaths(const FlowFile& file) {
    return {file.path};
}

Result<FlowField> loadFlow(const FlowFile& file) {
    return fail(ErrorCode::kUnsupported,
                file.origin + "flow fields are not read in a browser; take relief-sim, or leave them out");
}

}  // namespace relief

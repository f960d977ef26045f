#include "formats/base/result.h"

namespace relief {

const char* errorCodeName(ErrorCode code) {
    switch (code) {
        case ErrorCode::kUsage:
            return "usage";
        case ErrorCode::kIo:
            return "file or I/O";
        case ErrorCode::kInvalidInput:
            return "invalid input";
        case ErrorCode::kFailure:
            return "failure";
        case ErrorCode::kUnsupported:
            return "unsupported";
        case ErrorCode::kLimit:
            return "limit exceeded";
        case ErrorCode::kDifference:
            return "difference found";
    }
    return "unknown";
}

}  // namespace relief

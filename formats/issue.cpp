#include "formats/issue.h"

#include <algorithm>
#include <array>

namespace relief {

const char* severityName(Severity severity) {
    constexpr const char* kNames[] = {"fatal", "error", "warning"};
    return kNames[static_cast<std::size_t>(severity)];
}

const char* partStateName(PartState state) {
    constexpr const char* kNames[] = {"sound", "suspicious", "unverified", "damaged", "unreadable"};
    return kNames[static_cast<std::size_t>(state)];
}

Severity Issue::severity() const {
    using enum IssueCode;
    constexpr std::array kFatal = {kTooShort,      kSignature,     kMajorVersion, kMetadataLimit,
                                   kMetadataPlace, kMetadataTable, kMapLimit};
    if (std::find(kFatal.begin(), kFatal.end(), code) != kFatal.end()) {
        return Severity::kFatal;
    }
    return code < kLaterMinor ? Severity::kError : Severity::kWarning;
}

std::string Issue::id() const {
    return "RLF-" + std::to_string(static_cast<int>(code));
}

}  // namespace relief

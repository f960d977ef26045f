#include "formats/issue.h"

#include <algorithm>
#include <array>

namespace relief {
namespace {

constexpr std::array kKinds = {
    IssueKind{IssueCode::kTooShort, Severity::kFatal, "shorter than a header"},
    IssueKind{IssueCode::kSignature, Severity::kFatal, "the signature is not that of a container"},
    IssueKind{IssueCode::kMajorVersion, Severity::kFatal, "another major version"},
    IssueKind{IssueCode::kHeaderChecksum, Severity::kError, "the checksum of the header is wrong"},
    IssueKind{IssueCode::kHeaderField, Severity::kError, "a constant field of the header is not version 1's"},
    IssueKind{IssueCode::kTruncated, Severity::kError, "the file is shorter than its header says"},
    IssueKind{IssueCode::kTrailingBytes, Severity::kError, "the file is longer than its header says"},
    IssueKind{IssueCode::kMetadataLimit, Severity::kFatal, "the metadata is beyond its limit"},
    IssueKind{IssueCode::kMetadataPlace, Severity::kFatal, "the metadata reaches beyond the end of the file"},
    IssueKind{IssueCode::kMetadataChecksum, Severity::kError, "the checksum of the metadata is wrong"},
    IssueKind{IssueCode::kMetadataTable, Severity::kFatal, "the metadata is no table of a collider"},
    IssueKind{IssueCode::kMapLimit, Severity::kFatal, "more maps than the limit"},
    IssueKind{IssueCode::kNoMap, Severity::kError, "there is no map"},
    IssueKind{IssueCode::kBounds, Severity::kError, "the bounds are not finite or not in order"},
    IssueKind{IssueCode::kUnit, Severity::kError, "the unit is no text or too long"},
    IssueKind{IssueCode::kProvenance, Severity::kError, "a field of the provenance is malformed"},
    IssueKind{IssueCode::kFrame, Severity::kError, "a map's format, size or transform is invalid"},
    IssueKind{IssueCode::kMapSizeLimit, Severity::kError, "a map is larger than the limit"},
    IssueKind{IssueCode::kPayloadSize, Severity::kError,
              "a payload's sizes or compression do not go with its map"},
    IssueKind{IssueCode::kTexelLimit, Severity::kError, "all texels together are beyond the limit"},
    IssueKind{IssueCode::kPayloadPlace, Severity::kError, "a payload is not where the layout has it"},
    IssueKind{IssueCode::kPayloadEnd, Severity::kError, "a payload reaches beyond the end of the file"},
    IssueKind{IssueCode::kPadding, Severity::kError, "padding is not zero"},
    IssueKind{IssueCode::kBytesBehind, Severity::kError, "bytes follow the last payload"},
    IssueKind{IssueCode::kPayloadChecksum, Severity::kError, "the checksum of a payload is wrong"},
    IssueKind{IssueCode::kPayloadUnpack, Severity::kError, "a payload does not unpack to its texels"},
    IssueKind{IssueCode::kTexels, Severity::kError, "a texel holds what no texel may hold"},
    IssueKind{IssueCode::kLaterMinor, Severity::kWarning,
              "a later minor version: unknown fields are ignored"},
    IssueKind{IssueCode::kNoMeshHash, Severity::kWarning, "no hash of the mesh"},
    IssueKind{IssueCode::kNoToolVersion, Severity::kWarning, "no tool or no options that made it"},
    IssueKind{IssueCode::kNoTriangles, Severity::kWarning, "a mesh of no triangles"},
    IssueKind{IssueCode::kNothingCovered, Severity::kWarning, "a map without any surface"},
    IssueKind{IssueCode::kDuplicateMap, Severity::kWarning, "a map says what another says already"},
    IssueKind{IssueCode::kDepthSaturated, Severity::kWarning,
              "more than a quarter of a map's depths lie at an end of their range, amid the bounds"},
    IssueKind{IssueCode::kOutsideBounds, Severity::kWarning,
              "more than 1 % of a map's surfaces lie outside of the bounds"},
    IssueKind{IssueCode::kOutsideVolume, Severity::kWarning,
              "more than 1 % of other maps' surfaces lie outside of a volume that encloses the collider"},
    IssueKind{IssueCode::kNormalsInward, Severity::kWarning,
              "more than a quarter of a map's normals point into the object"},
    IssueKind{IssueCode::kBorderCovered, Severity::kWarning,
              "the border of a map, which is never looked at, holds surfaces"},
    IssueKind{IssueCode::kTexelBits, Severity::kWarning,
              "empty texels with a normal, or normal indices of 255"},
    IssueKind{IssueCode::kGapReversed, Severity::kWarning,
              "more than a quarter of a gap map's texels close their gap before they open it"},
};

const IssueKind& kindOf(IssueCode code) {
    return *std::find_if(std::begin(kKinds), std::end(kKinds),
                         [&](const IssueKind& kind) { return kind.code == code; });
}

}  // namespace

const char* severityName(Severity severity) {
    constexpr const char* kNames[] = {"fatal", "error", "warning"};
    return kNames[static_cast<std::size_t>(severity)];
}

const char* partStateName(PartState state) {
    constexpr const char* kNames[] = {"sound", "suspicious", "unverified", "damaged", "unreadable"};
    return kNames[static_cast<std::size_t>(state)];
}

std::span<const IssueKind> issueKinds() {
    return kKinds;
}

Severity Issue::severity() const {
    return kindOf(code).severity;
}

std::string Issue::id() const {
    return "RLF-" + std::to_string(static_cast<int>(code));
}

}  // namespace relief

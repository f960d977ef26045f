// What is wrong with a container, all of it, by numbered issues: where readContainer stops at the first
// error, this goes on with whatever can still be read, and says what of the file may be trusted. README.md
// beside this file, "Issues", lists the codes; they keep their meaning from version to version.
#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "formats/container.h"
#include "formats/result.h"

namespace relief {

enum class Severity : std::uint8_t {
    kFatal,    ///< nothing behind it can be read
    kError,    ///< readers refuse the file
    kWarning,  ///< readers take the file; it is hardly what was meant
};

[[nodiscard]] const char* severityName(Severity severity);  ///< "fatal", "error" or "warning"

/// The codes. 1xxx: damage, 2xxx: suspicions.
enum class IssueCode : std::uint16_t {
    kTooShort = 1001,
    kSignature = 1002,
    kMajorVersion = 1003,
    kHeaderChecksum = 1004,
    kHeaderField = 1005,
    kTruncated = 1006,
    kTrailingBytes = 1007,
    kMetadataLimit = 1008,
    kMetadataPlace = 1009,
    kMetadataChecksum = 1101,
    kMetadataTable = 1102,
    kMapLimit = 1103,
    kNoMap = 1104,
    kBounds = 1201,
    kUnit = 1202,
    kProvenance = 1203,
    kFrame = 1301,
    kMapSizeLimit = 1302,
    kPayloadSize = 1401,
    kTexelLimit = 1402,
    kPayloadPlace = 1403,
    kPayloadEnd = 1404,
    kPadding = 1405,
    kBytesBehind = 1406,
    kPayloadChecksum = 1407,
    kPayloadZstd = 1408,
    kTexels = 1501,
    kRefused = 1901,
    kLaterMinor = 2001,
    kNoMeshHash = 2101,
    kNoToolVersion = 2102,
    kNoTriangles = 2103,
    kNothingCovered = 2201,
    kDuplicateMap = 2202,
    kDepthSaturated = 2203,
    kOutsideBounds = 2204,
    kOutsideVolume = 2205,
    kNormalsInward = 2206,
    kBorderCovered = 2207,
    kTexelBits = 2208,
};

/// One row of the table of codes.
struct IssueKind {
    IssueCode code;
    Severity severity;
    const char* meaning;  ///< as README.md has it
};
[[nodiscard]] std::span<const IssueKind> issueKinds();  ///< by ascending code

struct Issue {
    IssueCode code;
    int map = -1;                         ///< −1: of the whole file
    std::optional<std::uint64_t> offset;  ///< byte of the file, where one can be named
    std::string message;                  ///< one line for a person, the map not named

    [[nodiscard]] Severity severity() const;
    [[nodiscard]] std::string id() const;  ///< "RLF-1407"
};

/// What may be believed of a map or of another part of the file.
enum class PartState : std::uint8_t {
    kSound,       ///< every check passed
    kSuspicious,  ///< every check passed, but there is a warning
    kUnverified,  ///< its own checks passed, but what describes it is damaged
    kDamaged,     ///< read, and wrong
    kUnreadable,  ///< could not be looked at
};
[[nodiscard]] const char* partStateName(PartState state);  ///< "sound", "suspicious", …

struct MapInspection {
    PartState state = PartState::kUnreadable;
    std::optional<DepthMap> frame;  ///< without texels; set where it is valid
    std::optional<PayloadInfo> payload;
    /// Of the texels, the share that holds a surface, 0…1; of a front-back map at least one. Set where the
    /// texels were read.
    std::optional<double> coverage;
};

struct Inspection {
    std::vector<Issue> issues;  ///< in the order of the file
    PartState header = PartState::kUnreadable;
    PartState metadata = PartState::kUnreadable;
    std::vector<MapInspection> maps;  ///< as many as the metadata has, believed or not
    std::uint64_t file_size = 0;      ///< bytes that there are
    std::uint16_t major = 0;          ///< 0 where the header is unreadable, as is `minor`
    std::uint16_t minor = 0;

    [[nodiscard]] std::size_t count(Severity severity) const;
    /// Whether readContainer refuses the file.
    [[nodiscard]] bool damaged() const;
    /// kInvalidInput; kUnsupported for another major version, kLimit if limits are all that is wrong.
    [[nodiscard]] ErrorCode errorCode() const;
};

/// Looks at every byte. Takes about as much memory as readContainer does.
/// Errors: kLimit, where even that does not fit into memory.
[[nodiscard]] Result<Inspection> inspectContainer(std::span<const std::byte> bytes,
                                                  const ContainerLimits& limits = {});

}  // namespace relief

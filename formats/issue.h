// SPDX-License-Identifier: Apache-2.0
// The numbered issues of a container. README.md in this folder, "Validation", lists the codes; their meaning never
// changes.
#pragma once

#include <algorithm>
#include <array>
#include <cstdint>
#include <optional>
#include <string>
#include <string_view>

#include "formats/base/enum_words.h"

namespace relief {

enum class Severity : std::uint8_t {
    kFatal,    ///< the rest of the file cannot be read
    kError,    ///< readers reject the file
    kWarning,  ///< readers accept the file, but its contents are suspicious
};

template <>
inline constexpr std::array<std::string_view, 3> kWordsOf<Severity>{"fatal", "error", "warning"};

/// 1xxx: errors; 2xxx: warnings.
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
    kMaterials = 1204,
    kFrame = 1301,
    kMapSizeLimit = 1302,
    kPayloadSize = 1401,
    kTexelLimit = 1402,
    kPayloadPlace = 1403,
    kPayloadEnd = 1404,
    kPadding = 1405,
    kBytesAfterPayload = 1406,
    kPayloadChecksum = 1407,
    kPayloadUnpack = 1408,
    kTexels = 1501,
    kLaterMinor = 2001,
    kNoMeshHash = 2101,
    kNoToolVersion = 2102,
    kNoTriangles = 2103,
    kNothingCovered = 2201,
};

struct Issue {
    IssueCode code = IssueCode::kTooShort;
    int map = -1;                         ///< −1: the whole file
    std::optional<std::uint64_t> offset;  ///< byte offset in the file, if known
    std::string message;                  ///< one line; does not name the map

    [[nodiscard]] Severity severity() const {
        using enum IssueCode;
        constexpr std::array kFatal = {kTooShort,      kSignature,     kMajorVersion, kMetadataLimit,
                                       kMetadataPlace, kMetadataTable, kMapLimit};
        if (std::find(kFatal.begin(), kFatal.end(), code) != kFatal.end()) {
            return Severity::kFatal;
        }
        return code < kLaterMinor ? Severity::kError : Severity::kWarning;
    }
    [[nodiscard]] std::string id() const {  ///< "RLF-1407"
        return "RLF-" + std::to_string(static_cast<int>(code));
    }
};

/// How far a map or another section of the file can be trusted.
enum class PartState : std::uint8_t {
    kSound,       ///< every check passed
    kSuspicious,  ///< every check passed, but there is a warning
    kUnverified,  ///< its own checks passed, but the data that describe it are damaged
    kDamaged,     ///< was read; a check failed
    kUnreadable,  ///< could not be read
};
template <>
inline constexpr std::array<std::string_view, 5> kWordsOf<PartState>{"sound", "suspicious", "unverified",
                                                                     "damaged", "unreadable"};

}  // namespace relief

// SPDX-License-Identifier: Apache-2.0
// Reads raw samples without a header. Type, byte order and width are settings, because the file does not state them.
#pragma once

#include <cstddef>
#include <memory>
#include <optional>
#include <span>
#include <string>

#include "bake/height_map/heights_spec.h"
#include "bake/import/sample_rows.h"
#include "formats/base/result.h"

namespace relief {

/// Opens raw samples.
/// \param bytes  untrusted; must outlive the rows.
/// Errors, without the file name: kInvalidInput (not a whole number of rows or, without a width, not a square).
[[nodiscard]] Result<std::unique_ptr<SampleRows>> openRawRows(std::span<const std::byte> bytes,
                                                              const HeightsSpec& spec);

/// Settings that fit raw samples better than the given ones.
struct LikelierFormat {
    std::optional<SampleType> type = {};  ///< nullopt: as given
    std::optional<ByteOrder> order = {};  ///< nullopt: as given
    bool eight_bits = false;              ///< the given settings may also be correct: 8-bit samples times 256
    /// No better setting was found, but the samples look like noise, or neighbours differ less with the other
    /// signedness.
    bool doubtful = false;

    [[nodiscard]] bool found() const { return type || order; }
    friend bool operator==(const LikelierFormat&, const LikelierFormat&) = default;
};
/// "type=int16,order=big"; empty if no better setting was found.
[[nodiscard]] std::string toString(const LikelierFormat& format);

/// Searches for better settings, by the differences between neighbours in at most 64 rows and the values of all bytes.
[[nodiscard]] LikelierFormat likelierRawFormat(std::span<const std::byte> bytes, const HeightsSpec& spec);

}  // namespace relief

// SPDX-License-Identifier: Apache-2.0
// Raw samples without a header: their type, byte order and width are settings, as nothing in the file states them.
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

/// \param bytes  untrusted; must outlive the rows.
/// Errors, without the file's name: kInvalidInput (no such rows, or no square).
[[nodiscard]] Result<std::unique_ptr<SampleRows>> openRawRows(std::span<const std::byte> bytes,
                                                              const HeightsSpec& spec);

/// Settings that fit raw samples better than those given.
struct LikelierFormat {
    std::optional<SampleType> type = {};  ///< nullopt: as given
    std::optional<ByteOrder> order = {};  ///< nullopt: as given
    bool eight_bits = false;              ///< the samples may also be as given: 8 bits times 256
    bool doubtful = false;  ///< none is found; but the samples are noise, or differ less with another sign

    [[nodiscard]] bool found() const { return type || order; }
    friend bool operator==(const LikelierFormat&, const LikelierFormat&) = default;
};
/// "type=int16,order=big"; empty if there are none.
[[nodiscard]] std::string toString(const LikelierFormat& format);

/// Compares the differences of neighbours in at most 64 rows, and the values of all bytes.
[[nodiscard]] LikelierFormat likelierRawFormat(std::span<const std::byte> bytes, const HeightsSpec& spec);

}  // namespace relief

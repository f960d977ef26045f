// ZIP archives in memory, as 3MF files are: files by their names, stored or deflated.
#pragma once

#include <cstddef>
#include <cstdint>
#include <map>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "formats/base/result.h"

namespace relief {

class ZipArchive {
  public:
    /// \param bytes  borrowed. Errors: kInvalidInput, without the archive's name, as for read().
    [[nodiscard]] static Result<ZipArchive> open(std::span<const std::byte> bytes);

    /// \param name  as the archive has it, but for the case of its letters.
    /// Errors: kInvalidInput (there is none, or it is damaged), kUnsupported (encrypted, or packed in another way).
    [[nodiscard]] Result<std::vector<std::byte>> read(std::string_view name) const;

  private:
    struct Entry {
        std::uint64_t header = 0;  ///< offset
        std::uint64_t packed = 0;  ///< bytes, as is the next
        std::uint64_t size = 0;
        std::uint32_t checksum = 0;
        std::uint16_t method = 0;
        std::uint16_t flags = 0;
    };

    explicit ZipArchive(std::span<const std::byte> bytes) : bytes_(bytes) {}
    [[nodiscard]] bool readDirectory();
    [[nodiscard]] bool readEntry(std::uint64_t& at);
    /// A little-endian number of so many bytes; 0 beyond the end.
    [[nodiscard]] std::uint64_t number(std::uint64_t at, std::size_t size) const;

    std::span<const std::byte> bytes_;
    std::map<std::string, Entry, std::less<>> entries_;  // by their names in lower case
};

}  // namespace relief

// Comma-separated text, line by line: what `relief query` and the emitters of relief-sim read points from.
#pragma once

#include <cstddef>
#include <span>
#include <string_view>
#include <vector>

namespace relief {

/// Passes over a byte order mark, empty lines and lines that start with '#'. Nothing is quoted.
class CsvReader {
  public:
    /// A line of more fields shows this many and one more: a hostile line could have millions.
    static constexpr std::size_t kFieldsMax = 8;

    /// \param text  borrowed, as are line() and fields().
    explicit CsvReader(std::string_view text);

    /// Goes to the next line. \return false at the end.
    [[nodiscard]] bool next();
    [[nodiscard]] std::size_t number() const { return number_; }      ///< of the line, from 1
    [[nodiscard]] std::string_view line() const { return line_; }     ///< without white space at both ends
    [[nodiscard]] std::span<const std::string_view> fields() const {  ///< at least one; trimmed likewise
        return fields_;
    }

  private:
    std::string_view text_;
    std::string_view line_;
    std::vector<std::string_view> fields_;
    std::size_t number_ = 0;
};

}  // namespace relief

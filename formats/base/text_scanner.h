// SPDX-License-Identifier: Apache-2.0
// Lines and words of a text file: the one tokenizer of the text formats that Relief reads or checks itself.
#pragma once

#include <cstddef>
#include <span>
#include <string_view>
#include <vector>

namespace relief {

/// How a format writes text, beyond what all have in common.
struct TextRules {
    char comment =
        '\0';  ///< begins a comment, within a word too, that goes to the end of the line; \0: there are none
    bool continues = false;  ///< a backslash at the end of a line joins the next one to it
};

/// Walks over a text once. Words stand between blanks (space, tab, vertical tab, form feed); lines end with "\n", "\r\n" or
/// "\r". A byte order mark of UTF-8 in front is passed over, and so is what some systems fill the end of a file with: zeros
/// and ^Z.
class TextScanner {
  public:
    /// \param text  borrowed, as are the words.
    explicit TextScanner(std::string_view text, TextRules rules = {});

    /// The next word of this line. \return empty if there is none.
    [[nodiscard]] std::string_view word();
    /// The next word of this line or of those below. \return empty at the end of the text.
    [[nodiscard]] std::string_view anyWord();
    /// Whether this line holds no more words.
    [[nodiscard]] bool atLineEnd();
    /// The rest of this line, without blanks at both ends: a name, which may hold what begins a comment elsewhere.
    [[nodiscard]] std::string_view restOfLine();
    /// Passes over the rest of this line. \return false if that was the last one.
    bool nextLine();

    /// Number, from 1, of the line that the last word or rest stands in; before those, of the first.
    [[nodiscard]] std::size_t line() const { return word_line_; }
    /// The text that is left to read.
    [[nodiscard]] std::string_view rest() const;

  private:
    /// Length of the end of a line at `at`, 0 if there is none.
    [[nodiscard]] std::size_t lineEnd(const char* at) const;
    /// Of a backslash that joins two lines, with what stands up to the second.
    [[nodiscard]] std::size_t joint(const char* at) const;
    void skipBlanks(bool over_lines);
    std::string_view takeWord();

    const char* at_;
    const char* end_;
    TextRules rules_;
    std::size_t line_ = 1;
    std::size_t word_line_ = 1;
};

/// Comma-separated text, line by line. Passes over a byte order mark, empty lines and lines that start with '#'. Nothing is quoted.
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

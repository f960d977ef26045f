// SPDX-License-Identifier: Apache-2.0
// Lines and words of a text file: the tokenizer for all text formats that Relief parses itself.
#pragma once

#include <cstddef>
#include <span>
#include <string_view>
#include <vector>

namespace relief {

/// Syntax options of a text format.
struct TextRules {
    char comment = '\0';     ///< starts a comment to the end of the line, also within a word; \0: none
    bool continues = false;  ///< a backslash at the end of a line joins the next line
};

/// Scans a text once. Blanks (space, tab, vertical tab, form feed) separate words; "\n", "\r\n" or "\r" end lines.
/// Skips a leading UTF-8 byte order mark, and the zeros or ^Z that some systems pad files with.
class TextScanner {
  public:
    /// \param text  borrowed; returned words point into it.
    explicit TextScanner(std::string_view text, TextRules rules = {});

    /// Returns the next word of this line; empty if there is none.
    [[nodiscard]] std::string_view word();
    /// Returns the next word of this or a later line; empty at the end of the text.
    [[nodiscard]] std::string_view anyWord();
    /// Returns whether this line has no more words.
    [[nodiscard]] bool atLineEnd();
    /// Returns the rest of this line, trimmed: a name, which may contain the comment character.
    [[nodiscard]] std::string_view restOfLine();
    /// Skips the rest of this line. \return false if it was the last one.
    bool nextLine();

    /// Returns the number, from 1, of the line where the last returned text starts; initially 1.
    [[nodiscard]] std::size_t line() const { return word_line_; }
    /// Returns the unread text.
    [[nodiscard]] std::string_view rest() const;

  private:
    /// Returns the length of the line break at `at`, or 0.
    [[nodiscard]] std::size_t lineEnd(const char* at) const;
    /// Returns the length of a line continuation, from the backslash to the start of the next line, or 0.
    [[nodiscard]] std::size_t joint(const char* at) const;
    void skipBlanks(bool over_lines);
    std::string_view popWord();

    const char* at_;
    const char* end_;
    TextRules rules_;
    std::size_t line_ = 1;
    std::size_t word_line_ = 1;
};

/// Reads comma-separated text line by line. Skips a byte order mark, empty lines and lines that start with '#'. No
/// quoting.
class CsvReader {
  public:
    /// If a line has more fields, fields() returns only the first kFieldsMax + 1: a hostile line could have millions.
    static constexpr std::size_t kFieldsMax = 8;

    /// \param text  borrowed; line() and fields() point into it.
    explicit CsvReader(std::string_view text);

    /// Advances to the next line. \return false at the end.
    [[nodiscard]] bool next();
    [[nodiscard]] std::size_t number() const { return number_; }      ///< line number, from 1
    [[nodiscard]] std::string_view line() const { return line_; }     ///< trimmed
    [[nodiscard]] std::span<const std::string_view> fields() const {  ///< trimmed; at least one
        return fields_;
    }

  private:
    std::string_view text_;
    std::string_view line_;
    std::vector<std::string_view> fields_;
    std::size_t number_ = 0;
};

}  // namespace relief

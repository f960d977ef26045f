// SPDX-License-Identifier: Apache-2.0
#include "formats/base/text_scanner.h"

#include <algorithm>

#include "formats/base/text.h"

namespace relief {
namespace {

bool isBlank(char c) {
    return c == ' ' || c == '\t' || c == '\v' || c == '\f';
}

}  // namespace

TextScanner::TextScanner(std::string_view text, TextRules rules) : rules_(rules) {
    text = withoutByteOrderMark(text);
    // npos + 1 is 0.
    text = text.substr(0, text.find_last_not_of(std::string_view("\0\x1a", 2)) + 1);
    at_ = text.data();
    end_ = text.data() + text.size();
}

std::size_t TextScanner::lineEnd(const char* at) const {
    if (at == end_ || (*at != '\n' && *at != '\r')) {
        return 0;
    }
    return *at == '\r' && end_ - at > 1 && at[1] == '\n' ? 2 : 1;
}

std::size_t TextScanner::joint(const char* at) const {
    if (!rules_.continues || at == end_ || *at != '\\') {
        return 0;
    }
    const char* behind = at + 1;
    while (behind != end_ && isBlank(*behind)) {
        ++behind;
    }
    const std::size_t length = lineEnd(behind);
    return behind == end_ || length > 0 ? static_cast<std::size_t>(behind - at) + length : 0;
}

void TextScanner::skipBlanks(bool over_lines) {
    while (at_ != end_) {
        if (isBlank(*at_)) {
            ++at_;
        } else if (const std::size_t joined = joint(at_); joined > 0) {
            at_ += joined;
            ++line_;
        } else if (rules_.comment != '\0' && *at_ == rules_.comment) {
            while (at_ != end_ && lineEnd(at_) == 0) {
                ++at_;
            }
        } else if (const std::size_t length = over_lines ? lineEnd(at_) : 0; length > 0) {
            at_ += length;
            ++line_;
        } else {
            return;
        }
    }
}

std::string_view TextScanner::popWord() {
    const std::size_t line = line_;
    const char* const begin = at_;
    while (at_ != end_ && *at_ != '\n' && *at_ != '\r' && !isBlank(*at_) &&
           (rules_.comment == '\0' || *at_ != rules_.comment) && joint(at_) == 0) {
        ++at_;
    }
    word_line_ = at_ == begin ? word_line_ : line;
    return {begin, static_cast<std::size_t>(at_ - begin)};
}

std::string_view TextScanner::word() {
    skipBlanks(false);
    return popWord();
}

std::string_view TextScanner::anyWord() {
    skipBlanks(true);
    return popWord();
}

bool TextScanner::atLineEnd() {
    skipBlanks(false);
    return at_ == end_ || lineEnd(at_) > 0;
}

std::string_view TextScanner::restOfLine() {
    word_line_ = line_;
    const char* const begin = at_;
    while (at_ != end_ && lineEnd(at_) == 0) {
        if (const std::size_t joined = joint(at_); joined > 0) {
            at_ += joined;
            ++line_;
        } else {
            ++at_;
        }
    }
    return trimmed({begin, static_cast<std::size_t>(at_ - begin)});
}

bool TextScanner::nextLine() {
    // A backslash at the end of a comment does not continue the line.
    for (bool in_comment = false; at_ != end_ && lineEnd(at_) == 0;) {
        in_comment = in_comment || (rules_.comment != '\0' && *at_ == rules_.comment);
        const std::size_t joined = in_comment ? 0 : joint(at_);
        line_ += joined > 0 ? 1 : 0;
        at_ += std::max<std::size_t>(joined, 1);
    }
    at_ += lineEnd(at_);
    ++line_;
    return at_ != end_;
}

std::string_view TextScanner::rest() const {
    return {at_, static_cast<std::size_t>(end_ - at_)};
}

CsvReader::CsvReader(std::string_view text) : text_(withoutByteOrderMark(text)) {}

bool CsvReader::next() {
    do {
        if (text_.empty()) {
            return false;
        }
        line_ = trimmed(popLine(text_));
        ++number_;
    } while (line_.empty() || line_.starts_with('#'));
    fields_.clear();
    std::string_view rest = line_;
    for (bool more = true; more && fields_.size() <= kFieldsMax;) {
        const std::size_t comma = rest.find(',');
        more = comma != std::string_view::npos;
        fields_.push_back(trimmed(rest.substr(0, comma)));
        rest.remove_prefix(more ? comma + 1 : rest.size());
    }
    return true;
}

}  // namespace relief

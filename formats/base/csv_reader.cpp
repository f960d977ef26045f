#include "formats/base/csv_reader.h"

#include "formats/base/text.h"

namespace relief {

CsvReader::CsvReader(std::string_view text) : text_(withoutByteOrderMark(text)) {}

bool CsvReader::next() {
    do {
        if (text_.empty()) {
            return false;
        }
        line_ = trimmed(takeLine(text_));
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

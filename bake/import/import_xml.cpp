#include "bake/import/import_xml.h"

#include <algorithm>
#include <cstdint>

#include "formats/base/text.h"

namespace relief {
namespace {

constexpr std::string_view kSpace = " \t\r\n";
constexpr std::size_t kQuotedMax = 40;  // bytes of the file shown in a message

void appendUtf8(std::string& out, std::uint32_t c) {
    const auto tail = [&](int shift) { out += static_cast<char>(0x80U | ((c >> shift) & 0x3FU)); };
    if (c < 0x80) {
        out += static_cast<char>(c);
    } else if (c < 0x800) {
        out += static_cast<char>(0xC0U | (c >> 6U));
        tail(0);
    } else if (c < 0x10000) {
        out += static_cast<char>(0xE0U | (c >> 12U));
        tail(6);
        tail(0);
    } else {
        out += static_cast<char>(0xF0U | (c >> 18U));
        tail(12);
        tail(6);
        tail(0);
    }
}

std::string fromUtf16(std::span<const std::byte> bytes, bool big_endian) {
    std::string text;
    text.reserve(bytes.size() / 2);
    const auto unit = [&](std::size_t i) {
        const auto first = std::to_integer<std::uint32_t>(bytes[i]);
        const auto second = std::to_integer<std::uint32_t>(bytes[i + 1]);
        return big_endian ? first << 8U | second : second << 8U | first;
    };
    for (std::size_t i = 0; i + 1 < bytes.size(); i += 2) {
        std::uint32_t c = unit(i);
        if (c >= 0xD800 && c < 0xDC00 && i + 3 < bytes.size()) {
            const std::uint32_t low = unit(i + 2);
            if (low >= 0xDC00 && low < 0xE000) {
                c = 0x10000 + ((c - 0xD800) << 10U) + (low - 0xDC00);
                i += 2;
            }
        }
        appendUtf8(text, c >= 0xD800 && c < 0xE000 ? 0xFFFD : c);
    }
    return text;
}

}  // namespace

std::string xmlText(std::span<const std::byte> bytes) {
    const std::string_view text(reinterpret_cast<const char*>(bytes.data()), bytes.size());
    using namespace std::string_view_literals;
    if (text.starts_with("\xff\xfe"sv) || text.starts_with("\xfe\xff"sv)) {
        return fromUtf16(bytes.subspan(2), text[0] == '\xfe');
    }
    if (text.starts_with("<\0"sv) || text.starts_with("\0<"sv)) {
        return fromUtf16(bytes, text[0] == '\0');
    }
    return std::string(text.substr(text.starts_with("\xef\xbb\xbf"sv) ? 3 : 0));
}

Result<XmlReader::Event> XmlReader::next() {
    if (ends_) {
        ends_ = false;
        leaves_ = true;
        return Event::kEnd;
    }
    if (leaves_) {
        leaves_ = false;
        path_.pop_back();
    }
    while (at_ < text_.size()) {
        event_at_ = at_;
        const std::string_view rest = text_.substr(at_);
        if (rest[0] != '<' || rest.starts_with("<![CDATA[")) {
            const bool literal = rest[0] == '<';
            const std::size_t end = std::min(rest.find(literal ? "]]>" : "<"), rest.size());
            at_ += std::min(end + (literal ? 3 : 0), rest.size());
            const std::string_view raw =
                literal ? rest.substr(9, std::max<std::size_t>(end, 9) - 9) : rest.substr(0, end);
            if (raw.find_first_not_of(kSpace) == std::string_view::npos) {
                continue;
            }
            if (path_.empty()) {
                return wrong("text outside of its elements");
            }
            piece_ = raw;
            if (!literal) {
                piece_ = RELIEF_TRY(unescaped(raw));
            }
            return Event::kText;
        }
        if (rest.starts_with("<!") || rest.starts_with("<?")) {
            RELIEF_TRY(skipMarkup());
            continue;
        }
        if (rest.starts_with("</")) {
            RELIEF_TRY(readEndTag());
            leaves_ = true;
            return Event::kEnd;
        }
        RELIEF_TRY(readStartTag());
        return Event::kBegin;
    }
    event_at_ = text_.size();
    if (!path_.empty()) {
        return wrong("it ends within <" + cleanUtf8(path_.back(), kQuotedMax) +
                     ">; it was probably cut off, copy or export it again");
    }
    return rooted_ ? Result<Event>(Event::kDone) : wrong("it has no element");
}

bool XmlReader::at(std::initializer_list<std::string_view> path) const {
    return path.size() == path_.size() &&
           std::equal(path.begin(), path.end(), path_.begin(),
                      [](std::string_view a, std::string_view b) { return a == local(b); });
}

std::optional<std::string> XmlReader::attribute(std::string_view name) const {
    for (const Attribute& attribute : attributes_) {
        if (local(attribute.name) == name && !attribute.name.starts_with("xmlns:")) {
            return attribute.value;
        }
    }
    return std::nullopt;
}

std::string XmlReader::where() const {
    const std::string_view before = text_.substr(0, event_at_);
    return "line " + std::to_string(1 + std::count(before.begin(), before.end(), '\n')) + ": ";
}

tl::unexpected<Error> XmlReader::wrong(const std::string& what) const {
    return fail(ErrorCode::kInvalidInput, "its XML is damaged: " + where() + what);
}

std::string_view XmlReader::local(std::string_view name) {
    return name.substr(name.find(':') + 1);  // npos + 1 is 0
}

Result<void> XmlReader::skipMarkup() {
    const std::string_view rest = text_.substr(at_);
    std::size_t end = std::string_view::npos;
    if (rest.starts_with("<!--")) {
        end = rest.find("-->", 4);
        end += end == std::string_view::npos ? 0 : 3;
    } else if (rest.starts_with("<?")) {
        end = rest.find("?>", 2);
        end += end == std::string_view::npos ? 0 : 2;
    } else {
        // DOCTYPE, with declarations in brackets.
        std::size_t nested = 0;
        for (std::size_t i = 1; i < rest.size() && end == std::string_view::npos; ++i) {
            nested += rest[i] == '<' || rest[i] == '[' ? 1 : 0;
            if (rest[i] == ']' || (rest[i] == '>' && nested > 0)) {
                nested -= nested > 0 ? 1 : 0;
            } else if (rest[i] == '>') {
                end = i + 1;
            }
        }
    }
    if (end == std::string_view::npos) {
        return wrong("'" + cleanUtf8(rest.substr(0, 9)) + "' has no end");
    }
    at_ += end;
    return {};
}

Result<void> XmlReader::readStartTag() {
    if (path_.empty() && rooted_) {
        return wrong("a second element beside the first");
    }
    rooted_ = true;
    ++at_;
    const std::string_view name = takeName();
    if (name.empty()) {
        return wrong("'<' that begins no element");
    }
    attributes_.clear();
    for (;;) {
        skipSpace();
        const std::string_view rest = text_.substr(at_);
        if (rest.starts_with('>') || rest.starts_with("/>")) {
            ends_ = rest[0] == '/';
            at_ += ends_ ? 2 : 1;
            path_.push_back(name);
            return {};
        }
        const std::string_view key = takeName();
        skipSpace();
        if (key.empty() || !text_.substr(at_).starts_with('=')) {
            return wrong("<" + cleanUtf8(name, kQuotedMax) + "> has an attribute without a value, or no end");
        }
        ++at_;
        skipSpace();
        const char quote = at_ < text_.size() ? text_[at_] : '\0';
        const std::size_t end =
            quote == '"' || quote == '\'' ? text_.find(quote, at_ + 1) : std::string_view::npos;
        if (end == std::string_view::npos) {
            return wrong("the value of '" + cleanUtf8(key, kQuotedMax) + "' is not in quotation marks");
        }
        std::string value = RELIEF_TRY(unescaped(text_.substr(at_ + 1, end - at_ - 1)));
        attributes_.push_back({key, std::move(value)});
        at_ = end + 1;
    }
}

Result<void> XmlReader::readEndTag() {
    at_ += 2;
    const std::string_view name = takeName();
    skipSpace();
    if (path_.empty() || name != path_.back() || !text_.substr(at_).starts_with('>')) {
        return wrong("</" + cleanUtf8(name, kQuotedMax) + "> ends no element" +
                     (path_.empty() ? "" : ", where <" + cleanUtf8(path_.back(), kQuotedMax) + "> is open"));
    }
    ++at_;
    return {};
}

Result<std::string> XmlReader::unescaped(std::string_view raw) const {
    struct Entity {
        std::string_view name;
        std::uint32_t character;
    };
    constexpr Entity kEntities[] = {{"lt", '<'}, {"gt", '>'}, {"amp", '&'}, {"quot", '"'}, {"apos", '\''}};
    std::string text;
    for (std::size_t i = raw.find('&'); i != std::string_view::npos; i = raw.find('&')) {
        text += raw.substr(0, i);
        const std::size_t end = std::min(raw.find(';', i), raw.size());
        const std::string_view name = raw.substr(i + 1, end - i - 1);
        std::uint32_t character = 0;
        for (const Entity& entity : kEntities) {
            character = name == entity.name ? entity.character : character;
        }
        if (name.starts_with('#')) {
            const bool hexadecimal = name.starts_with("#x");
            for (const char c : name.substr(hexadecimal ? 2 : 1)) {
                const std::string_view digits = "0123456789abcdef";
                const std::size_t digit = digits.find(c >= 'A' && c <= 'F' ? static_cast<char>(c + 32) : c);
                const std::uint32_t base = hexadecimal ? 16 : 10;
                character = digit < base && character < 0x110000
                                ? base * character + static_cast<std::uint32_t>(digit)
                                : 0x110000;
            }
        }
        if (end == raw.size() || character == 0 || character > 0x10FFFF) {
            return wrong("'" + cleanUtf8(raw.substr(i, std::min(end - i + 1, kQuotedMax))) +
                         "' is no character that XML knows");
        }
        appendUtf8(text, character);
        raw.remove_prefix(end + 1);
    }
    return text += raw;
}

std::string_view XmlReader::takeName() {
    constexpr std::string_view kNoName = " \t\r\n<>/='\"&?";
    const std::size_t end = std::min(text_.find_first_of(kNoName, at_), text_.size());
    const std::string_view name = text_.substr(at_, end - at_);
    at_ = end;
    return name;
}

void XmlReader::skipSpace() {
    at_ = std::min(text_.find_first_not_of(kSpace, at_), text_.size());
}

}  // namespace relief

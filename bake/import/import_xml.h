// XML as mesh formats have it (3MF, AMF, COLLADA): one element, end or text after the other, without memory of what is past.
#pragma once

#include <cstddef>
#include <initializer_list>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "formats/base/result.h"

namespace relief {

/// The document in UTF-8: UTF-16 is told by its mark or its zeros, every other encoding stays as it is.
[[nodiscard]] std::string xmlText(std::span<const std::byte> bytes);

/// Reads what XML 1.0 calls well-formed, without the parts that no mesh has: entities of a document's own are errors, and
/// its DOCTYPE is not looked at.
class XmlReader {
  public:
    enum class Event : std::uint8_t {
        kBegin,  ///< a start tag; of an element without content kEnd follows
        kEnd,
        kText,  ///< of the innermost element; not only white space, comments left out, perhaps in several pieces
        kDone,
    };

    /// \param text  borrowed.
    explicit XmlReader(std::string_view text) : text_(text) {}

    /// Errors: kInvalidInput, without the file's name.
    [[nodiscard]] Result<Event> next();

    /// Of the element that the event is of, without its prefix.
    [[nodiscard]] std::string_view name() const { return local(path_.back()); }
    /// Whether the event is of an element of these names, from the root on.
    [[nodiscard]] bool at(std::initializer_list<std::string_view> path) const;
    [[nodiscard]] std::size_t depth() const { return path_.size(); }  ///< 1: the event is of the root

    /// Of the start tag that was read last. \param name  without a prefix: whatever its prefix is.
    [[nodiscard]] std::optional<std::string> attribute(std::string_view name) const;
    /// Of the start tag that was read last, with their prefixes.
    struct Attribute {
        std::string_view name;
        std::string value;
    };
    [[nodiscard]] const std::vector<Attribute>& attributes() const { return attributes_; }
    /// Of kText.
    [[nodiscard]] const std::string& text() const { return piece_; }

    /// "line 12: " of the event, for messages.
    [[nodiscard]] std::string where() const;

  private:
    [[nodiscard]] tl::unexpected<Error> wrong(const std::string& what) const;
    [[nodiscard]] static std::string_view local(std::string_view name);
    [[nodiscard]] Result<void> skipMarkup();
    [[nodiscard]] Result<void> readStartTag();
    [[nodiscard]] Result<void> readEndTag();
    [[nodiscard]] Result<std::string> unescaped(std::string_view raw) const;
    [[nodiscard]] std::string_view takeName();
    void skipSpace();

    std::string_view text_;
    std::size_t at_ = 0;
    std::size_t event_at_ = 0;
    std::vector<std::string_view> path_;
    std::vector<Attribute> attributes_;
    std::string piece_;
    bool ends_ = false;    ///< the element that was begun has no content
    bool leaves_ = false;  ///< the event before was the end of the innermost element
    bool rooted_ = false;
};

}  // namespace relief

// XML as mesh formats have it (3MF, AMF, COLLADA): one element, end or text after the other, by Expat.
#pragma once

#include <cstddef>
#include <initializer_list>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "formats/base/result.h"

namespace relief {

/// Reads well-formed XML 1.0 of any encoding; the bytes of one that Expat does not know stay as they are. Entities of a
/// document's own are errors.
class XmlReader {
  public:
    enum class Event : std::uint8_t {
        kBegin,  ///< a start tag; of an element without content kEnd follows
        kEnd,
        kText,  ///< of the innermost element, up to the next tag; not only white space, comments left out
        kDone,
    };
    struct Attribute {
        std::string name;  ///< with its prefix
        std::string value;
    };

    /// \param document  borrowed.
    explicit XmlReader(std::span<const std::byte> document);
    ~XmlReader();
    XmlReader(XmlReader&&) noexcept;
    XmlReader& operator=(XmlReader&&) = delete;

    /// Errors: kInvalidInput, without the file's name. Throws std::bad_alloc.
    [[nodiscard]] Result<Event> next();

    /// Of the element that the event is of, without its prefix.
    [[nodiscard]] std::string_view name() const;
    /// \return true if the event is of an element of these names, from the root on.
    [[nodiscard]] bool at(std::initializer_list<std::string_view> path) const;
    [[nodiscard]] std::size_t depth() const;  ///< 1: the event is of the root
    /// Of the start tag that was read last. \param name  without a prefix: whatever its prefix is.
    [[nodiscard]] std::optional<std::string> attribute(std::string_view name) const;
    [[nodiscard]] const std::vector<Attribute>& attributes() const;
    [[nodiscard]] const std::string& text() const;  ///< of kText
    /// "line 12: " of the event, for messages.
    [[nodiscard]] std::string where() const;

  private:
    struct State;
    std::unique_ptr<State> state_;
};

}  // namespace relief

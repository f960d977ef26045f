// A struct, described once: beside it stands one function that visits its fields, and from that are derived the readers,
// the writers, the schemas and the tables of the documentation.
//
//     struct Attractor {
//         glm::vec3 position{0.0F};
//         float radius = 0.0F;
//     };
//
//     template <class Visitor, FieldsOf<Attractor> A>
//     void fields(Visitor& visit, A& a) {
//         visit("position", a.position, {.help = "Centre of attraction", .unit = "[x, y, z]", .range = within(kLengthMax)});
//         visit("radius", a.radius, {.help = "Softens the force near the centre", .range = {0.0, kLengthMax, false}});
//     }
//
// A visitor is an object with a template operator()(std::string_view name, T& value, const FieldInfo& info). It decides by T:
// numbers, bool, text, paths, glm::vec3, enumerations that have words, structs with fields() of their own, and optionals,
// vectors and maps of these. What holds between fields (one excludes another) is a second function of the struct's own.
// Of a report, which is only written, fields() may visit expressions as well as members.
#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <concepts>
#include <cstddef>
#include <limits>
#include <optional>
#include <span>
#include <string_view>
#include <type_traits>
#include <utility>
#include <vector>

namespace relief {

/// Of a number, or of each component of a vector; of a text, its length in bytes is not meant.
struct FieldRange {
    double low = -std::numeric_limits<double>::infinity();
    double high = std::numeric_limits<double>::infinity();
    bool low_included = true;

    [[nodiscard]] constexpr bool holds(double value) const {  // false for NaN
        return (low_included ? value >= low : value > low) && value <= high;
    }
};

constexpr FieldRange within(double limit) {
    return {-limit, limit};
}
inline constexpr FieldRange kFromZero{0.0};
inline constexpr FieldRange kFromOne{1.0};
inline constexpr FieldRange kShareRange{0.0, 1.0};
inline constexpr FieldRange kPercentRange{0.0, 100.0};

/// A literal as an argument of a template.
template <std::size_t kSize>
struct FieldWord {
    char text[kSize];
    constexpr FieldWord(const char (&word)[kSize]) { std::copy_n(word, kSize, text); }  // NOLINT: implicit
};
/// The only values of a field that is text, or of a number in digits: `.words = kWords<"less", "greater">`.
template <FieldWord... kWord>
inline constexpr std::array<std::string_view, sizeof...(kWord)> kWords{kWord.text...};

/// All that is known of a field beside its name, its type and its default, which is the value in a new struct.
struct FieldInfo {
    std::string_view help;       ///< one sentence, plain text; schemas, tables and --help show it
    std::string_view unit = {};  ///< "s", "1/s²", "[x, y, z]", "bytes"; empty: none
    FieldRange range = {};
    std::string_view fallback =
        {};  ///< the default in words, where it depends on other things: "the size of the mesh"
    std::string_view needs = {};  ///< in words, for tables: "needs drag"
    bool required = false;
    std::span<const std::string_view> words = {};  ///< see kWords; empty: any
    std::string_view pattern = {};                 ///< of a text, as JSON Schema takes it; empty: any
    FieldRange items = kFromZero;                  ///< how many a vector may have
    bool left_out = false;  ///< in JSON: without a value, or empty, it is left out instead of null or []
};

/// S is T or const T: what the second parameter of fields() is.
template <class S, class T>
concept FieldsOf = std::same_as<std::remove_const_t<S>, T>;

/// The words of an enumeration in the order of its values, which count from 0. Specialized beside the enumeration.
template <class Enum>
inline constexpr std::array<std::string_view, 0> kWordsOf{};

template <class Enum>
concept WithWords = std::is_enum_v<Enum> &&(kWordsOf<Enum>.size() > 0);

template <WithWords Enum>
[[nodiscard]] constexpr std::string_view wordOf(Enum value) {
    return kWordsOf<Enum>.at(static_cast<std::size_t>(value));
}

template <WithWords Enum>
[[nodiscard]] constexpr std::optional<Enum> fromWord(std::string_view word) {
    for (std::size_t i = 0; i < kWordsOf<Enum>.size(); ++i) {
        if (kWordsOf<Enum>[i] == word) {
            return static_cast<Enum>(i);
        }
    }
    return std::nullopt;
}

/// An object of a report that has no struct of its own, made by the next two.
template <class Visit>
struct FieldGroup {
    Visit visit_fields;
    bool nullable = false;
    bool present = true;  ///< else it is null
};
/// visit("bounds", group([&](auto& visit) { visit("min", …); }), {…})
template <class Visit>
[[nodiscard]] FieldGroup<Visit> group(Visit visit_fields) {
    return {std::move(visit_fields)};
}
/// The same or null. For its schema the fields are visited although it is not present.
template <class Visit>
[[nodiscard]] FieldGroup<Visit> groupIf(bool present, Visit visit_fields) {
    return {std::move(visit_fields), true, present};
}
template <class Visitor, class Visit>
void fields(Visitor& visit, const FieldGroup<Visit>& all) {
    all.visit_fields(visit);
}

/// Null where the condition is false.
template <class T>
[[nodiscard]] std::optional<T> onlyIf(bool condition, T value) {
    return condition ? std::optional<T>(std::move(value)) : std::nullopt;
}
/// A view of each: `viewsOf<PlaceReport>(places, collider)` makes PlaceReport{place, collider} of each place.
template <class View, class T, class... More>
[[nodiscard]] std::vector<View> viewsOf(const std::vector<T>& all, const More&... more) {
    std::vector<View> views;
    for (const T& one : all) {
        views.push_back(View{one, more...});
    }
    return views;
}
/// Null where a number is infinite or NaN.
[[nodiscard]] inline std::optional<double> finite(double value) {
    return std::isfinite(value) ? std::optional(value) : std::nullopt;
}
/// Null where a text is empty.
[[nodiscard]] inline std::optional<std::string_view> nonEmpty(std::string_view text) {
    return text.empty() ? std::nullopt : std::optional(text);
}

/// An empty T. References of a view are initialized with it, so that a schema can be made from the view's type alone.
template <class T>
inline const T kNone{};

/// Takes anything: for the concept below.
struct AnyVisitor {
    template <class T>
    void operator()(std::string_view, T&&, const FieldInfo&) {}
};

template <class T>
concept WithFields = requires(AnyVisitor& visit, T& value) {
    fields(visit, value);
};

}  // namespace relief

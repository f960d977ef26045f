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
//         visit("position", a.position, {"Centre of attraction", "[x, y, z]", within(kLengthMax)});
//         visit("radius", a.radius, {"Softens the force near the centre", {}, {0.0, kLengthMax, false}});
//     }
//
// A visitor is an object with a template operator()(std::string_view name, T& value, const FieldInfo& info). It decides by T:
// numbers, bool, text, paths, glm::vec3, enumerations that have words, structs with fields() of their own, and optionals,
// vectors and maps of these. Where the file joins what the struct keeps apart, fields() visits a FieldSpan, a FieldPair or
// another of the joints below. Rules between fields that FieldInfo cannot hold are a second function of the struct's own,
// check(). Of a report, which is only written, fields() may visit expressions as well as members.
#pragma once

#include <algorithm>
#include <array>
#include <concepts>
#include <cstddef>
#include <functional>
#include <limits>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <type_traits>
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

/// Rules of a field that is read from a file. Lists of keys or words have a space between two.
struct FieldRules {
    std::string_view needs = {};       ///< keys, without any of which this one has no effect
    std::string_view instead_of = {};  ///< keys that this one excludes
    std::string_view only = {};        ///< words of the selecting field that this one is for
    /// Key of the top level: the value is an index into its tables, or the name of one.
    std::string_view index_of = {};
    std::size_t most = std::numeric_limits<std::size_t>::max();  ///< elements, of a vector
    bool required = false;                                       ///< with `only`, for these words alone
    bool selects = false;   ///< an enumeration, whose value decides which other fields have a meaning
    bool chooses = false;   ///< given without the selecting field, this one sets that to its word of `only`
    bool single = false;    ///< a vector of tables that a single one stands for, too: [name] or [[name]]
    bool not_zero = false;  ///< 0 has no effect; a vector of zeros no direction
    bool unit_length = false;  ///< of a vector: not zero, and scaled to length 1
};

inline constexpr FieldRules kRequired{.required = true};

/// All that is known of a field beside its name, its type and its default, which is the value in a new struct.
struct FieldInfo {
    std::string_view help = {};  ///< one sentence, plain text; schemas, tables and --help show it
    std::string_view unit = {};  ///< "s", "1/s²", "[x, y, z]", "bytes"; empty: none
    FieldRange range = {};
    /// The default in words, where it depends on other things: "the size of the mesh".
    std::string_view fallback = {};
    FieldRules rules = {};
    std::span<const std::string_view> words = {};  ///< see kWords; empty: any
    std::string_view pattern = {};                 ///< of a text, as JSON Schema takes it; empty: any
    FieldRange items = kFromZero;                  ///< how many a vector may have
    /// In JSON it is left out without a value, empty, out of its range, or without any of the keys that it needs.
    bool left_out = false;
    std::string_view value = {};  ///< stands for the value in --help: "SECONDS"; empty: as the type has it
    /// A valid value, for messages: "a length above 0"; empty: as type and range have it.
    std::string_view must = {};
    char letter = '\0';     ///< of the short option: 'j'
    bool recorded = false;  ///< of a bake: decides the bytes of the collider, and is part of its provenance
};

[[nodiscard]] constexpr FieldInfo leftOut(FieldInfo info) {
    info.left_out = true;
    return info;
}

/// Two members for one value of the file: a number, or [least, most].
template <class A, class B = A>
struct FieldSpan {
    A& least;
    B& most;
};
template <class A, class B>
FieldSpan(A&, B&) -> FieldSpan<A, B>;

/// Two members for one value: always a pair, whose parts the unit names: "[width, height]".
template <class T>
struct FieldPair {
    T& first;
    T& second;
};
template <class T>
FieldPair(T&, T&) -> FieldPair<T>;

/// A member whose default depends on other things, and whether it was given.
template <class T, class Flag = bool>
struct FieldMaybe {
    T& value;
    Flag& given;
};
template <class T, class Flag>
FieldMaybe(T&, Flag&) -> FieldMaybe<T, Flag>;

/// A file that a file names, and where it does: "scene.toml:3:8", for messages.
template <class Path, class Text = std::string>
struct FieldFile {
    Path& path;
    Text& place;
};
template <class Path, class Text>
FieldFile(Path&, Text&) -> FieldFile<Path, Text>;

/// Fields that a file gives, by their path from the struct on: "key[1].time".
using GivenFields = std::function<bool(const std::string& path)>;

/// A mistake found by a struct's check().
struct FieldFault {
    std::string path;  ///< of the field at fault, as GivenFields has it; empty: the struct itself
    std::string text;  ///< goes on after the field's name: "does nothing without a name; give one"
};

/// S is T or const T: what the second parameter of fields() is.
template <class S, class T>
concept FieldsOf = std::same_as<std::remove_const_t<S>, T>;

/// The part of a struct that is its base, for the fields() of that.
template <class Base, class T>
[[nodiscard]] auto& baseOf(T& value) {
    return static_cast<std::conditional_t<std::is_const_v<T>, const Base, Base>&>(value);
}

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

/// Whether T is an instance of the template Form.
template <template <class...> class Form, class T>
inline constexpr bool kIsForm = false;
template <template <class...> class Form, class... Parts>
inline constexpr bool kIsForm<Form, Form<Parts...>> = true;

/// The type that an optional holds, or T itself.
template <class T>
struct HeldType {
    using Type = T;
};
template <class T>
struct HeldType<std::optional<T>> {
    using Type = T;
};
template <class T>
using Held = typename HeldType<T>::Type;

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

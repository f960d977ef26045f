// SPDX-License-Identifier: Apache-2.0
// Describes a struct once: a function beside it visits its fields. Readers, writers, schemas and documentation tables
// are derived from that function.
//
//     struct Attractor {
//         glm::vec3 position{0.0F};
//         float radius = 0.0F;
//     };
//
//     void fields(FieldVisitor& visit, Attractor& a);
//
// and in a source file
//
//     void fields(FieldVisitor& visit, Attractor& a) {
//         visit("position", a.position, {"Centre of attraction", "[x, y, z]", within(kLengthMax)});
//         visit("radius", a.radius, {"Softens the force near the centre", {}, {0.0, kLengthMax, false}});
//     }
//
// A visitor receives each field as a FieldRef, which carries its type (formats/base/field_type.h): numbers, bool, text,
// paths, glm::vec3, enumerations with words, structs with their own fields(), and optionals, vectors and arrays of
// these. If one value in a data file sets several members, fields() visits a FieldSpan, FieldPair or other adapter
// below. If FieldInfo cannot express a rule between fields, a second function, check(), enforces it (toml_reader.h).
// Report structs are only written: their fields() takes a const reference and may visit expressions and members.
#pragma once

#include <algorithm>
#include <array>
#include <concepts>
#include <cstddef>
#include <filesystem>
#include <functional>
#include <glm/fwd.hpp>
#include <limits>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <type_traits>
#include <utility>
#include <variant>

#include "formats/base/enum_words.h"
#include "formats/base/field_type.h"

namespace relief {

/// Valid range of a number, or of each component of a vector. Not used for the length of text.
struct FieldRange {
    double low = -std::numeric_limits<double>::infinity();
    double high = std::numeric_limits<double>::infinity();
    bool low_included = true;

    [[nodiscard]] constexpr bool holds(double value) const {  // false for NaN
        return (low_included ? value >= low : value > low) && value <= high;
    }
};

/// Returns "choose 1 to 5", "choose 1 or more", "choose more than 0, up to 5".
/// \param text  writes a limit.
[[nodiscard]] std::string rangeAdvice(const FieldRange& range, std::string (*text)(double));

constexpr FieldRange within(double limit) {
    return {-limit, limit};
}

inline constexpr FieldRange kFromZero{0.0};
inline constexpr FieldRange kFromOne{1.0};
inline constexpr FieldRange kFractionRange{0.0, 1.0};
inline constexpr FieldRange kPercentRange{0.0, 100.0};

/// A string literal as a template argument.
template <std::size_t kSize>
struct FieldWord {
    char text[kSize];
    constexpr FieldWord(const char (&word)[kSize]) { std::copy_n(word, kSize, text); }  // NOLINT: implicit
};
/// The valid values of a text, number or bool field, as strings: `.words = kWords<"less", "greater">`.
template <FieldWord... kWord>
inline constexpr std::array<std::string_view, sizeof...(kWord)> kWords{kWord.text...};

/// Rules for a field that is read from a file. Lists of keys or words are separated by spaces.
struct FieldRules {
    std::string_view needs = {};       ///< the field requires at least one of these keys
    std::string_view instead_of = {};  ///< keys that this field excludes
    std::string_view only = {};        ///< values of the selecting field for which this field is valid
    /// Top-level key of tables; the field holds the index or the name of one of them.
    std::string_view index_of = {};
    std::size_t most = std::numeric_limits<std::size_t>::max();  ///< maximum number of elements of a vector
    bool required = false;  ///< if `only` is set, required only for those values
    bool selects = false;   ///< an enumeration that decides which other fields are valid
    bool chooses = false;   ///< if the selecting field is missing, this field sets it to the value in `only`
    bool single = false;    ///< a vector of tables that also accepts a single table: [name] or [[name]]
    bool not_zero = false;  ///< 0 (for a vector: the zero vector) is invalid
    bool unit_length = false;  ///< a nonzero vector, normalized on reading
};

inline constexpr FieldRules kRequired{.required = true};

/// Describes a field except its name, type and default. The default is the value in a newly constructed struct.
struct FieldInfo {
    std::string_view help = {};  ///< one sentence of plain text, shown in schemas, tables and --help
    std::string_view unit = {};  ///< "s", "1/s²", "[x, y, z]", "bytes"; empty: none
    FieldRange range = {};
    /// Describes a default that depends on other values: "the size of the mesh".
    std::string_view fallback = {};
    FieldRules rules = {};
    std::span<const std::string_view> words = {};  ///< see kWords; empty: any
    std::string_view pattern = {};  ///< regular expression for text, in JSON Schema syntax; empty: any
    FieldRange items = kFromZero;   ///< number of elements of a JSON array
    /// Omit the field from JSON if it is unset, empty or out of range, or if no key in `needs` is present.
    bool left_out = false;
    std::string_view value = {};  ///< placeholder in --help: "SECONDS"; empty: derived from the type
    /// Describes a valid value in messages: "a length above 0"; empty: derived from type and range.
    std::string_view must = {};
    char letter = '\0';     ///< short option: 'j'
    bool recorded = false;  ///< bake options: affects the collider's bytes and is recorded in its provenance
    std::string_view details = {};  ///< more sentences, for --manual and the manual pages
};

[[nodiscard]] constexpr FieldInfo leftOut(FieldInfo info) {
    info.left_out = true;
    return info;
}

/// Two members, possibly optional, that share one value in the file: a number, or [least, most].
struct FieldSpan {
    FieldRef least;
    FieldRef most;
};

/// Two members that are always a pair in the file; FieldInfo::unit names both: "[width, height]".
struct FieldPair {
    FieldRef first;
    FieldRef second;
};

/// A member whose default depends on other values, and a flag that is set if the file contains the member.
struct FieldMaybe {
    FieldRef value;
    bool& given;
};

/// A path or name, and its source position for messages: "scene.toml:3:8".
struct FieldPlaced {
    FieldRef value;
    std::string& place;
};

/// A report object that has no struct of its own (formats/fields/field.h).
struct FieldGroup {
    const void* of;
    void (*visit)(const void* of, FieldVisitor& visit);
    bool nullable = false;
    bool present = true;  ///< false: written as null
};

/// Whether T is an instance of the template Form.
template <template <class...> class Form, class T>
inline constexpr bool kIsForm = false;
template <template <class...> class Form, class... Parts>
inline constexpr bool kIsForm<Form, Form<Parts...>> = true;

/// A type with its own text form provides fieldText(value), and parseText(word, value), which returns false if the word
/// is not valid.
template <class T>
concept WithForm = requires(std::string_view word, T& value) {
    { parseText(word, value) } -> std::same_as<bool>;
    { fieldText(value) } -> std::same_as<std::string>;
};

/// Functions of a type with its own file format. Specialize this variable beside the type.
template <class T>
inline constexpr const FieldCustom* kFieldCustom = nullptr;

namespace fields_detail {

/// Converts only to T&, not to a base of T.
template <class T>
struct Exactly {
    template <class U>
    requires std::same_as<std::remove_const_t<U>, T>
    operator U&() const;  // NOLINT: implicit
};

template <class T>
concept Text = std::convertible_to<const T&, std::string_view>;
template <class T>
concept Items = requires(T& value) {
    std::data(value);
    std::size(value);
};
template <class T>
inline constexpr bool kIsArray = false;
template <class T, std::size_t kSize>
inline constexpr bool kIsArray<std::array<T, kSize>> = true;
/// A struct whose kinds have different fields: `static std::vector<T> kinds()` returns one value of each kind.
template <class T>
concept WithKinds = requires {
    T::kinds();
};

}  // namespace fields_detail

template <class T>
concept WithFields = requires(FieldVisitor& visit, fields_detail::Exactly<T> value) {
    fields(visit, value);
};

namespace fields_detail {

template <class T>
struct Described {
    static const FieldType type;
};

template <class T>
constexpr void describeStruct(FieldType& type) {
    type.fields = [](FieldVisitor& visit, void* value) { fields(visit, *static_cast<T*>(value)); };
    if constexpr (requires(T & value, const GivenFields& given) { check(value, given); }) {
        type.check = [](void* value, const GivenFields& given) {
            return check(*static_cast<T*>(value), given);
        };
    }
    if constexpr (requires(T & value, std::string place) { value.place = place; }) {
        type.set_place = [](void* value, std::string place) {
            static_cast<T*>(value)->place = std::move(place);
        };
    }
    if constexpr (WithKinds<T>) {
        type.kinds = [](const std::function<void(FieldRef)>& each) {
            for (const T& one : T::kinds()) {
                each(one);
            }
        };
    }
}

template <class... Types>
inline constexpr std::array<const FieldType*, sizeof...(Types)> kTypes{&Described<const Types>::type...};

template <class... Types>
constexpr void describeVariant(FieldType& type, const std::variant<Types...>* /*unused*/) {
    type.alternatives = kTypes<Types...>;
    type.chosen = [](void* value) {
        return std::visit([](auto& one) { return FieldRef(std::as_const(one)); },
                          *static_cast<std::variant<Types...>*>(value));
    };
}

/// \tparam Given  T, or const T for a value that is output but never read from a file
template <class Given>
constexpr FieldType describe() {
    using T = std::remove_const_t<Given>;
    constexpr bool kWritten = std::is_const_v<Given>;
    FieldType type{.size = sizeof(T), .custom = kFieldCustom<T>};
    if constexpr (std::is_default_constructible_v<T> && !std::is_array_v<T>) {
        type.blank = []() -> void* {
            static T value{};
            return &value;
        };
    }
    if constexpr (WithForm<T>) {
        type.read_form = [](std::string_view word, void* value) {
            return parseText(word, *static_cast<T*>(value));
        };
        type.form_text = [](const void* value) { return fieldText(*static_cast<const T*>(value)); };
    } else if constexpr (std::same_as<T, bool>) {
        type.form = FieldForm::kBool;
    } else if constexpr (std::is_floating_point_v<T>) {
        type.form = FieldForm::kReal;
    } else if constexpr (std::is_integral_v<T>) {
        type.form = std::is_unsigned_v<T> ? FieldForm::kUnsigned : FieldForm::kSigned;
    } else if constexpr (WithWords<T>) {
        type.form = FieldForm::kWord;
        type.words = kWordsOf<T>;
    } else if constexpr (std::same_as<T, std::string>) {
        type.form = FieldForm::kString;
    } else if constexpr (std::same_as<T, std::filesystem::path>) {
        type.form = FieldForm::kPath;
    } else if constexpr (Text<T>) {
        type.form = FieldForm::kText;
        type.text = [](const void* value) { return std::string_view(*static_cast<const T*>(value)); };
    } else if constexpr (std::same_as<T, glm::vec3>) {
        type.form = FieldForm::kVector;
        type.held = &Described<float>::type;
        type.count = 3;
    } else if constexpr (kIsForm<std::optional, T>) {
        using Held = typename T::value_type;
        type.form = FieldForm::kOptional;
        type.held = &Described<std::conditional_t<kWritten, const Held, Held>>::type;
        type.items = [](void* value) {
            T& held = *static_cast<T*>(value);
            return held ? FieldItems{const_cast<std::remove_const_t<Held>*>(&*held), 1} : FieldItems{};
        };
        if constexpr (!kWritten) {
            type.add = [](void* value) -> void* { return &static_cast<T*>(value)->emplace(); };
        }
    } else if constexpr (std::same_as<T, FieldSpan>) {
        type.form = FieldForm::kSpan;
    } else if constexpr (std::same_as<T, FieldPair>) {
        type.form = FieldForm::kPair;
    } else if constexpr (std::same_as<T, FieldMaybe>) {
        type.form = FieldForm::kMaybe;
    } else if constexpr (std::same_as<T, FieldPlaced>) {
        type.form = FieldForm::kPlaced;
    } else if constexpr (std::same_as<T, FieldGroup>) {
        type.form = FieldForm::kGroup;
    } else if constexpr (kIsForm<std::variant, T>) {
        type.form = FieldForm::kVariant;
        describeVariant(type, static_cast<const T*>(nullptr));
    } else if constexpr (WithFields<T>) {
        type.form = FieldForm::kStruct;
        describeStruct<T>(type);
    } else if constexpr (kIsArray<T>) {
        using Held = typename T::value_type;
        type.form = FieldForm::kArray;
        type.held = &Described<std::conditional_t<kWritten, const Held, Held>>::type;
        type.count = std::tuple_size_v<T>;
    } else if constexpr (Items<T>) {
        using Held = std::remove_const_t<typename T::value_type>;
        type.form = FieldForm::kList;
        type.held = &Described<std::conditional_t<kWritten, const Held, Held>>::type;
        type.items = [](void* value) {
            T& list = *static_cast<T*>(value);
            return FieldItems{const_cast<Held*>(std::data(list)), std::size(list)};
        };
        if constexpr (!kWritten && requires(T & list) { list.emplace_back(); }) {
            type.add = [](void* value) -> void* { return &static_cast<T*>(value)->emplace_back(); };
            type.clear = [](void* value) { static_cast<T*>(value)->clear(); };
        }
    } else {
        static_assert(kFieldCustom<T> != nullptr,
                      "declare fields(), or parseText() and fieldText(), before this use");
    }
    return type;
}

template <class T>
constinit const FieldType Described<T>::type = describe<T>();

}  // namespace fields_detail

template <class T>
const FieldType& fieldType() {
    return fields_detail::Described<T>::type;
}

}  // namespace relief

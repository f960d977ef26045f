// SPDX-License-Identifier: Apache-2.0
// Field types without templates. A field visitor (formats/base/field.h) receives each value as a FieldRef: a pointer
// and a type description. The description is static data with function pointers, built by formats/base/field.h.
#pragma once

#include <cstddef>
#include <cstdint>
#include <functional>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <type_traits>

namespace relief {

struct FieldInfo;
struct FieldType;
class FieldRef;
class FieldVisitor;

/// Tests whether the file contains the field at a path, relative to the struct: "key[1].time".
using GivenFields = std::function<bool(const std::string& path)>;

/// An error reported by a struct's check().
struct FieldFault {
    std::string path;  ///< path of the field, as in GivenFields; empty: the struct itself
    std::string text;  ///< appended to the field's name: "has no effect without a name; give one"
};

enum class FieldForm : std::uint8_t {
    kBool,
    kUnsigned,
    kSigned,
    kReal,
    kWord,    ///< an enumeration
    kString,  ///< std::string
    kText,    ///< another type that converts to std::string_view; write-only
    kPath,    ///< std::filesystem::path
    kVector,  ///< glm::vec3
    kArray,   ///< std::array
    kList,    ///< std::vector, or any contiguous range if write-only
    kOptional,
    kVariant,  ///< write-only
    kSpan,     ///< FieldSpan (formats/base/field.h)
    kPair,     ///< FieldPair
    kMaybe,    ///< FieldMaybe
    kPlaced,   ///< FieldPlaced
    kGroup,    ///< FieldGroup
    kStruct,
    kCustom,  ///< FieldType::custom, or read_form and form_text
};

class TomlValue;   // formats/config/toml_value.h
struct FieldJson;  // formats/fields/json_value.h

/// Functions of a type with its own file format. If one is null, FieldForm decides.
struct FieldCustom {
    void (*read)(const TomlValue& from, void* value, const FieldInfo& info) = nullptr;
    void (*json)(const void* value, FieldJson& json) = nullptr;
    void (*schema)(FieldJson& schema) = nullptr;  ///< describes the output of `json`
};

/// Contiguous elements.
struct FieldItems {
    void* first = nullptr;
    std::size_t count = 0;
};

struct FieldType {
    FieldForm form = FieldForm::kCustom;
    std::uint32_t size = 0;                        ///< bytes of a value
    std::size_t count = 0;                         ///< elements of a vector or array
    std::span<const std::string_view> words = {};  ///< of an enumeration
    const FieldType* held = nullptr;               ///< type of the elements, or of an optional's value
    std::span<const FieldType* const> alternatives = {};
    const FieldCustom* custom = nullptr;

    void* (*blank)() = nullptr;                  ///< a default value; read-only
    FieldItems (*items)(void* value) = nullptr;  ///< list or optional
    void* (*add)(void* value) = nullptr;   ///< appends an element to a list, or emplaces an optional's value
    void (*clear)(void* value) = nullptr;  ///< of a list
    FieldRef (*chosen)(void* value) = nullptr;  ///< the value in a variant
    std::string_view (*text)(const void* value) = nullptr;

    // Structs:
    void (*fields)(FieldVisitor& visit, void* value) = nullptr;
    std::optional<FieldFault> (*check)(void* value, const GivenFields& given) = nullptr;
    void (*set_place)(void* value, std::string place) = nullptr;
    void (*kinds)(const std::function<void(FieldRef)>& each) = nullptr;

    // Types with their own text form:
    bool (*read_form)(std::string_view word, void* value) = nullptr;
    std::string (*form_text)(const void* value) = nullptr;
};

/// Returns the description of T. Use const T for values that are output but never read from a file.
template <class T>
[[nodiscard]] const FieldType& fieldType();

/// A reference to a value of any type that has a FieldType. Does not extend the lifetime of a temporary.
class FieldRef {
  public:
    template <class T>
    requires(!std::same_as<std::remove_cvref_t<T>, FieldRef>) FieldRef(T&& value)  // NOLINT: implicit
        : FieldRef(const_cast<void*>(static_cast<const void*>(std::addressof(value))),
                   fieldType<std::conditional_t<std::is_lvalue_reference_v<T>, std::remove_reference_t<T>,
                                                const std::remove_reference_t<T>>>()) {}
    FieldRef(void* value, const FieldType& type) : value_(value), type_(&type) {}

    [[nodiscard]] const FieldType& type() const { return *type_; }
    [[nodiscard]] FieldForm form() const { return type_->form; }
    [[nodiscard]] void* value() const { return value_; }
    template <class T>
    [[nodiscard]] T& as() const {
        return *static_cast<T*>(value_);
    }

    /// Returns the value of an optional, or a default value if empty; for other types, the value itself.
    [[nodiscard]] FieldRef valueOrDefault() const;
    /// Returns a default value of the type, which must have one.
    [[nodiscard]] FieldRef blank() const { return {type_->blank(), *type_}; }
    /// Access elements of a vector, array, list or optional.
    [[nodiscard]] std::size_t count() const;
    [[nodiscard]] FieldRef operator[](std::size_t i) const;
    /// Appends an element to a list, or emplaces an optional's value.
    [[nodiscard]] FieldRef add() const { return {type_->add(value_), *type_->held}; }
    /// Visits the fields of a struct or a group.
    void visit(FieldVisitor& visitor) const;

    // Numbers; enumerations count as the index of their word.
    [[nodiscard]] bool isNumber() const;  ///< false for bool
    [[nodiscard]] std::uint64_t whole() const;
    [[nodiscard]] std::int64_t integer() const;
    [[nodiscard]] double number() const;       ///< for every number type
    void setWhole(std::uint64_t value) const;  ///< truncated to the size of the type
    void setReal(double value) const;          ///< rounded to the type

    /// Strings, text and paths.
    [[nodiscard]] bool isText() const;
    [[nodiscard]] std::string_view text() const;
    [[nodiscard]] std::string_view word() const { return type_->words[static_cast<std::size_t>(whole())]; }
    [[nodiscard]] bool setWord(std::string_view word) const;  ///< false: no such word

  private:
    void* value_;
    const FieldType* type_;
};

/// Interface that fields() calls for each field.
class FieldVisitor {
  public:
    virtual ~FieldVisitor();
    virtual void operator()(std::string_view name, FieldRef value, const FieldInfo& info) = 0;
    /// Returns whether the visitor changes values; fields() may then allocate elements.
    [[nodiscard]] virtual bool fills() const { return false; }
};

}  // namespace relief

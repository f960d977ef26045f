// Reads a table of a TOML file into a struct with fields() (formats/base/field.h). Unknown keys, wrong types, values out of
// their range and keys that exclude each other are mistakes, each reported as "file:line:column: table.key …; the cure".
#pragma once

#include <array>
#include <cmath>
#include <cstdint>
#include <filesystem>
#include <glm/geometric.hpp>
#include <glm/vec3.hpp>
#include <limits>
#include <optional>
#include <string>
#include <string_view>
#include <type_traits>
#include <vector>

#include "formats/base/field.h"
#include "formats/base/result.h"
#include "formats/config/toml.h"

namespace relief {

/// As people write it: "0.1".
[[nodiscard]] std::string numberText(double value);
/// A line of text that a hostile file can neither break nor colour.
[[nodiscard]] std::string oneLine(std::string_view text);

/// A file, as its values know it.
struct TomlFile {
    std::string name;              ///< as messages have it
    std::filesystem::path folder;  ///< that the file's paths start from and may not leave (confined_path.h)
    std::filesystem::path root;    ///< another folder that they may lead to; empty: none
    std::string_view owner;        ///< of the folder, in messages: "scene"
    const toml::table* top = nullptr;
    bool is_text = true;  ///< false: its values have no lines and columns
};

/// Thrown by everything below where a value is wrong; readTomlFile() turns it into an Error.
struct TomlMistake {
    std::string message;
};

/// A value of a file with its key and its place. Cheap to copy; node and file must outlive it.
class TomlValue {
  public:
    /// \param name  "render.size"; empty for the file itself.
    TomlValue(const toml::node& node, std::string name, const TomlFile& file)
        : node_(&node), name_(std::move(name)), file_(&file) {}

    [[nodiscard]] const toml::node& node() const { return *node_; }
    [[nodiscard]] const toml::array* array() const { return node_->as_array(); }
    [[nodiscard]] const std::string& name() const { return name_; }
    [[nodiscard]] const TomlFile& file() const { return *file_; }
    [[nodiscard]] std::string place() const;  ///< "file:line:column", or "file" if it is no text
    /// "table.key"
    [[nodiscard]] std::string full(std::string_view key) const;

    /// The value at a path from here: "key", "emitter[1].key[0].time". A table is its own element 0.
    [[nodiscard]] std::optional<TomlValue> find(std::string_view path) const;
    /// An element of an array.
    [[nodiscard]] TomlValue operator[](std::size_t i) const { return {*array()->get(i), name_, *file_}; }

    [[nodiscard]] double number(const FieldRange& range) const;
    [[nodiscard]] std::int64_t whole(const FieldRange& range) const;
    [[nodiscard]] bool boolean() const;
    [[nodiscard]] std::string text() const;
    /// The index of one of `words`.
    [[nodiscard]] std::size_t word(std::span<const std::string_view> words) const;
    /// A path, resolved.
    [[nodiscard]] std::filesystem::path path() const;
    /// An index into the tables `key` of the top level, or the index of the one of that name.
    [[nodiscard]] std::int64_t indexOf(std::string_view key, const FieldRange& range) const;
    /// Numbers [a, b, …], as many as said. \param unit  begins with the names of the parts.
    [[nodiscard]] const toml::array& list(std::size_t size, bool whole, std::string_view unit) const;
    /// This table, or each table of this array.
    [[nodiscard]] std::vector<TomlValue> tables(const FieldInfo& info) const;
    void needTable() const;

    [[noreturn]] void wrongType(std::string_view wanted) const;
    [[noreturn]] void fail(const std::string& message) const;  ///< "place: message"

  private:
    const toml::node* node_;
    std::string name_;
    const TomlFile* file_;
};

/// The fields of a struct: what a table may hold.
class TableRules {
  public:
    template <class T>
    explicit TableRules(T& value) {
        fields(*this, value);
    }
    template <class T>
    void operator()(std::string_view name, T&&, const FieldInfo& info) {
        fields_.push_back({name, info});
    }

    /// Fails at the first key of the file that is no field.
    void refuseUnknown(const TomlValue& table) const;
    /// The word that the keys of a table without the selecting field choose; empty: none.
    [[nodiscard]] std::string_view chosen(const TomlValue& table) const;
    /// Fails where a key is missing, or has no effect beside the others or without them.
    /// \param selected  word of the selecting field; empty if there is no such field.
    void checkTable(const TomlValue& table, std::string_view selected) const;

  private:
    struct Field {
        std::string_view name;
        FieldInfo info;
    };
    void checkUse(const TomlValue& table, const Field& field, std::string_view selected) const;
    [[nodiscard]] std::string_view selector() const;

    std::vector<Field> fields_;
};

template <class T>
void readToml(const TomlValue& from, T& value);

namespace toml_detail {

template <class T>
inline constexpr bool kIsNumbers = std::is_same_v<T, glm::vec3>;
template <class T, std::size_t N>
inline constexpr bool kIsNumbers<std::array<T, N>> = true;

/// Above zero in the file, above zero in the struct.
template <class T>
T narrowed(double value, const FieldRange& range) {
    const T result = static_cast<T>(value);
    return range.low == 0.0 && !range.low_included && result == T{} ? std::numeric_limits<T>::min() : result;
}

template <class T>
void readNumber(const TomlValue& from, T& value, const FieldInfo& info) {
    if constexpr (std::is_integral_v<T>) {
        FieldRange range = info.range;
        range.low = std::max(range.low, static_cast<double>(std::numeric_limits<T>::min()));
        range.high = std::min(range.high, static_cast<double>(std::numeric_limits<T>::max()));
        value = static_cast<T>(info.rules.index_of.empty() ? from.whole(range)
                                                           : from.indexOf(info.rules.index_of, range));
    } else {
        value = narrowed<T>(from.number(info.range), info.range);
        if (info.rules.not_zero && value == T{}) {
            from.fail(from.name() + " does nothing as 0; raise it or remove it");
        }
    }
}

template <class T>
void readNumbers(const TomlValue& from, T& value, const FieldInfo& info) {
    constexpr bool kVector = std::is_same_v<T, glm::vec3>;
    constexpr std::size_t kSize = sizeof(T) / sizeof(value[0]);
    using Part = std::remove_reference_t<decltype(value[0])>;
    static_cast<void>(
        from.list(kSize, std::is_integral_v<Part>, kVector ? std::string_view("[x, y, z]") : info.unit));
    FieldInfo part = info;
    part.rules.not_zero = false;
    for (std::size_t i = 0; i < kSize; ++i) {
        readNumber(from[i], value[static_cast<int>(i)], part);
    }
    if constexpr (kVector) {
        // Scaled first: the square of a short vector would vanish.
        const float longest = std::max({std::abs(value.x), std::abs(value.y), std::abs(value.z)});
        if ((info.rules.not_zero || info.rules.unit_length) && !(longest >= 1e-30F)) {
            from.fail(from.name() + " has no direction; give one, as [0, 1, 0]");
        }
        if (info.rules.unit_length) {
            value = glm::normalize(value / longest);
        }
    }
}

template <class A, class B>
void readSpan(const TomlValue& from, FieldSpan<A, B> span, const FieldInfo& info) {
    using Number = Held<A>;
    const toml::array* both = from.array();
    if (both == nullptr ? !from.node().is_number() : both->size() != 2) {
        from.wrongType(std::is_integral_v<Number> ? "a whole number, or two [least, most]"
                                                  : "a number, or two [least, most]");
    }
    Number least{};
    Number most{};
    readNumber(both == nullptr ? from : from[0], least, info);
    readNumber(both == nullptr ? from : from[1], most, info);
    if (least > most) {
        from.fail(from.name() + " has its least above its most; swap them");
    }
    span.least = least;
    span.most = most;
}

template <class T>
void readPair(const TomlValue& from, FieldPair<T> pair, const FieldInfo& info) {
    using Number = Held<T>;
    static_cast<void>(from.list(2, std::is_integral_v<Number>, info.unit));
    Number both[2]{};
    readNumber(from[0], both[0], info);
    readNumber(from[1], both[1], info);
    pair.first = both[0];
    pair.second = both[1];
}

template <class T>
void readTables(const TomlValue& from, std::vector<T>& value, const FieldInfo& info) {
    value.clear();
    for (const TomlValue& table : from.tables(info)) {
        readToml(table, value.emplace_back());
    }
}

}  // namespace toml_detail

/// Reads one value. For a type of its own, a file declares readField(const TomlValue&, T, const FieldInfo&) beside it.
template <class T>
void readValue(const TomlValue& from, T&& value, const FieldInfo& info) {
    using namespace toml_detail;
    using Value = std::remove_cvref_t<T>;
    if constexpr (requires { readField(from, value, info); }) {
        readField(from, value, info);
    } else if constexpr (kIsForm<FieldSpan, Value>) {
        readSpan(from, value, info);
    } else if constexpr (kIsForm<FieldPair, Value>) {
        readPair(from, value, info);
    } else if constexpr (kIsForm<FieldMaybe, Value>) {
        readValue(from, value.value, info);
        value.given = true;
    } else if constexpr (kIsForm<FieldFile, Value>) {
        value.path = from.path();
        value.place = from.place();
    } else if constexpr (kIsForm<std::optional, Value>) {
        readValue(from, value.emplace(), info);
    } else if constexpr (std::is_same_v<Value, bool>) {
        value = from.boolean();
    } else if constexpr (std::is_arithmetic_v<Value>) {
        readNumber(from, value, info);
    } else if constexpr (WithWords<Value>) {
        value = static_cast<Value>(from.word(kWordsOf<Value>));
    } else if constexpr (std::is_same_v<Value, std::string>) {
        value = from.text();
    } else if constexpr (kIsNumbers<Value>) {
        readNumbers(from, value, info);
    } else if constexpr (kIsForm<std::vector, Value>) {
        readTables(from, value, info);
    } else {
        from.needTable();
        readToml(from, value);
    }
}

/// Reads the fields that a table gives.
class TableReader {
  public:
    TableReader(const TomlValue& table, std::string_view chosen) : table_(table), selected_(chosen) {}
    template <class T>
    void operator()(std::string_view name, T&& value, const FieldInfo& info) {
        const auto from = table_.find(name);
        if (from) {
            readValue(*from, value, info);
        }
        if constexpr (WithWords<std::remove_cvref_t<T>>) {
            if (info.rules.selects) {
                if (const auto word = fromWord<std::remove_cvref_t<T>>(selected_); word && !from) {
                    value = *word;
                }
                selected_ = wordOf(value);
            }
        }
    }
    [[nodiscard]] std::string_view selected() const { return selected_; }

  private:
    const TomlValue& table_;
    std::string_view selected_;
};

/// Reads a table, and judges it by the rules of its fields and by its check(), which may also complete the struct:
///     std::optional<FieldFault> check(T& value, const GivenFields& given);
/// Of a struct with a member `place` that is its own place.
template <class T>
void readToml(const TomlValue& from, T& value) {
    const TableRules rules(value);
    rules.refuseUnknown(from);
    TableReader reader(from, rules.chosen(from));
    fields(reader, value);
    rules.checkTable(from, reader.selected());
    if constexpr (requires { value.place; }) {
        value.place = from.place();
    }
    if constexpr (requires(GivenFields given) { check(value, given); }) {
        const auto given = [&](const std::string& path) { return from.find(path).has_value(); };
        if (const std::optional<FieldFault> fault = check(value, GivenFields(given))) {
            const TomlValue at = from.find(fault->path).value_or(from);
            at.fail(at.name().empty() ? fault->text : at.name() + " " + fault->text);
        }
    }
}

/// A whole file. \param read  gets its top level, and may throw TomlMistake.
/// Errors: kInvalidInput, with file, line and column.
[[nodiscard]] Result<void> readTomlFile(std::string_view text, TomlFile file,
                                        const std::function<void(const TomlValue&)>& read);
/// The same of a table that is no text: messages have no line and column.
[[nodiscard]] Result<void> readTomlTable(const toml::table& top, TomlFile file,
                                         const std::function<void(const TomlValue&)>& read);

}  // namespace relief

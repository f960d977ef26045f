// Values of fields as words: of a command line, of Python's arguments, of a container's provenance.
#pragma once

#include <concepts>
#include <cstdint>
#include <filesystem>
#include <limits>
#include <optional>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "formats/base/field.h"
#include "formats/base/result.h"
#include "formats/base/text.h"

namespace relief {

/// "is 'x' but must be MUST"
[[nodiscard]] std::string butMustBe(std::string_view word, std::string_view must);
/// "is 'x' but must be one of a, b, c; did you mean 'a'?", or "but must be a or b".
[[nodiscard]] std::string butMustBeOneOf(std::string_view word, std::span<const std::string_view> words);

/// "1MB" for 1000000, and the plain number where no unit of 1000 divides it.
[[nodiscard]] std::string bytesWord(std::uint64_t bytes);

/// The shortest decimal that reads back as the same number.
[[nodiscard]] std::string numberWord(float value);
[[nodiscard]] std::string numberWord(double value);

/// A type with a form of its own has readForm(word, value), false for another form, and formText(value) beside it.
template <class T>
concept WithForm = requires(std::string_view word, T& value) {
    { readForm(word, value) } -> std::same_as<bool>;
    { formText(value) } -> std::same_as<std::string>;
};

namespace fields_detail {

[[nodiscard]] std::string readUnsigned(std::string_view word, const FieldInfo& info, std::uint64_t most,
                                       std::uint64_t& value);
[[nodiscard]] std::string readFloat(std::string_view word, const FieldInfo& info, float& value);
[[nodiscard]] std::string readDouble(std::string_view word, const FieldInfo& info, double& value);
[[nodiscard]] std::string readText(std::string_view word, const FieldInfo& info, std::string& value);

}  // namespace fields_detail

/// Reads a word into a value; a list gets one more. \return empty, or the clause that follows the field's name in a message:
/// "is 'x' but must be …".
template <class T>
[[nodiscard]] std::string readWord(std::string_view word, const FieldInfo& info, T& value) {
    using namespace fields_detail;
    if constexpr (kIsForm<std::optional, T>) {
        return readWord(word, info, value.emplace());
    } else if constexpr (kIsForm<std::vector, T>) {
        return readWord(word, info, value.emplace_back());
    } else if constexpr (WithForm<T>) {
        return readForm(word, value) ? "" : butMustBe(word, info.must);
    } else if constexpr (std::same_as<T, bool>) {
        value = word == "true";
        return value || word == "false" ? "" : butMustBe(word, "true or false");
    } else if constexpr (std::unsigned_integral<T>) {
        std::uint64_t number = 0;
        std::string wrong = readUnsigned(word, info, std::numeric_limits<T>::max(), number);
        value = static_cast<T>(number);
        return wrong;
    } else if constexpr (std::same_as<T, float>) {
        return readFloat(word, info, value);
    } else if constexpr (std::same_as<T, double>) {
        return readDouble(word, info, value);
    } else if constexpr (WithWords<T>) {
        const std::optional<T> found = fromWord<T>(word);
        value = found.value_or(value);
        return found ? "" : butMustBeOneOf(word, kWordsOf<T>);
    } else {
        return readText(word, info, value);
    }
}

/// The words that readWord() makes the value of: none of an optional without a value, one for each entry of a list.
template <class T>
[[nodiscard]] std::vector<std::string> wordsOf(const T& value) {
    if constexpr (kIsForm<std::optional, T>) {
        return value ? wordsOf(*value) : std::vector<std::string>();
    } else if constexpr (kIsForm<std::vector, T>) {
        std::vector<std::string> words;
        for (const auto& one : value) {
            words.push_back(wordsOf(one).front());
        }
        return words;
    } else if constexpr (WithForm<T>) {
        return {formText(value)};
    } else if constexpr (std::same_as<T, bool>) {
        return {value ? "true" : "false"};
    } else if constexpr (std::unsigned_integral<T>) {
        return {std::to_string(value)};
    } else if constexpr (std::floating_point<T>) {
        return {numberWord(value)};
    } else if constexpr (WithWords<T>) {
        return {std::string(wordOf(value))};
    } else {
        return {std::string(value)};
    }
}

/// How many words a field takes, and of which sort: what its readers need beside the FieldInfo.
enum class FieldKind : std::uint8_t { kFlag, kValue, kList };

template <class T>
inline constexpr FieldKind kFieldKind = std::same_as<T, bool>     ? FieldKind::kFlag
                                        : kIsForm<std::vector, T> ? FieldKind::kList
                                                                  : FieldKind::kValue;

/// A field of a struct, distinct from its type.
struct FieldWords {
    std::string name;
    FieldInfo info;
    FieldKind kind = FieldKind::kValue;
    std::vector<std::string> words;           ///< of its value
    std::vector<std::string_view> choices{};  ///< of an enumeration
    bool optional = false;                    ///< the default is no value
    bool number = false;
};

/// All fields of a value, in their order.
class FieldCollector {
  public:
    template <class T>
    void operator()(std::string_view name, const T& value, const FieldInfo& info) {
        FieldWords field{std::string(name), info, kFieldKind<T>, wordsOf(value)};
        describe<T>(field);
        fields_.push_back(std::move(field));
    }
    [[nodiscard]] std::vector<FieldWords> take() { return std::move(fields_); }

  private:
    template <class T>
    static void describe(FieldWords& field) {
        if constexpr (kIsForm<std::optional, T>) {
            field.optional = true;
            describe<typename T::value_type>(field);
        } else if constexpr (WithWords<T>) {
            field.choices.assign(kWordsOf<T>.begin(), kWordsOf<T>.end());
        } else if constexpr (std::integral<T> || std::floating_point<T>) {
            field.number = !std::same_as<T, bool>;
        }
    }
    std::vector<FieldWords> fields_;
};

template <class S>
[[nodiscard]] std::vector<FieldWords> fieldsOf(const S& value) {
    FieldCollector collector;
    fields(collector, value);
    return collector.take();
}

/// The fields that differ from those of a new struct.
template <class S>
[[nodiscard]] std::vector<FieldWords> changedFields(const S& value) {
    std::vector<FieldWords> changed;
    const std::vector<FieldWords> defaults = fieldsOf(S());
    std::vector<FieldWords> all = fieldsOf(value);
    for (std::size_t i = 0; i < all.size(); ++i) {
        if (all[i].words != defaults[i].words) {
            changed.push_back(std::move(all[i]));
        }
    }
    return changed;
}

/// Reads a word into the field of that name.
class FieldSetter {
  public:
    FieldSetter(std::string_view name, std::string_view word) : name_(name), word_(word) {}
    template <class T>
    void operator()(std::string_view name, T& value, const FieldInfo& info) {
        if (name == name_) {
            wrong_ = readWord(word_, info, value);
        }
    }
    /// Errors: kUsage: no field has the name, or its value is wrong; names the option.
    [[nodiscard]] Result<void> result() const;

  private:
    std::string_view name_;
    std::string_view word_;
    std::optional<std::string> wrong_;
};

template <class S>
[[nodiscard]] Result<void> setField(S& target, std::string_view name, std::string_view word) {
    FieldSetter setter(name, word);
    fields(setter, target);
    return setter.result();
}

/// "1MB", "60", "normal, or the plan's"; empty: there is no default.
[[nodiscard]] std::string defaultText(const FieldWords& field);
/// Stands for the value in --help: "BYTES", "fast|normal|best".
[[nodiscard]] std::string valueText(const FieldWords& field);
/// A table of options for a README: name, sentence, default.
[[nodiscard]] std::string optionTable(const std::vector<FieldWords>& fields);

}  // namespace relief

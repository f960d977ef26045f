// SPDX-License-Identifier: Apache-2.0
#include "formats/fields/text.h"

#include <algorithm>
#include <array>
#include <charconv>
#include <limits>
#include <optional>
#include <utility>

#include "formats/base/text.h"

namespace relief {
namespace {

bool isBytes(const FieldInfo& info) {
    return info.unit == "bytes";
}

/// Returns the largest integer that the range allows.
std::uint64_t maximumOf(const FieldRange& range, std::uint64_t most) {
    return range.high < static_cast<double>(most) ? static_cast<std::uint64_t>(range.high) : most;
}

std::string requirementOf(const FieldInfo& info, std::uint64_t least, std::uint64_t most) {
    if (!info.must.empty()) {
        return std::string(info.must);
    }
    if (isBytes(info)) {
        return "a number of bytes, " + (least > 1 ? "at least " + std::to_string(least) + ", " : "") +
               "such as 1MB or 512KiB";
    }
    const bool any = least == 0 && most == std::numeric_limits<std::uint64_t>::max();
    return "a whole number" + (any ? "" : " from " + std::to_string(least) + " to " + std::to_string(most));
}

}  // namespace

std::string expectedMessage(std::string_view word, std::string_view must) {
    return "is '" + cleanUtf8(word) + "' but must be " + std::string(must);
}

std::string expectedOneOfMessage(std::string_view word, std::span<const std::string_view> words) {
    const std::string must = words.size() == 2 ? std::string(words[0]) + " or " + std::string(words[1])
                                               : "one of " + listed(words);
    return expectedMessage(word, must + (word.size() > 1 ? didYouMean(word, words) : ""));
}

std::string bytesWord(std::uint64_t bytes) {
    const auto scaled = [&](double unit, const char* name) {
        return formatted("%.6g", static_cast<double>(bytes) / unit) + name;
    };
    const std::string word = bytes >= 1'000'000'000 ? scaled(1e9, "GB")
                             : bytes >= 1'000'000   ? scaled(1e6, "MB")
                             : bytes >= 10'000      ? scaled(1e3, "kB")
                                                    : std::to_string(bytes);
    return parseByteCount(word) == bytes ? word : std::to_string(bytes);
}

std::string numberWord(float value) {
    return shortest(value);
}

std::string numberWord(double value) {
    std::array<char, 64> text{};
    return {text.data(), std::to_chars(text.data(), text.data() + text.size(), value).ptr};
}

namespace {

std::string readUnsigned(std::string_view word, const FieldInfo& info, std::uint64_t most,
                         std::uint64_t& value) {
    const auto least = info.range.low > 0.0 ? static_cast<std::uint64_t>(info.range.low) : 0;
    most = maximumOf(info.range, most);
    const std::optional<std::uint64_t> number = isBytes(info) ? parseByteCount(word) : parseUnsigned(word);
    if (!number || *number < least || *number > most) {
        return expectedMessage(word, requirementOf(info, least, most));
    }
    value = *number;
    return {};
}

/// Removes the unit of a length and returns its factor to metres, the object unit of files that specify a unit.
double takeUnit(std::string_view& word) {
    static constexpr std::array<std::pair<std::string_view, double>, 4> kUnits{
        {{"mm", 1e-3}, {"cm", 1e-2}, {"km", 1e3}, {"m", 1.0}}};
    for (const auto& [unit, metres] : kUnits) {
        if (word.ends_with(unit)) {
            word.remove_suffix(unit.size());
            return metres;
        }
    }
    return 1.0;
}

std::string readFloat(std::string_view word, const FieldInfo& info, float& value) {
    const bool percent = info.unit == "%";
    std::string_view plain = trimmed(word);
    plain.remove_suffix(percent && plain.ends_with('%') ? 1 : 0);
    const double scale = info.unit == "object units" ? takeUnit(plain) : 1.0;
    std::optional<float> number = parseFloat(trimmed(plain));
    if (number && scale != 1.0) {
        number = static_cast<float>(parseDouble(trimmed(plain)).value_or(0.0) * scale);
    }
    if (!number || !info.range.holds(double{*number})) {
        return expectedMessage(word, !info.must.empty() ? info.must
                                     : percent          ? "a percentage, such as 1.5"
                                                        : "a number");
    }
    value = *number;
    return {};
}

std::string readDouble(std::string_view word, const FieldInfo& info, double& value) {
    const std::optional<double> number = parseDouble(word);
    if (!number || !info.range.holds(*number)) {
        return expectedMessage(word, info.must.empty() ? "a number" : info.must);
    }
    value = *number;
    return {};
}

std::string readText(std::string_view word, const FieldInfo& info, std::string& value) {
    if (word.empty()) {
        return "is empty; omit it, or give it a value";
    }
    if (!info.words.empty() && std::ranges::find(info.words, word) == info.words.end()) {
        return expectedOneOfMessage(word, info.words);
    }
    value = word;
    return {};
}

FieldKind kindOf(FieldForm form) {
    return form == FieldForm::kBool   ? FieldKind::kFlag
           : form == FieldForm::kList ? FieldKind::kList
                                      : FieldKind::kValue;
}

class FieldCollector : public FieldVisitor {
  public:
    void operator()(std::string_view name, FieldRef value, const FieldInfo& info) override {
        fields_.push_back(describeField(name, value, info));
    }
    std::vector<FieldWords> take() { return std::move(fields_); }

  private:
    std::vector<FieldWords> fields_;
};

class FieldSetter : public FieldVisitor {
  public:
    FieldSetter(std::string_view name, std::string_view word) : name_(name), word_(word) {}
    void operator()(std::string_view name, FieldRef value, const FieldInfo& info) override {
        if (name == name_) {
            wrong_ = readWord(word_, info, value);
        }
    }
    [[nodiscard]] bool fills() const override { return true; }
    [[nodiscard]] const std::optional<std::string>& wrong() const { return wrong_; }

  private:
    std::string_view name_;
    std::string_view word_;
    std::optional<std::string> wrong_;
};

}  // namespace

std::string readWord(std::string_view word, const FieldInfo& info, FieldRef value) {
    const FieldType& type = value.type();
    if (type.read_form != nullptr) {
        return type.read_form(word, value.value()) ? "" : expectedMessage(word, info.must);
    }
    switch (value.form()) {
        case FieldForm::kOptional:
        case FieldForm::kList:
            return readWord(word, info, value.add());
        case FieldForm::kBool:
            value.as<bool>() = word == "true";
            return value.as<bool>() || word == "false" ? "" : expectedMessage(word, "true or false");
        case FieldForm::kUnsigned: {
            std::uint64_t number = 0;
            std::string wrong = readUnsigned(
                word, info, std::numeric_limits<std::uint64_t>::max() >> (64 - 8 * type.size), number);
            value.setWhole(number);
            return wrong;
        }
        case FieldForm::kReal:
            return type.size == sizeof(float) ? readFloat(word, info, value.as<float>())
                                              : readDouble(word, info, value.as<double>());
        case FieldForm::kWord:
            return value.setWord(word) ? "" : expectedOneOfMessage(word, type.words);
        default:
            return readText(word, info, value.as<std::string>());
    }
}

std::vector<std::string> wordsOf(FieldRef value) {
    const FieldType& type = value.type();
    if (type.form_text != nullptr) {
        return {type.form_text(value.value())};
    }
    switch (value.form()) {
        case FieldForm::kOptional:
            return value.count() == 0 ? std::vector<std::string>() : wordsOf(value[0]);
        case FieldForm::kList: {
            std::vector<std::string> words;
            for (std::size_t i = 0; i < value.count(); ++i) {
                words.push_back(wordsOf(value[i]).front());
            }
            return words;
        }
        case FieldForm::kBool:
            return {value.as<bool>() ? "true" : "false"};
        case FieldForm::kUnsigned:
            return {std::to_string(value.whole())};
        case FieldForm::kReal:
            return {type.size == sizeof(float) ? numberWord(value.as<float>())
                                               : numberWord(value.as<double>())};
        case FieldForm::kWord:
            return {std::string(value.word())};
        default:
            return {std::string(value.text())};
    }
}

FieldWords describeField(std::string_view name, FieldRef value, const FieldInfo& info) {
    FieldWords field{std::string(name), info, kindOf(value.form()), wordsOf(value)};
    const FieldType* type = &value.type();
    if (type->form == FieldForm::kOptional) {
        field.optional = true;
        type = type->held;
    }
    field.choices.assign(type->words.begin(), type->words.end());
    field.number = type->form == FieldForm::kUnsigned || type->form == FieldForm::kSigned ||
                   type->form == FieldForm::kReal;
    return field;
}

std::vector<FieldWords> fieldsOf(FieldRef value) {
    FieldCollector collector;
    value.visit(collector);
    return collector.take();
}

std::vector<FieldWords> changedFields(FieldRef value) {
    std::vector<FieldWords> changed;
    const std::vector<FieldWords> defaults = fieldsOf(value.blank());
    std::vector<FieldWords> all = fieldsOf(value);
    for (std::size_t i = 0; i < all.size(); ++i) {
        if (all[i].words != defaults[i].words) {
            changed.push_back(std::move(all[i]));
        }
    }
    return changed;
}

Result<void> setField(FieldRef target, std::string_view name, std::string_view word) {
    FieldSetter setter(name, word);
    target.visit(setter);
    if (!setter.wrong()) {
        return fail(ErrorCode::kUsage, "unknown option " + cleanUtf8(optionName(name), 80));
    }
    return setter.wrong()->empty() ? Result<void>()
                                   : fail(ErrorCode::kUsage, optionName(name) + " " + *setter.wrong());
}

std::string defaultText(const FieldWords& field) {
    if (!field.info.fallback.empty()) {
        return std::string(field.info.fallback);
    }
    if (field.kind == FieldKind::kFlag || field.words.empty() || field.words.front().empty()) {
        return {};
    }
    const std::string& word = field.words.front();
    return isBytes(field.info) ? bytesWord(*parseUnsigned(word)) : word;
}

std::string valueText(const FieldWords& field) {
    if (!field.info.value.empty()) {
        return std::string(field.info.value);
    }
    std::string text;
    for (const std::string_view choice : field.choices) {
        text.append(text.empty() ? "" : "|").append(choice);
    }
    return !text.empty() ? text : isBytes(field.info) ? "BYTES" : field.info.unit == "%" ? "PCT" : "N";
}

}  // namespace relief

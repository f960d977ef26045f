// SPDX-License-Identifier: Apache-2.0
#include "formats/config/toml_reader.h"

#include <cmath>
#include <cstdio>
#include <exception>
#include <glm/geometric.hpp>
#include <glm/vec3.hpp>
#include <limits>

#include "formats/base/file_io.h"
#include "formats/base/text.h"
#include "formats/config/confined_path.h"

namespace relief {
namespace {

std::string rangeText(const FieldRange& range) {
    const std::string low = (range.low_included ? "" : "above ") + numberText(range.low);
    return std::isfinite(range.high) ? "choose " + low + " to " + numberText(range.high)
                                     : "choose " + low + " or more";
}

/// Returns the number of tables in an array, 1 for a single table, otherwise 0.
std::size_t tableCount(const toml::node* node) {
    const toml::array* array = node == nullptr ? nullptr : node->as_array();
    return array != nullptr ? array->size() : (node != nullptr && node->is_table() ? 1 : 0);
}

/// "file:line:column"
std::string placeIn(const TomlFile& file, const toml::source_region& region) {
    const toml::source_position& at = region.begin;
    return file.is_text ? file.name + ":" + std::to_string(std::max(at.line, 1U)) + ":" +
                              std::to_string(std::max(at.column, 1U))
                        : file.name;
}

/// Converts exceptions into errors.
Result<void> caught(const TomlFile& file, const std::function<void()>& read) {
    try {
        read();
        return {};
    } catch (const toml::parse_error& error) {
        return fail(ErrorCode::kInvalidInput,
                    placeIn(file, error.source()) + ": not TOML: " + oneLine(error.description()));
    } catch (const TomlError& error) {
        return fail(ErrorCode::kInvalidInput, error.message);
    } catch (const std::bad_alloc&) {
        throw;
    } catch (const std::exception& error) {
        return fail(ErrorCode::kInvalidInput,
                    placeIn(file, {}) + ": cannot be read: " + oneLine(error.what()));
    }
}

}  // namespace

std::string numberText(double value) {
    char text[40];
    std::snprintf(text, sizeof(text), "%.9g", value);
    return text;
}

std::string oneLine(std::string_view text) {
    std::string quoted = quotedPath(std::filesystem::path(text));
    return quoted.substr(1, quoted.size() - 2);
}

std::string TomlValue::place() const {
    return placeIn(*file_, node_->source());
}

std::string TomlValue::full(std::string_view key) const {
    return name_.empty() ? std::string(key) : name_ + "." + std::string(key);
}

void TomlValue::fail(const std::string& message) const {
    throw TomlError{place() + ": " + message};
}

void TomlValue::wrongType(std::string_view wanted) const {
    fail(name_ + " must be " + std::string(wanted));
}

std::optional<TomlValue> TomlValue::find(std::string_view path) const {
    TomlValue at = *this;
    while (!path.empty()) {
        const std::size_t end = path.front() == '[' ? path.find(']') + 1 : path.find_first_of(".[");
        const std::string_view step = path.substr(0, end);
        path = path.substr(step.size());
        path = path.substr(path.starts_with('.') ? 1 : 0);
        if (step.front() == '[') {
            const auto i =
                static_cast<std::size_t>(parseUnsigned(step.substr(1, step.size() - 2)).value_or(0));
            if (at.array() != nullptr ? i >= at.array()->size() : i > 0) {
                return std::nullopt;
            }
            at = at.array() != nullptr ? at[i] : at;
            continue;
        }
        const toml::node* next = at.node().is_table() ? at.node().as_table()->get(step) : nullptr;
        if (next == nullptr) {
            return std::nullopt;
        }
        at = TomlValue(*next, at.full(step), *file_);
    }
    return at;
}

double TomlValue::number(const FieldRange& range) const {
    if (!node_->is_number()) {
        wrongType("a number");
    }
    const double value = node_->is_integer() ? static_cast<double>(*node_->value_exact<std::int64_t>())
                                             : *node_->value_exact<double>();
    if (!range.holds(value)) {
        fail(name_ + " = " + numberText(value) + " is out of range; " + rangeText(range));
    }
    return value;
}

std::int64_t TomlValue::whole(const FieldRange& range) const {
    if (!node_->is_integer()) {
        wrongType("a whole number");
    }
    const std::int64_t value = *node_->value_exact<std::int64_t>();
    if (!range.holds(static_cast<double>(value))) {
        fail(name_ + " = " + std::to_string(value) + " is out of range; " + rangeText(range));
    }
    return value;
}

bool TomlValue::boolean() const {
    if (!node_->is_boolean()) {
        wrongType("true or false");
    }
    return *node_->value_exact<bool>();
}

std::string TomlValue::text() const {
    if (!node_->is_string()) {
        wrongType("a string");
    }
    return *node_->value_exact<std::string>();
}

std::size_t TomlValue::word(std::span<const std::string_view> words) const {
    std::string list;
    for (const std::string_view word : words) {
        list += (list.empty() ? "\"" : ", \"") + std::string(word) + "\"";
    }
    if (!node_->is_string()) {
        wrongType("one of " + list);
    }
    const std::string value = text();
    const auto found = std::find(words.begin(), words.end(), value);
    if (found == words.end()) {
        const std::string hint = didYouMean(value, words);
        fail(name_ + " = '" + oneLine(value) + "' is unknown" +
             (hint.empty() ? "; choose one of " + list : hint));
    }
    return static_cast<std::size_t>(found - words.begin());
}

std::filesystem::path TomlValue::path() const {
    auto inside = resolveInside(file_->folder, text(), file_->owner, file_->root);
    if (!inside) {
        fail(name_ + " = " + inside.error().message);
    }
    return std::move(*inside);
}

std::int64_t TomlValue::indexOf(std::string_view key, const FieldRange& range) const {
    const toml::node* tables = file_->top->get(key);
    const std::size_t count = tableCount(tables);
    if (node_->is_integer()) {
        const std::int64_t value = whole(range);
        if (count > 0 && value >= static_cast<std::int64_t>(count)) {
            fail(name_ + " = " + std::to_string(value) + " is not one of the " + std::to_string(count) + " " +
                 std::string(key) + "s; the first is 0");
        }
        return value;
    }
    if (!node_->is_string()) {
        wrongType("a whole number or the name of a " + std::string(key));
    }
    const std::string wanted = text();
    std::vector<std::string> names;
    for (std::size_t i = 0; tables != nullptr && tables->is_array() && i < count; ++i) {
        const toml::table* one = tables->as_array()->get(i)->as_table();
        const toml::node* name = one == nullptr ? nullptr : one->get("name");
        names.push_back(name == nullptr ? "" : name->value_or(std::string()));
    }
    const std::vector<std::string_view> known(names.begin(), names.end());
    const auto found = std::find(known.begin(), known.end(), wanted);
    if (wanted.empty() || found == known.end()) {
        const std::string hint = didYouMean(wanted, known);
        fail(name_ + " = '" + oneLine(wanted) + "' is " + (wanted.empty() ? "an empty name" : "unknown") +
             (hint.empty() ? "; use a name from this file" : hint));
    }
    return found - known.begin();
}

const toml::array& TomlValue::list(std::size_t size, bool whole, std::string_view unit) const {
    static constexpr const char* kCounts[] = {"no", "one", "two", "three", "four"};
    if (array() == nullptr || array()->size() != size) {
        wrongType(std::string(kCounts[size]) + (whole ? " whole numbers " : " numbers ") +
                  std::string(unit.substr(0, unit.find(']') + 1)));
    }
    return *array();
}

void TomlValue::needTable() const {
    if (!node_->is_table()) {
        wrongType("a table, as in [" + name_ + "]");
    }
}

std::vector<TomlValue> TomlValue::tables(const FieldInfo& info) const {
    if (info.rules.single && node_->is_table()) {
        return {*this};
    }
    const std::string several = "as in [[" + name_ + "]]";
    const std::string wanted = info.rules.single ? "a table, as in [" + name_ + "], or several, " + several
                                                 : "tables, each " + several;
    if (array() == nullptr || (info.rules.single && !array()->is_array_of_tables())) {
        wrongType(wanted);
    }
    std::vector<TomlValue> tables;
    for (std::size_t i = 0; i < array()->size(); ++i) {
        if (!(*this)[i].node().is_table()) {
            (*this)[i].wrongType(wanted);
        }
        if (i == info.rules.most) {
            (*this)[i].fail("there are " + std::to_string(array()->size()) + " [[" + name_ +
                            "]] tables; at most " + std::to_string(info.rules.most) + " are allowed");
        }
        tables.push_back((*this)[i]);
    }
    return tables;
}

namespace {

/// The fields of a struct: the keys that its table may contain.
class TableRules : public FieldVisitor {
  public:
    void operator()(std::string_view name, FieldRef /*value*/, const FieldInfo& info) override {
        fields_.push_back({name, info});
    }

    /// Fails at the first key of the file that is not a field.
    void refuseUnknown(const TomlValue& table) const;
    /// Returns the value that the present keys imply for the missing selecting field; empty: none.
    [[nodiscard]] std::string_view chosen(const TomlValue& table) const;
    /// Fails if a key is missing, or has no effect with or without the others.
    /// \param selected  value of the selecting field; empty if there is none.
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

void TableRules::refuseUnknown(const TomlValue& table) const {
    std::vector<std::string_view> known;
    for (const Field& field : fields_) {
        known.push_back(field.name);
    }
    for (const toml::key* key : keysInOrder(*table.node().as_table())) {
        if (std::find(known.begin(), known.end(), key->str()) == known.end()) {
            const std::string hint = didYouMean(key->str(), known);
            throw TomlError{placeIn(table.file(), key->source()) + ": unknown " +
                            (table.name().empty() ? "table" : "key") + " '" +
                            oneLine(table.full(key->str())) + "'" +
                            (hint.empty() ? "; valid names: " + listed(known) : hint)};
        }
    }
}

std::string_view TableRules::chosen(const TomlValue& table) const {
    std::string_view word;
    for (const Field& field : fields_) {
        word = field.info.rules.chooses && table.find(field.name) ? field.info.rules.only : word;
    }
    return word;
}

std::string_view TableRules::selector() const {
    for (const Field& field : fields_) {
        if (field.info.rules.selects) {
            return field.name;
        }
    }
    return {};
}

void TableRules::checkTable(const TomlValue& table, std::string_view selected) const {
    for (const Field& field : fields_) {
        for (const std::string_view other : listWords(field.info.rules.instead_of)) {
            const auto at = table.find(field.name);
            if (at && table.find(other)) {
                at->fail(at->name() + " and " + table.full(other) + " exclude each other; remove one");
            }
        }
    }
    for (const Field& field : fields_) {
        if (table.find(field.name)) {
            checkUse(table, field, selected);
        }
    }
    for (const Field& field : fields_) {
        if (!field.info.rules.required || table.find(field.name)) {
            continue;
        }
        const std::string name = table.full(field.name);
        if (field.info.rules.only.empty()) {
            table.fail(name + " is missing; add it: " + std::string(field.info.help) +
                       (field.info.unit.empty() ? "" : ", " + std::string(field.info.unit)));
        }
        if (listHas(field.info.rules.only, selected)) {
            const std::string_view by = selector();
            table.find(by).value_or(table).fail(table.full(by) + " = \"" + std::string(selected) +
                                                "\" also requires " + name);
        }
    }
}

void TableRules::checkUse(const TomlValue& table, const Field& field, std::string_view selected) const {
    const FieldInfo& info = field.info;
    const TomlValue at = *table.find(field.name);
    const auto given = [&](std::string_view key) { return table.find(key).has_value(); };
    if (!info.rules.only.empty() && !listHas(info.rules.only, selected)) {
        const std::string by = table.full(selector());
        at.fail(at.name() + " has no effect for " + by + " = \"" + std::string(selected) +
                "\"; remove it, or choose " + by + " = \"" + std::string(listWords(info.rules.only).front()) +
                "\"");
    }
    const std::vector<std::string_view> needs = listWords(info.rules.needs);
    if (!needs.empty() && std::none_of(needs.begin(), needs.end(), given)) {
        std::string names;
        for (const std::string_view other : needs) {
            names += (names.empty() ? "" : " or ") + table.full(other);
        }
        at.fail(at.name() + " has no effect without " + names + "; add " + names + ", or remove " +
                at.name());
    }
}

/// Reads the fields that are present in a table.
class TableReader : public FieldVisitor {
  public:
    TableReader(const TomlValue& table, std::string_view chosen) : table_(table), selected_(chosen) {}
    void operator()(std::string_view name, FieldRef value, const FieldInfo& info) override {
        const auto from = table_.find(name);
        if (from) {
            readValue(*from, value, info);
        }
        if (value.form() == FieldForm::kWord && info.rules.selects) {
            if (!from) {
                static_cast<void>(value.setWord(selected_));
            }
            selected_ = value.word();
        }
    }
    [[nodiscard]] bool fills() const override { return true; }
    [[nodiscard]] std::string_view selected() const { return selected_; }

  private:
    const TomlValue& table_;
    std::string_view selected_;
};

bool isWhole(const FieldType& type) {
    return type.form == FieldForm::kUnsigned || type.form == FieldForm::kSigned;
}

/// Returns the limits of an integer type.
FieldRange rangeOf(const FieldType& type) {
    const int bits = static_cast<int>(8 * type.size);
    return type.form == FieldForm::kUnsigned
               ? FieldRange{0.0, std::ldexp(1.0, bits) - 1.0}
               : FieldRange{-std::ldexp(1.0, bits - 1), std::ldexp(1.0, bits - 1) - 1.0};
}

/// Converts a number; values above zero stay above zero.
template <class T>
T narrowed(double value, const FieldRange& range) {
    const T result = static_cast<T>(value);
    return range.low == 0.0 && !range.low_included && result == T{} ? std::numeric_limits<T>::min() : result;
}

void readNumber(const TomlValue& from, FieldRef value, const FieldInfo& info) {
    if (isWhole(value.type())) {
        const FieldRange limits = rangeOf(value.type());
        FieldRange range = info.range;
        range.low = std::max(range.low, limits.low);
        range.high = std::min(range.high, limits.high);
        value.setWhole(static_cast<std::uint64_t>(
            info.rules.index_of.empty() ? from.whole(range) : from.indexOf(info.rules.index_of, range)));
        return;
    }
    const double number = from.number(info.range);
    value.setReal(value.type().size == sizeof(float) ? double{narrowed<float>(number, info.range)}
                                                     : narrowed<double>(number, info.range));
    if (info.rules.not_zero && value.number() == 0.0) {
        from.fail(from.name() + " has no effect if it is 0; raise it or remove it");
    }
}

/// Reads a vector or an array.
void readNumbers(const TomlValue& from, FieldRef value, const FieldInfo& info) {
    const bool is_vector = value.form() == FieldForm::kVector;
    static_cast<void>(from.list(value.count(), isWhole(*value.type().held),
                                is_vector ? std::string_view("[x, y, z]") : info.unit));
    FieldInfo part = info;
    part.rules.not_zero = false;
    for (std::size_t i = 0; i < value.count(); ++i) {
        readNumber(from[i], value[i], part);
    }
    if (!is_vector) {
        return;
    }
    // Scale first: the square of a short vector would underflow.
    auto& vector = value.as<glm::vec3>();
    const float longest = std::max({std::abs(vector.x), std::abs(vector.y), std::abs(vector.z)});
    if ((info.rules.not_zero || info.rules.unit_length) && !(longest >= 1e-30F)) {
        from.fail(from.name() + " has no direction; use a nonzero vector such as [0, 1, 0]");
    }
    if (info.rules.unit_length) {
        vector = glm::normalize(vector / longest);
    }
}

/// A number with the type of one part of a FieldSpan or FieldPair, before it is stored.
class PartNumber {
  public:
    explicit PartNumber(FieldRef part)
        : number_(bytes_, part.form() == FieldForm::kOptional ? *part.type().held : part.type()) {}
    PartNumber(const PartNumber&) = delete;
    PartNumber& operator=(const PartNumber&) = delete;

    [[nodiscard]] FieldRef ref() const { return number_; }
    void give(FieldRef part) const {
        const FieldRef to = part.form() == FieldForm::kOptional ? part.add() : part;
        isWhole(to.type()) ? to.setWhole(number_.whole()) : to.setReal(number_.number());
    }

  private:
    alignas(8) std::byte bytes_[8]{};
    FieldRef number_;
};

void readSpan(const TomlValue& from, const FieldSpan& span, const FieldInfo& info) {
    const PartNumber least(span.least);
    const PartNumber most(span.least);
    const toml::array* both = from.array();
    if (both == nullptr ? !from.node().is_number() : both->size() != 2) {
        from.wrongType(isWhole(least.ref().type()) ? "a whole number, or two [least, most]"
                                                   : "a number, or two [least, most]");
    }
    readNumber(both == nullptr ? from : from[0], least.ref(), info);
    readNumber(both == nullptr ? from : from[1], most.ref(), info);
    if (least.ref().number() > most.ref().number()) {
        from.fail(from.name() + " has a minimum above its maximum; swap them");
    }
    least.give(span.least);
    most.give(span.most);
}

void readPair(const TomlValue& from, const FieldPair& pair, const FieldInfo& info) {
    const PartNumber first(pair.first);
    const PartNumber second(pair.first);
    static_cast<void>(from.list(2, isWhole(first.ref().type()), info.unit));
    readNumber(from[0], first.ref(), info);
    readNumber(from[1], second.ref(), info);
    first.give(pair.first);
    second.give(pair.second);
}

}  // namespace

void readValue(const TomlValue& from, FieldRef value, const FieldInfo& info) {
    if (const FieldCustom* custom = value.type().custom; custom != nullptr && custom->read != nullptr) {
        custom->read(from, value.value(), info);
        return;
    }
    switch (value.form()) {
        case FieldForm::kSpan:
            return readSpan(from, value.as<FieldSpan>(), info);
        case FieldForm::kPair:
            return readPair(from, value.as<FieldPair>(), info);
        case FieldForm::kMaybe:
            readValue(from, value.as<FieldMaybe>().value, info);
            value.as<FieldMaybe>().given = true;
            return;
        case FieldForm::kFile:
            value.as<FieldFile>().path = from.path();
            value.as<FieldFile>().place = from.place();
            return;
        case FieldForm::kOptional:
            return readValue(from, value.add(), info);
        case FieldForm::kBool:
            value.as<bool>() = from.boolean();
            return;
        case FieldForm::kUnsigned:
        case FieldForm::kSigned:
        case FieldForm::kReal:
            return readNumber(from, value, info);
        case FieldForm::kWord:
            value.setWhole(from.word(value.type().words));
            return;
        case FieldForm::kString:
            value.as<std::string>() = from.text();
            return;
        case FieldForm::kVector:
        case FieldForm::kArray:
            return readNumbers(from, value, info);
        case FieldForm::kList:
            value.type().clear(value.value());
            for (const TomlValue& table : from.tables(info)) {
                readToml(table, value.add());
            }
            return;
        default:
            from.needTable();
            readToml(from, value);
    }
}

void readToml(const TomlValue& from, FieldRef value) {
    TableRules rules;
    value.visit(rules);
    rules.refuseUnknown(from);
    TableReader reader(from, rules.chosen(from));
    value.visit(reader);
    rules.checkTable(from, reader.selected());
    const FieldType& type = value.type();
    if (type.set_place != nullptr) {
        type.set_place(value.value(), from.place());
    }
    if (type.check != nullptr) {
        const auto given = [&](const std::string& path) { return from.find(path).has_value(); };
        if (const std::optional<FieldFault> fault = type.check(value.value(), given)) {
            const TomlValue at = from.find(fault->path).value_or(from);
            at.fail(at.name().empty() ? fault->text : at.name() + " " + fault->text);
        }
    }
}

Result<void> readTomlFile(std::string_view text, TomlFile file,
                          const std::function<void(const TomlValue&)>& read) {
    return caught(file, [&] {
        const toml::table top = toml::parse(text, file.name);
        file.top = &top;
        read(TomlValue(top, "", file));
    });
}

Result<void> readTomlTable(const toml::table& top, TomlFile file,
                           const std::function<void(const TomlValue&)>& read) {
    file.top = &top;
    file.is_text = false;
    return caught(file, [&] { read(TomlValue(top, "", file)); });
}

}  // namespace relief

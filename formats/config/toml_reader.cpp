// SPDX-License-Identifier: Apache-2.0
#include "formats/config/toml_reader.h"

#include <cmath>
#include <glm/geometric.hpp>
#include <glm/vec3.hpp>
#include <limits>

#include "formats/base/text.h"

namespace relief {
namespace {

/// The fields of a struct: the keys that its table may contain.
class TableRules : public FieldVisitor {
  public:
    void operator()(std::string_view name, FieldRef /*value*/, const FieldInfo& info) override {
        fields_.push_back({name, info});
    }

    /// Fails at the first key of the file that is not a field.
    void rejectUnknown(const TomlValue& table) const;
    /// Returns the value that the present keys imply for the missing selecting field; empty: none.
    [[nodiscard]] std::string_view chosen(const TomlValue& table) const;
    /// Fails if a required key is missing, two keys exclude each other, or a key has no effect.
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

void TableRules::rejectUnknown(const TomlValue& table) const {
    std::vector<std::string_view> known;
    for (const Field& field : fields_) {
        known.push_back(field.name);
    }
    for (const toml::key* key : keysInOrder(*table.node().as_table())) {
        if (std::find(known.begin(), known.end(), key->str()) == known.end()) {
            const std::string hint = didYouMean(key->str(), known);
            table.failAt(*key, std::string("unknown ") + (table.name().empty() ? "table" : "key") + " '" +
                                   oneLine(table.full(key->str())) + "'" +
                                   (hint.empty() ? "; valid names: " + listed(known) : hint));
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
        from.fail(from.name() + " has no effect if it is 0; use another number, or remove " +
                  (info.rules.required ? "the table" : "it"));
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
    void storeIn(FieldRef part) const {
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
    least.storeIn(span.least);
    most.storeIn(span.most);
}

void readPair(const TomlValue& from, const FieldPair& pair, const FieldInfo& info) {
    const PartNumber first(pair.first);
    const PartNumber second(pair.first);
    static_cast<void>(from.list(2, isWhole(first.ref().type()), info.unit));
    readNumber(from[0], first.ref(), info);
    readNumber(from[1], second.ref(), info);
    first.storeIn(pair.first);
    second.storeIn(pair.second);
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
        case FieldForm::kPlaced:
            readValue(from, value.as<FieldPlaced>().value, info);
            value.as<FieldPlaced>().place = from.place();
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
        case FieldForm::kPath:
            value.as<std::filesystem::path>() = from.path();
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
    rules.rejectUnknown(from);
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

}  // namespace relief

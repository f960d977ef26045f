// SPDX-License-Identifier: Apache-2.0
#include "formats/config/toml_value.h"

#include <exception>

#include "formats/base/file_io.h"
#include "formats/base/text.h"
#include "formats/config/confined_path.h"

namespace relief {
namespace {

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
    return formatted("%.9g", value);
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

void TomlValue::failAt(const toml::key& key, const std::string& message) const {
    throw TomlError{placeIn(*file_, key.source()) + ": " + message};
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
        fail(name_ + " = " + numberText(value) + " is out of range; " + rangeAdvice(range, numberText));
    }
    return value;
}

std::int64_t TomlValue::whole(const FieldRange& range) const {
    if (!node_->is_integer()) {
        wrongType("a whole number");
    }
    const std::int64_t value = *node_->value_exact<std::int64_t>();
    if (!range.holds(static_cast<double>(value))) {
        fail(name_ + " = " + std::to_string(value) + " is out of range; " + rangeAdvice(range, numberText));
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

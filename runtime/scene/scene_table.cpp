#include "runtime/scene/scene_table.h"

#include <cstdio>

#include "formats/base/file_io.h"
#include "formats/base/text.h"
#include "formats/config/confined_path.h"

namespace relief {

std::string numberText(double value) {
    char text[40];
    std::snprintf(text, sizeof(text), "%.9g", value);
    return text;
}

std::string oneLine(std::string_view text) {
    std::string quoted = quotedPath(std::filesystem::path(text));
    return quoted.substr(1, quoted.size() - 2);
}

bool SceneRange::holds(double value) const {
    return (low_included ? value >= low : value > low) && value <= high;
}

std::string SceneRange::text() const {
    return (low_included ? "choose " + numberText(low) : "choose above " + numberText(low)) + " to " +
           numberText(high);
}

SceneTable SceneTable::sub(std::string_view name) {
    const toml::node* node = find(name);
    if (node != nullptr && !node->is_table()) {
        wrongType(*node, name, "a table, as in [" + full(name) + "]");
    }
    return {node == nullptr ? nullptr : node->as_table(), name, file_};
}

const toml::node* SceneTable::find(std::string_view key) {
    if (std::find(known_.begin(), known_.end(), key) == known_.end()) {
        known_.push_back(key);
    }
    return table_ == nullptr ? nullptr : table_->get(key);
}

bool SceneTable::boolean(std::string_view key, bool& out) {
    return take(key, out, [&](const toml::node& node) {
        if (!node.is_boolean()) {
            wrongType(node, key, "true or false");
        }
        return *node.value_exact<bool>();
    });
}
bool SceneTable::text(std::string_view key, std::string& out) {
    return take(key, out, [&](const toml::node& node) {
        if (!node.is_string()) {
            wrongType(node, key, "a string");
        }
        return *node.value_exact<std::string>();
    });
}
bool SceneTable::path(std::string_view key, const SceneFolder& folder, std::filesystem::path& out,
                      std::string& origin) {
    std::string name;
    if (!text(key, name)) {
        return false;
    }
    const toml::node& node = *find(key);
    auto inside = resolveInside(folder.own, name, "scene", folder.root);
    if (!inside) {
        failAt(node, full(key) + " = " + inside.error().message);
    }
    out = std::move(*inside);
    origin = place(node.source().begin);
    return true;
}

SceneSpan SceneTable::spanOf(const toml::node& node, std::string_view key, const SceneRange& range,
                             std::string_view wanted) const {
    const toml::array* both = node.as_array();
    if (both == nullptr ? !node.is_number() : both->size() != 2) {
        wrongType(node, key, wanted);
    }
    const SceneSpan span{numberOf(both == nullptr ? node : *both->get(0), key, range),
                         numberOf(both == nullptr ? node : *both->get(1), key, range)};
    if (span.least > span.most) {
        failAt(node, full(key) + " has its least above its most; exchange them");
    }
    return span;
}

std::vector<const toml::table*> SceneTable::tables(std::string_view key, std::size_t most) {
    std::vector<const toml::table*> tables;
    const toml::node* node = find(key);
    if (node == nullptr) {
        return tables;
    }
    const std::string wanted = "tables, each as in [[" + full(key) + "]]";
    if (!node->is_array()) {
        wrongType(*node, key, wanted);
    }
    for (const toml::node& one : *node->as_array()) {
        if (!one.is_table()) {
            wrongType(one, key, wanted);
        }
        if (tables.size() == most) {
            failAt(one, "there are " + std::to_string(node->as_array()->size()) + " of [[" + full(key) +
                            "]], more than " + std::to_string(most) + "; remove some");
        }
        tables.push_back(one.as_table());
    }
    return tables;
}

const toml::array& SceneTable::arrayOf(const toml::node& node, std::string_view key, std::size_t size,
                                       std::string_view wanted) const {
    const toml::array* values = node.as_array();
    if (values == nullptr || values->size() != size) {
        wrongType(node, key, wanted);
    }
    return *values;
}
glm::vec3 SceneTable::vectorOf(const toml::node& node, std::string_view key, const SceneRange& range) const {
    const toml::array& values = arrayOf(node, key, 3, "three numbers [x, y, z]");
    glm::vec3 out{0.0F};
    for (int i = 0; i < 3; ++i) {
        out[i] = static_cast<float>(numberOf(*values.get(static_cast<std::size_t>(i)), key, range));
    }
    return out;
}
double SceneTable::numberOf(const toml::node& node, std::string_view key, const SceneRange& range) const {
    if (!node.is_number()) {
        wrongType(node, key, "a number");
    }
    const double value = node.is_integer() ? static_cast<double>(*node.value_exact<std::int64_t>())
                                           : *node.value_exact<double>();
    if (!range.holds(value)) {
        failAt(node, full(key) + " = " + numberText(value) + " is out of range; " + range.text());
    }
    return value;
}
std::int64_t SceneTable::integerOf(const toml::node& node, std::string_view key,
                                   const SceneRange& range) const {
    if (!node.is_integer()) {
        wrongType(node, key, "a whole number");
    }
    const std::int64_t value = *node.value_exact<std::int64_t>();
    if (!range.holds(static_cast<double>(value))) {
        failAt(node, full(key) + " = " + std::to_string(value) + " is out of range; " + range.text());
    }
    return value;
}
std::size_t SceneTable::wordOf(const toml::node& node, std::string_view key,
                               const std::vector<std::string_view>& words) const {
    std::string list;
    for (const std::string_view word : words) {
        list += (list.empty() ? "\"" : ", \"") + std::string(word) + "\"";
    }
    if (!node.is_string()) {
        wrongType(node, key, "one of " + list);
    }
    const std::string value = *node.value_exact<std::string>();
    const auto found = std::find(words.begin(), words.end(), value);
    if (found == words.end()) {
        const std::string hint = didYouMean(value, words);
        failAt(node, full(key) + " = '" + oneLine(value) + "' is unknown" +
                         (hint.empty() ? "; choose one of " + list : hint));
    }
    return static_cast<std::size_t>(found - words.begin());
}

void SceneTable::wrongType(const toml::node& node, std::string_view key, std::string_view wanted) const {
    failAt(node, full(key) + " must be " + std::string(wanted));
}
void SceneTable::failAt(const toml::node& node, const std::string& message) const {
    failAt(node.source().begin, message);
}
void SceneTable::failAt(const toml::source_position& at, const std::string& message) const {
    throw SceneError{place(at) + ": " + message};
}
std::string SceneTable::place(const toml::source_position& at) const {
    return std::string(file_) + ":" + std::to_string(at.line) + ":" + std::to_string(at.column);
}
std::string SceneTable::full(std::string_view key) const {
    return name_.empty() ? std::string(key) : std::string(name_) + "." + std::string(key);
}
void SceneTable::failUseless(std::string_view key, const std::string& why) const {
    failAt(*table_->get(key), full(key) + " does nothing " + why);
}
void SceneTable::finish() const {
    if (table_ == nullptr) {
        return;
    }
    for (const toml::key* key : keysInOrder(*table_)) {
        if (std::find(known_.begin(), known_.end(), key->str()) == known_.end()) {
            const std::string hint = didYouMean(key->str(), known_);
            failAt(key->source().begin, "unknown " + std::string(name_.empty() ? "table" : "key") + " '" +
                                            oneLine(full(key->str())) + "'" +
                                            (hint.empty() ? "; known are " + listed(known_) : hint));
        }
    }
}
}  // namespace relief

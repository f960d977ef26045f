#include "runtime/scene/scene_table.h"

#include <cstdio>
#include <filesystem>

#include "formats/base/file_io.h"
#include "formats/base/text.h"

namespace relief {
namespace {

bool before(const toml::source_position& a, const toml::source_position& b) {
    return a.line != b.line ? a.line < b.line : a.column < b.column;
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
    const toml::node* node = find(key);
    if (node == nullptr) {
        return false;
    }
    if (!node->is_boolean()) {
        wrongType(*node, key, "true or false");
    }
    out = *node->value_exact<bool>();
    return true;
}
bool SceneTable::text(std::string_view key, std::string& out) {
    const toml::node* node = find(key);
    if (node == nullptr) {
        return false;
    }
    if (!node->is_string()) {
        wrongType(*node, key, "a string");
    }
    out = *node->value_exact<std::string>();
    return true;
}
bool SceneTable::vector(std::string_view key, const SceneRange& range, glm::vec3& out) {
    const toml::node* node = find(key);
    if (node == nullptr) {
        return false;
    }
    const toml::array* values = node->as_array();
    if (values == nullptr || values->size() != 3) {
        wrongType(*node, key, "three numbers [x, y, z]");
    }
    for (int i = 0; i < 3; ++i) {
        out[i] = static_cast<float>(numberOf(*values->get(static_cast<std::size_t>(i)), key, range));
    }
    return true;
}
bool SceneTable::vector(std::string_view key, const SceneRange& range, std::optional<glm::vec3>& out) {
    glm::vec3 value{0.0F};
    const bool found = vector(key, range, value);
    if (found) {
        out = value;
    }
    return found;
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
    // In the order of the file, so that the first mistake is the one reported.
    const toml::key* first = nullptr;
    for (const auto& [key, node] : *table_) {
        const bool known = std::find(known_.begin(), known_.end(), key.str()) != known_.end();
        if (!known && (first == nullptr || before(key.source().begin, first->source().begin))) {
            first = &key;
        }
    }
    if (first == nullptr) {
        return;
    }
    std::string list;
    for (const std::string_view key : known_) {
        list += (list.empty() ? "" : ", ") + std::string(key);
    }
    const std::string hint = didYouMean(first->str(), known_);
    failAt(first->source().begin, "unknown " + std::string(name_.empty() ? "table" : "key") + " '" +
                                      oneLine(full(first->str())) + "'" +
                                      (hint.empty() ? "; known are " + list : hint));
}
}  // namespace relief

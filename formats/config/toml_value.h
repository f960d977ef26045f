// SPDX-License-Identifier: Apache-2.0
// Values of a TOML file with their keys and positions. Wrong types and values out of range are errors, reported as
// "file:line:column: table.key …; the fix".
#pragma once

#include <cstdint>
#include <filesystem>
#include <functional>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "formats/base/field.h"
#include "formats/base/result.h"
#include "formats/config/toml.h"

namespace relief {

/// Formats a number in its usual form: "0.1".
[[nodiscard]] std::string numberText(double value);
/// Returns the text as one line without control characters, for messages about untrusted files.
[[nodiscard]] std::string oneLine(std::string_view text);

/// The file that values come from.
struct TomlFile {
    std::string name;              ///< as shown in messages
    std::filesystem::path folder;  ///< base of relative paths, which may not leave it (confined_path.h)
    std::filesystem::path root;    ///< additional folder that paths may lead to; empty: none
    std::string_view owner;        ///< owner of the folder, for messages: "scene"
    const toml::table* top = nullptr;
    bool is_text = true;  ///< false: values have no line and column
};

/// Thrown by the functions below if a value is invalid; readTomlFile() converts it into an Error.
struct TomlError {
    std::string message;
};

/// A value with its key and position. Cheap to copy; node and file must outlive it.
class TomlValue {
  public:
    /// \param name  "render.size"; empty for the top level.
    TomlValue(const toml::node& node, std::string name, const TomlFile& file)
        : node_(&node), name_(std::move(name)), file_(&file) {}

    [[nodiscard]] const toml::node& node() const { return *node_; }
    [[nodiscard]] const toml::array* array() const { return node_->as_array(); }
    [[nodiscard]] const std::string& name() const { return name_; }
    [[nodiscard]] const TomlFile& file() const { return *file_; }
    [[nodiscard]] std::string place() const;  ///< "file:line:column", or "file" if is_text is false
    /// Throws "place: message" with the place of a key of this table.
    [[noreturn]] void failAt(const toml::key& key, const std::string& message) const;
    /// Returns "table.key".
    [[nodiscard]] std::string full(std::string_view key) const;

    /// Returns the value at a relative path: "key", "emitter[1].key[0].time". A table counts as its own element 0.
    [[nodiscard]] std::optional<TomlValue> find(std::string_view path) const;
    [[nodiscard]] TomlValue operator[](std::size_t i) const { return {*array()->get(i), name_, *file_}; }

    [[nodiscard]] double number(const FieldRange& range) const;
    [[nodiscard]] std::int64_t whole(const FieldRange& range) const;
    [[nodiscard]] bool boolean() const;
    [[nodiscard]] std::string text() const;
    /// Returns the index of the value in `words`.
    [[nodiscard]] std::size_t word(std::span<const std::string_view> words) const;
    /// Returns a path, resolved.
    [[nodiscard]] std::filesystem::path path() const;
    /// Returns the index of the top-level table [[key]] that the value refers to, by index or by name.
    [[nodiscard]] std::int64_t indexOf(std::string_view key, const FieldRange& range) const;
    /// Returns an array of `size` numbers. \param unit  starts with the names of the elements: "[a, b, …]".
    [[nodiscard]] const toml::array& list(std::size_t size, bool whole, std::string_view unit) const;
    /// Returns this table, or each table of this array.
    [[nodiscard]] std::vector<TomlValue> tables(const FieldInfo& info) const;
    void needTable() const;

    [[noreturn]] void wrongType(std::string_view wanted) const;
    [[noreturn]] void fail(const std::string& message) const;  ///< throws "place: message"

  private:
    const toml::node* node_;
    std::string name_;
    const TomlFile* file_;
};

/// Parses a whole file. \param read  receives the top level, and may throw TomlError.
/// Errors: kInvalidInput, with file, line and column.
[[nodiscard]] Result<void> readTomlFile(std::string_view text, TomlFile file,
                                        const std::function<void(const TomlValue&)>& read);
/// Reads a table that was not parsed from text; messages have no line and column.
[[nodiscard]] Result<void> readTomlTable(const toml::table& top, TomlFile file,
                                         const std::function<void(const TomlValue&)>& read);

}  // namespace relief

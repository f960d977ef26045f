// SPDX-License-Identifier: Apache-2.0
// Reads a table of a TOML file into a struct with fields() (formats/base/field.h). Unknown keys, wrong types, values out of
// their range and keys that exclude each other are errors, each reported as "file:line:column: table.key …; the cure".
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
struct TomlError {
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

/// Reads one value.
void readValue(const TomlValue& from, FieldRef value, const FieldInfo& info);

/// Reads a table into a struct, and judges it by the rules of its fields and by its check(), which may also complete the
/// struct:
///     std::optional<FieldFault> check(T& value, const GivenFields& given);
/// A member `place` of the struct becomes the place of the table.
void readToml(const TomlValue& from, FieldRef value);

/// A whole file. \param read  gets its top level, and may throw TomlError.
/// Errors: kInvalidInput, with file, line and column.
[[nodiscard]] Result<void> readTomlFile(std::string_view text, TomlFile file,
                                        const std::function<void(const TomlValue&)>& read);
/// The same of a table that is no text: messages have no line and column.
[[nodiscard]] Result<void> readTomlTable(const toml::table& top, TomlFile file,
                                         const std::function<void(const TomlValue&)>& read);

}  // namespace relief

// One table of a file in TOML: typed access that names file, line and column of what is wrong. It needs toml++.
#pragma once

#include <cstdint>
#include <filesystem>
#include <glm/vec3.hpp>
#include <string>
#include <string_view>
#include <type_traits>
#include <vector>

#include "formats/config/toml.h"

namespace relief {

// Generous, yet small enough that nothing overflows a float within a lifetime: see README.md beside this file.
inline constexpr double kLengthMax = 1e9;
inline constexpr double kRateMax = 1e9;
inline constexpr double kSpeedMax = 1e6;
inline constexpr double kAccelerationMax = 1e6;
inline constexpr double kSecondsMax = 1e6;
inline constexpr double kDragMax = 1e6;

/// Raised by readers of scenes alone, where a value is found wrong; parseScene turns it into its Result.
struct SceneError {
    std::string message;
};

/// As people write it.
[[nodiscard]] std::string numberText(double value);
/// A line of text that a hostile file can neither break nor colour.
[[nodiscard]] std::string oneLine(std::string_view text);

/// Where the paths of a scene may lead (confined_path.h).
struct SceneFolder {
    std::filesystem::path own;   ///< the scene's, from which they are named
    std::filesystem::path root;  ///< another one; empty: none
};

struct SceneRange {
    double low;
    double high;
    bool low_included = true;

    [[nodiscard]] bool holds(double value) const;  ///< false for NaN
    [[nodiscard]] std::string text() const;        ///< "choose 0 to 1"
};

/// A number, or [least, most].
struct SceneSpan {
    double least = 0.0;
    double most = 0.0;
};

constexpr SceneRange symmetric(double limit) {
    return {-limit, limit};
}

/// Remembers which keys were asked for: what is left over at the end is unknown. All but the constructor
/// throw SceneError.
class SceneTable {
  public:
    /// \param table  null for a table that the file does not have: every key then is absent. It, name and file
    ///               must outlive this.
    SceneTable(const toml::table* table, std::string_view name, std::string_view file)
        : table_(table), name_(name), file_(file) {}

    /// The table `name` in this one.
    [[nodiscard]] SceneTable sub(std::string_view name);
    /// Whether the file has this table.
    [[nodiscard]] bool present() const { return table_ != nullptr; }
    /// The scene file, as messages name it.
    [[nodiscard]] std::string_view file() const { return file_; }

    /// The value of a key; null if absent.
    [[nodiscard]] const toml::node* find(std::string_view key);

    // Each reads a key into `out`, which may be optional, if it is there, and says whether it is.
    template <class T>
    bool number(std::string_view key, const SceneRange& range, T& out) {
        return take(key, out, [&](const toml::node& node) { return numberOf(node, key, range); });
    }
    template <class T>
    bool integer(std::string_view key, const SceneRange& range, T& out) {
        return take(key, out, [&](const toml::node& node) { return integerOf(node, key, range); });
    }
    template <class T>
    bool vector(std::string_view key, const SceneRange& range, T& out) {
        return take(key, out, [&](const toml::node& node) { return vectorOf(node, key, range); });
    }
    /// One of `words`; `out` is its index.
    template <class T>
    bool word(std::string_view key, const std::vector<std::string_view>& words, T& out) {
        return take(key, out, [&](const toml::node& node) { return wordOf(node, key, words); });
    }
    bool boolean(std::string_view key, bool& out);
    bool text(std::string_view key, std::string& out);
    /// Two whole numbers, or two numbers, as the type of `first` is.
    /// \param wanted  what the value must be, in words.
    template <class T, class U>
    bool pair(std::string_view key, const SceneRange& range, std::string_view wanted, T& first, U& second) {
        const toml::node* node = find(key);
        if (node != nullptr) {
            const toml::array& both = arrayOf(*node, key, 2, wanted);
            const auto value = [&](std::size_t i) {
                if constexpr (std::is_integral_v<T>) {
                    return integerOf(*both.get(i), key, range);
                } else {
                    return numberOf(*both.get(i), key, range);
                }
            };
            first = static_cast<T>(value(0));
            second = static_cast<U>(value(1));
        }
        return node != nullptr;
    }
    /// A path, resolved, and its place in the file.
    /// \param folder  of the scene, as everywhere.
    bool path(std::string_view key, const SceneFolder& folder, std::filesystem::path& out,
              std::string& origin);

    /// The tables of the array `key`; none if it is absent.
    [[nodiscard]] std::vector<const toml::table*> tables(std::string_view key, std::size_t most);

    /// An array of so many.
    [[nodiscard]] const toml::array& arrayOf(const toml::node& node, std::string_view key, std::size_t size,
                                             std::string_view wanted) const;
    [[nodiscard]] double numberOf(const toml::node& node, std::string_view key,
                                  const SceneRange& range) const;
    [[nodiscard]] std::int64_t integerOf(const toml::node& node, std::string_view key,
                                         const SceneRange& range) const;
    [[nodiscard]] glm::vec3 vectorOf(const toml::node& node, std::string_view key,
                                     const SceneRange& range) const;
    /// \param wanted  what the value must be, in words.
    [[nodiscard]] SceneSpan spanOf(const toml::node& node, std::string_view key, const SceneRange& range,
                                   std::string_view wanted) const;
    [[nodiscard]] std::size_t wordOf(const toml::node& node, std::string_view key,
                                     const std::vector<std::string_view>& words) const;

    [[noreturn]] void wrongType(const toml::node& node, std::string_view key, std::string_view wanted) const;
    /// "file:line:column: message"
    [[noreturn]] void failAt(const toml::node& node, const std::string& message) const;
    [[noreturn]] void failAt(const toml::source_position& at, const std::string& message) const;
    /// A setting that has no effect, and why.
    [[noreturn]] void failUseless(std::string_view key, const std::string& why) const;
    [[nodiscard]] std::string place(const toml::source_position& at) const;  ///< "file:line:column"
    [[nodiscard]] std::string full(std::string_view key) const;              ///< "table.key"

    /// Call last: any key that nobody has asked for is unknown.
    void finish() const;

  private:
    template <class T, class Read>
    bool take(std::string_view key, T& out, const Read& read) {
        const toml::node* node = find(key);
        if (node != nullptr) {
            out = static_cast<T>(read(*node));
        }
        return node != nullptr;
    }

    const toml::table* table_;
    std::string_view name_;
    std::string_view file_;
    std::vector<std::string_view> known_;
};

}  // namespace relief

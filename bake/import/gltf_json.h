// SPDX-License-Identifier: Apache-2.0
// Parses the JSON of a glTF file strictly, into values that track their position. Errors name the place in the
// document, such as "meshes[0].primitives[2].mode", not the file.
#pragma once

#include <cstddef>
#include <cstdint>
#include <nlohmann/json_fwd.hpp>
#include <optional>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "formats/base/result.h"

namespace relief {

/// Parses like parseStrictJson(), but accepts trailing spaces and zero bytes.
[[nodiscard]] Result<nlohmann::json> parseGltfJson(std::string_view text);

/// An object of the document. A member of the wrong type, including null, is an error (kInvalidInput).
class GltfValue {
  public:
    /// Borrows the document. \param document  an object.
    explicit GltfValue(const nlohmann::json& document) : document_(&document), json_(&document) {}

    /// Returns the error "PATH WHAT".
    [[nodiscard]] tl::unexpected<Error> wrong(const std::string& what,
                                              ErrorCode code = ErrorCode::kInvalidInput) const;

    [[nodiscard]] bool has(const char* name) const;
    /// Index in its parent list.
    [[nodiscard]] std::uint64_t index() const { return index_; }

    /// Reads a member; nullopt if it is missing. T is bool, std::uint64_t, std::string, or a vector of one of these or
    /// of float.
    template <class T>
    [[nodiscard]] Result<std::optional<T>> get(const char* name) const;
    /// Reads a member, or returns `otherwise` if it is missing.
    template <class T>
    [[nodiscard]] Result<T> get(const char* name, T otherwise) const {
        return RELIEF_TRY(get<T>(name)).value_or(std::move(otherwise));
    }
    /// Reads a whole number. Also fails if it is missing.
    [[nodiscard]] Result<std::uint64_t> number(const char* name) const;
    /// Reads a list of exactly `count` numbers; empty if it is missing.
    [[nodiscard]] Result<std::vector<float>> numbers(const char* name, std::size_t count) const;

    [[nodiscard]] Result<std::optional<GltfValue>> object(const char* name) const;
    /// Reads a list of objects; empty if it is missing.
    [[nodiscard]] Result<std::vector<GltfValue>> objects(const char* name) const;
    /// Resolves the index in `member` to an object of the document's `list`; nullopt if the member is missing.
    [[nodiscard]] Result<std::optional<GltfValue>> named(const char* member, const char* list) const;
    /// Resolves the index in `member`. Also fails if it is missing.
    [[nodiscard]] Result<GltfValue> needed(const char* member, const char* list) const;
    /// Returns entry `index` of the document's `list`. \param member  the member that holds the index, for messages.
    [[nodiscard]] Result<GltfValue> at(std::uint64_t index, const char* list, const char* member) const;

  private:
    [[nodiscard]] std::string pathOf(const char* name) const;
    [[nodiscard]] Result<GltfValue> child(const nlohmann::json& json, std::string path,
                                          std::uint64_t index = 0) const;

    const nlohmann::json* document_;
    const nlohmann::json* json_;
    std::string path_;  // "" for the document itself
    std::uint64_t index_ = 0;
};

}  // namespace relief

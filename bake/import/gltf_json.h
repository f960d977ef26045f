// SPDX-License-Identifier: Apache-2.0
// The JSON of a glTF file: read strictly, and values that know where they stand. Errors here name a place in the document,
// as "meshes[0].primitives[2].mode", and no file.
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

/// parseStrictJson(), but spaces and zeros may follow.
[[nodiscard]] Result<nlohmann::json> parseGltfJson(std::string_view text);

/// An object of the document. A member that is there but of another type than asked for is an error (kInvalidInput), and so
/// is null.
class GltfValue {
  public:
    /// \param document  an object; borrowed.
    explicit GltfValue(const nlohmann::json& document) : document_(&document), json_(&document) {}

    /// "PATH WHAT". \param code  kInvalidInput by default.
    [[nodiscard]] tl::unexpected<Error> wrong(const std::string& what,
                                              ErrorCode code = ErrorCode::kInvalidInput) const;

    [[nodiscard]] bool has(const char* name) const;
    /// Its place in the list that it is of.
    [[nodiscard]] std::uint64_t index() const { return index_; }

    /// bool, std::uint64_t, std::string, or a vector of float or these; nullopt where there is none.
    template <class T>
    [[nodiscard]] Result<std::optional<T>> get(const char* name) const;
    /// \param otherwise  where there is none.
    template <class T>
    [[nodiscard]] Result<T> get(const char* name, T otherwise) const {
        return RELIEF_TRY(get<T>(name)).value_or(std::move(otherwise));
    }
    /// Errors: also where there is none.
    [[nodiscard]] Result<std::uint64_t> number(const char* name) const;
    /// A list of `count` numbers; empty where there is none.
    [[nodiscard]] Result<std::vector<float>> numbers(const char* name, std::size_t count) const;

    [[nodiscard]] Result<std::optional<GltfValue>> object(const char* name) const;
    /// A list of objects; empty where there is none.
    [[nodiscard]] Result<std::vector<GltfValue>> objects(const char* name) const;
    /// The object in a list of the document that a member names by its number; nullopt where there is no member.
    [[nodiscard]] Result<std::optional<GltfValue>> named(const char* member, const char* list) const;
    /// Errors: also where there is no member.
    [[nodiscard]] Result<GltfValue> needed(const char* member, const char* list) const;
    /// The index'th of a list of the document. \param member  of this object, that names it.
    [[nodiscard]] Result<GltfValue> at(std::uint64_t index, const char* list, const char* member) const;

  private:
    [[nodiscard]] std::string pathOf(const char* name) const;
    [[nodiscard]] Result<GltfValue> child(const nlohmann::json& json, std::string path,
                                          std::uint64_t index = 0) const;

    const nlohmann::json* document_;
    const nlohmann::json* json_;
    std::string path_;  // "" for the document
    std::uint64_t index_ = 0;
};

}  // namespace relief

// The JSON of a glTF file: read strictly, and values that know where they stand. Errors here name a place in the document,
// as "meshes[0].primitives[2].mode", and no file.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <nlohmann/json.hpp>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "formats/base/result.h"

namespace relief {

/// Refuses, besides what is no JSON, equal keys in one object, and nesting of more than 256. Spaces and zeros may follow.
/// Errors: kInvalidInput, kLimit.
[[nodiscard]] Result<nlohmann::json> parseGltfJson(std::string_view text);

class GltfList;

/// An object of the document, which must outlive it. A member that is there but of another type than asked for is an error
/// (kInvalidInput), and so is null.
class GltfValue {
  public:
    explicit GltfValue(const nlohmann::json& document) : json_(&document) {}

    /// "the document" for all of it.
    [[nodiscard]] std::string path() const;
    /// "PATH WHAT". \param code  kInvalidInput by default.
    [[nodiscard]] tl::unexpected<Error> wrong(const std::string& what,
                                              ErrorCode code = ErrorCode::kInvalidInput) const;

    [[nodiscard]] bool isObject() const { return json_->is_object(); }
    [[nodiscard]] bool has(const char* name) const { return json_->is_object() && json_->contains(name); }
    [[nodiscard]] Result<std::optional<GltfValue>> object(const char* name) const;
    /// A list of objects; empty where there is none.
    [[nodiscard]] Result<GltfList> objects(const char* name) const;
    /// Up to 2⁵³; 24.0 is whole.
    [[nodiscard]] Result<std::optional<std::uint64_t>> whole(const char* name) const;
    [[nodiscard]] Result<std::uint64_t> neededWhole(const char* name) const;
    /// A list of whole numbers; empty where there is none.
    [[nodiscard]] Result<std::vector<std::uint64_t>> wholes(const char* name) const;
    /// false where there is none.
    [[nodiscard]] Result<bool> flag(const char* name) const;
    [[nodiscard]] Result<std::optional<std::string>> text(const char* name) const;
    [[nodiscard]] Result<std::vector<std::string>> texts(const char* name) const;
    /// A list of as many numbers as `out` holds, which stay where there is none. \return whether there is one.
    [[nodiscard]] Result<bool> numbers(const char* name, std::span<float> out) const;

  private:
    friend class GltfList;
    struct Step {
        const char* name = nullptr;
        std::optional<std::size_t> index;
    };
    /// Names are literals.
    [[nodiscard]] GltfValue step(const nlohmann::json& json, const char* name,
                                 std::optional<std::size_t> index = std::nullopt) const;
    [[nodiscard]] const nlohmann::json* member(const char* name) const;
    [[nodiscard]] Result<const nlohmann::json*> array(const char* name) const;

    const nlohmann::json* json_;
    std::array<Step, 8> steps_{};
    std::size_t depth_ = 0;
};

/// A list of objects of the document.
class GltfList {
  public:
    GltfList(const GltfValue& owner, const char* name, const nlohmann::json* array)
        : owner_(owner), name_(name), array_(array) {}

    [[nodiscard]] std::size_t size() const { return array_ == nullptr ? 0 : array_->size(); }
    /// \param index  below size().
    [[nodiscard]] Result<GltfValue> at(std::size_t index) const;
    /// The one that a member of `from` names. Errors: kInvalidInput (it does not exist).
    [[nodiscard]] Result<GltfValue> named(std::uint64_t index, const GltfValue& from,
                                          const char* member) const;

  private:
    GltfValue owner_;
    const char* name_;
    const nlohmann::json* array_;
};

}  // namespace relief

// SPDX-License-Identifier: Apache-2.0
// Material responses by name. Scenes and worlds use them to override the values in containers.
#pragma once

#include <optional>
#include <set>
#include <span>
#include <string>

#include "formats/base/field.h"
#include "formats/base/result.h"
#include "formats/base/source_place.h"
#include "formats/materials.h"

namespace relief {

/// A [[material]] of a scene, or an element of a world's "materials".
struct MaterialResponse {
    std::string name;
    std::optional<float> restitution;  ///< nullopt: unchanged; likewise the next two
    std::optional<float> friction;
    std::optional<float> lifetime_loss;
    SourcePlace origin{};  ///< of the name; set for scenes

    friend bool operator==(const MaterialResponse&, const MaterialResponse&) = default;
};

void fields(FieldVisitor& visit, MaterialResponse& response);

/// Returns the index of the first response that repeats an earlier name, or nullopt.
[[nodiscard]] std::optional<std::size_t> repeatedName(std::span<const MaterialResponse> responses);

/// Applies responses to the materials of several colliders, and records which names occurred.
class MaterialResponses {
  public:
    /// \param responses  borrowed; names are unique.
    explicit MaterialResponses(std::span<const MaterialResponse> responses) : responses_(responses) {}

    void apply(Materials& materials);
    /// Records names without applying responses.
    void recordNames(const Materials& materials);
    /// Returns nullopt if a recorded material has this name. Otherwise returns "is not the name of a material; there
    /// are 'oak', 'stone'", with the names recorded so far.
    [[nodiscard]] std::optional<std::string> faultOf(const std::string& name) const;

  private:
    std::span<const MaterialResponse> responses_;
    std::set<std::string> names_;  // all recorded materials
};

}  // namespace relief

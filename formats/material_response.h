// SPDX-License-Identifier: Apache-2.0
// Responses of materials by name, as scenes and worlds give them in place of the containers' own.
#pragma once

#include <optional>
#include <set>
#include <span>
#include <string>
#include <vector>

#include "formats/base/field.h"
#include "formats/base/result.h"
#include "formats/base/source_place.h"
#include "formats/materials.h"

namespace relief {

/// A [[material]] of a scene, an element of a world's "materials".
struct MaterialResponse {
    std::string name;
    std::optional<float> restitution;  ///< nullopt: as it was, as of the next two
    std::optional<float> friction;
    std::optional<float> lifetime_loss;
    SourcePlace place{};  ///< of a scene's

    friend bool operator==(const MaterialResponse&, const MaterialResponse&) = default;
};

void fields(FieldVisitor& visit, MaterialResponse& response);

/// Two of a name, by the index of the second; nullopt: there are none.
[[nodiscard]] std::optional<std::size_t> repeatedName(std::span<const MaterialResponse> responses);

/// Gives materials of several colliders their responses, and knows in the end which of these are of none.
class MaterialResponses {
  public:
    /// \param responses  no two of one name; borrowed.
    explicit MaterialResponses(std::span<const MaterialResponse> responses) : responses_(responses) {}

    void apply(Materials& materials);
    /// Their names alone.
    void see(const Materials& materials);
    /// "is the name of no material; there are 'oak' and 'stone'", if any collider that was seen has some. nullopt: one has it.
    [[nodiscard]] std::optional<std::string> faultOf(const std::string& name) const;

  private:
    std::span<const MaterialResponse> responses_;
    std::set<std::string> names_;  // of all materials
};

}  // namespace relief

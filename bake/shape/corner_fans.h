// SPDX-License-Identifier: Apache-2.0
// The mitres of a sheet's corners: the directions in which a shell moves its vertices.
#pragma once

#include <array>
#include <cstdint>
#include <glm/vec3.hpp>
#include <span>
#include <vector>

#include "bake/shape/sheet.h"

namespace relief {

/// Groups corners of the same vertex that share a mitre.
class CornerFans {
  public:
    /// Splits each fan (corners of one vertex, joined by triangle sides) whose common mitre would thin the shell, and
    /// cuts the sheet there.
    explicit CornerFans(Sheet& sheet);

    /// Per corner, the lowest index of the corners that share its mitre; corner k of triangle i is 3·i + k.
    [[nodiscard]] const std::vector<std::uint32_t>& roots() const { return roots_; }
    [[nodiscard]] const glm::dvec3& mitreOf(std::uint32_t corner) const { return mitres_[roots_[corner]]; }
    /// Whether a fan was split between two corners of one vertex.
    [[nodiscard]] bool areCut(std::uint32_t a, std::uint32_t b) const {
        return fan_of_[a] == fan_of_[b] && roots_[a] != roots_[b];
    }
    /// For each cut, the two corners of the vertex next to the cut. The triangle side that begins at the
    /// first corner was cut, and is now open.
    [[nodiscard]] const std::vector<std::array<std::uint32_t, 2>>& cuts() const { return cuts_; }
    /// For each split fan that surrounded its vertex completely, the roots of its pieces.
    [[nodiscard]] const std::vector<std::vector<std::uint32_t>>& lids() const { return lids_; }

  private:
    struct Mitre;

    [[nodiscard]] const glm::dvec3& normalOf(std::uint32_t corner) const { return normals_[corner / 3]; }
    void addTo(Mitre& mitre, std::uint32_t corner) const;
    void addFan(std::vector<std::uint32_t>& fan, bool closed);
    void setMitre(std::span<const std::uint32_t> corners, const glm::dvec3& mitre);
    void cut(std::uint32_t corner, std::uint32_t next);

    Sheet& sheet_;
    std::vector<glm::dvec3> normals_;  // by triangle
    std::vector<std::uint32_t> roots_;
    std::vector<glm::dvec3> mitres_;     // by root
    std::vector<std::uint32_t> fan_of_;  // the first corner of the fan before it was split
    std::vector<std::array<std::uint32_t, 2>> cuts_;
    std::vector<std::vector<std::uint32_t>> lids_;
};

}  // namespace relief

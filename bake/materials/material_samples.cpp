// SPDX-License-Identifier: Apache-2.0
#include "bake/materials/material_samples.h"

#include <tbb/parallel_for.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <glm/vector_relational.hpp>
#include <optional>
#include <utility>

#include "bake/mesh/mesh_query.h"
#include "formats/patch_tree.h"

namespace relief {
namespace {

constexpr std::size_t kSamples = 400'000;
/// Maximum distance between a contact and its mesh point, in local texels.
constexpr double kReach = 1.5;
/// Precision of a contact's position, as a fraction of kReach.
constexpr double kNear = 0.03;

struct SurfacePoint {
    glm::dvec3 at;
    glm::dvec3 normal;  ///< unit length
    std::uint32_t triangle = 0;
};

class SurfacePoints {
  public:
    explicit SurfacePoints(const MaterialSource& source) : source_(source) {
        double area = 0.0;
        for (const glm::uvec3& t : source.triangles) {
            area += length(planeOf(source.positions, t).normal);
            sums_.push_back(area);
        }
    }

    [[nodiscard]] SurfacePoint at(std::size_t k) const {
        const double fraction = (static_cast<double>(k) + 0.5) / static_cast<double>(kSamples);
        const auto found = std::lower_bound(sums_.begin(), sums_.end(), fraction * sums_.back());
        const auto index = std::min(static_cast<std::size_t>(found - sums_.begin()), sums_.size() - 1);
        const glm::uvec3& t = source_.triangles[index];
        // Roberts's sequence R2, folded into the triangle.
        double u = std::fmod(static_cast<double>(k) * 0.7548776662466927, 1.0);
        double v = std::fmod(static_cast<double>(k) * 0.5698402909980532, 1.0);
        if (u + v > 1.0) {
            u = 1.0 - u;
            v = 1.0 - v;
        }
        const glm::dvec3 a(source_.positions[t.x]);
        return {
            a + u * (glm::dvec3(source_.positions[t.y]) - a) + v * (glm::dvec3(source_.positions[t.z]) - a),
            unit(planeOf(source_.positions, t).normal), static_cast<std::uint32_t>(index)};
    }

  private:
    const MaterialSource& source_;
    std::vector<double> sums_;
};

/// Returns the length of the collider's texels at a point, in object units. It differs between leaves with patches.
double texelAt(const Collider& collider, const glm::vec3& p, float finest) {
    float texel = finest;
    for (const DepthMap& map : collider.maps) {
        if (map.projection() != Projection::kLocal) {
            continue;
        }
        const glm::vec3 at = map.object_to_map.apply(p);
        const glm::vec3 roots(patchTreeSize(map.texels).roots);
        if (glm::all(glm::greaterThanEqual(at, glm::vec3(0.0F))) && glm::all(glm::lessThan(at, roots))) {
            const PatchLeaf leaf = patchLeafAt(map.texels, at);
            texel = std::max(texel, map.object_per_map.x * leaf.cell /
                                        static_cast<float>(std::max(leaf.record.side(), 2U) - 1));
        }
    }
    return double{texel};
}

/// Finds where a line along a normal leaves the collider, within `reach`, and the normal just inside that point.
std::optional<SurfacePoint> contactOf(const Collider& collider, const SurfacePoint& from, double reach) {
    double low = -reach;
    double high = reach;
    FieldSample within;
    const auto probe = [&](double along) {
        const FieldSample sample = evaluate(collider, glm::vec3(from.at + along * from.normal));
        (sample.inside() ? low : high) = along;
        within = sample.inside() ? sample : within;
        return sample.inside();
    };
    // Most points that no contact reaches have a solid in front of them.
    if (evaluateInside(collider, glm::vec3(from.at + high * from.normal)).inside || !probe(low)) {
        return std::nullopt;
    }
    // A step by the field's distance ends at the contact, unless another surface is closer or the surface is slanted.
    const double guess = low + std::abs(double{within.distance});
    for (const double along : {guess + 0.4 * kNear * reach, guess - 0.4 * kNear * reach}) {
        if (along > low && along < high) {
            static_cast<void>(probe(along));
        }
    }
    while (high - low > kNear * reach) {
        static_cast<void>(probe(0.5 * (low + high)));
    }
    return SurfacePoint{from.at + high * from.normal, glm::dvec3(within.normal), from.triangle};
}

/// Selects the surface near the collider, which may be a tile.
MaterialSource near(const MaterialSource& source, const Bounds& box) {
    const glm::vec3 room(box.longestSide() / 32.0F);
    MaterialSource part;
    part.positions = source.positions;
    part.sides = source.sides;
    for (std::size_t i = 0; i < source.triangles.size(); ++i) {
        const glm::uvec3& t = source.triangles[i];
        const Bounds own =
            boundsOf(std::array{source.positions[t.x], source.positions[t.y], source.positions[t.z]});
        if (glm::all(glm::lessThanEqual(own.min, box.max + room)) &&
            glm::all(glm::greaterThanEqual(own.max, box.min - room))) {
            part.triangles.push_back(t);
            part.ids.push_back(source.ids[i]);
        }
    }
    return part;
}

Result<MeshQuery> queryOf(const MaterialSource& source) {
    TriangleMesh mesh;
    mesh.positions = source.positions;
    mesh.triangles = source.triangles;
    mesh.bounds = boundsOf(mesh.positions);
    // A single body avoids computing edges; the inside is irrelevant here.
    return MeshQuery::build(
        PreparedMesh::unionOf(std::move(mesh), std::vector<std::uint32_t>(source.triangles.size(), 1)));
}

}  // namespace

std::vector<MaterialSample> sampleContacts(const Collider& collider, const MaterialSource& whole) {
    const MaterialSource source = near(whole, collider.bounds);
    const Result<MeshQuery> query = queryOf(source);
    if (!query || source.triangles.empty()) {
        return {};  // without samples, the tree is fitted only to the faces
    }
    const SurfacePoints points(source);
    const float finest = finestTexel(collider);
    const std::size_t sides = source.sides ? 1 : 2;  // contacts reach both sides of a sheet
    std::vector<std::array<std::optional<MaterialSample>, 2>> all(kSamples);
    tbb::parallel_for(std::size_t{0}, kSamples, [&](std::size_t k) {
        SurfacePoint from = points.at(k);
        const double texel = texelAt(collider, glm::vec3(from.at), finest);
        for (std::size_t side = 0; side < sides; ++side, from.normal = -from.normal) {
            const std::optional<SurfacePoint> contact = contactOf(collider, from, kReach * texel);
            if (!contact) {
                continue;
            }
            const ClosestPoint foot = query->closest(glm::vec3(contact->at), contact->triangle);
            const std::uint8_t id = source.ids[foot.triangle];
            const bool unclear = query->hasOtherLabelWithin(glm::vec3(foot.point), texel, source.ids, id);
            all[k][side] = MaterialSample{contact->at, contact->normal, id, unclear ? 1 : kClearContact};
        }
    });
    std::vector<MaterialSample> samples;
    for (const auto& of_point : all) {
        for (const std::optional<MaterialSample>& sample : of_point) {
            if (sample) {
                samples.push_back(*sample);
            }
        }
    }
    return samples;
}

}  // namespace relief

// SPDX-License-Identifier: Apache-2.0
#include "bake/import/level.h"

#include <algorithm>
#include <cmath>
#include <map>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "formats/base/hash.h"
#include "formats/base/text.h"
#include "formats/validate.h"

namespace relief {
namespace {

constexpr double kUnitTolerance = 1e-6;
constexpr double kPoseMax = 1e15;

bool isPose(const LevelBody& body) {
    double square = 0.0;
    for (const double part : body.rotation) {
        square += part * part;
    }
    // Written to reject NaN.
    return std::abs(square - 1.0) <= kUnitTolerance && body.scale > 0.0 && body.scale <= kPoseMax &&
           std::ranges::all_of(body.position, [](double x) { return std::abs(x) <= kPoseMax; });
}

bool fits(const TriangleMesh& all) {
    std::uint64_t positions = 0;
    std::uint64_t triangles = 0;
    for (const LevelMesh& mesh : all.level_meshes) {
        if (mesh.positions > all.positions.size() || mesh.triangles > all.triangles.size()) {
            return false;
        }
        positions += mesh.positions;
        triangles += mesh.triangles;
    }
    return positions == all.positions.size() && triangles == all.triangles.size() &&
           std::ranges::all_of(all.level_bodies, [&](const LevelBody& body) {
               return body.mesh < all.level_meshes.size() && isPose(body);
           });
}

template <class T>
std::vector<T> cut(const std::vector<T>& all, std::size_t first, std::size_t count) {
    const std::span<const T> part = all.empty() ? std::span<const T>() : std::span(all).subspan(first, count);
    return {part.begin(), part.end()};
}

/// Copies the labels of one mesh, and the names that the labels reference.
void takeLabels(const TriangleMesh& all, std::size_t first, TriangleMesh& mesh) {
    std::map<std::uint32_t, std::uint32_t> places;
    for (std::size_t i = 0; !all.labels.empty() && i < mesh.triangles.size(); ++i) {
        const std::uint32_t label = all.labels[first + i];
        const auto [found, added] =
            places.try_emplace(label, static_cast<std::uint32_t>(mesh.surface_names.size()));
        if (added) {
            mesh.surface_names.push_back(all.surface_names[label]);
        }
        mesh.labels.push_back(found->second);
    }
    if (all.labels.empty()) {
        mesh.surface_names = all.surface_names;
    }
    dropSingleLabel(mesh);
}

/// Whether finishMesh() finds a triangle with area, or fails.
bool hasAreaOrFault(const TriangleMesh& mesh) {
    return std::ranges::any_of(mesh.triangles, [&mesh](const glm::uvec3& t) {
        return std::max({t.x, t.y, t.z}) >= mesh.positions.size() || hasArea(planeOf(mesh.positions, t));
    });
}

std::string hashOf(const TriangleMesh& mesh) {
    std::vector<std::byte> bytes;
    const auto add = [&bytes](const auto& all) {
        const auto more = std::as_bytes(std::span(all));
        bytes.insert(bytes.end(), more.begin(), more.end());
    };
    add(std::vector<std::uint64_t>{mesh.positions.size(), mesh.triangles.size()});
    add(mesh.positions);
    add(mesh.triangles);
    return xxh3_128Hex(bytes);
}

}  // namespace

std::string materialHash(const TriangleMesh& mesh) {
    std::map<std::string_view, std::uint32_t> known;
    std::string text;
    std::uint32_t previous = kNoLabel;
    const std::size_t count = mesh.labels.empty() ? mesh.surface_names.size() : mesh.labels.size();
    for (std::size_t i = 0; i < count; ++i) {
        const SurfaceName& name = mesh.surface_names[mesh.labels.empty() ? i : mesh.labels[i]];
        const auto [found, added] =
            known.try_emplace(name.material, static_cast<std::uint32_t>(known.size()));
        if (found->second != previous) {
            previous = found->second;
            text += std::to_string(i) + ":" + std::to_string(previous) +
                    (added ? name.material + '|' + shortest(name.restitution) + '|' + shortest(name.friction)
                           : "") +
                    std::string(1, '\0');
        }
    }
    return xxh3_128Hex(std::as_bytes(std::span(text)));
}

bool hasSeveralMaterials(std::span<const TriangleMesh> meshes) {
    std::optional<std::string_view> first;
    for (const TriangleMesh& mesh : meshes) {
        if (mesh.surface_names.empty() && first.value_or("") != "") {
            return true;
        }
        for (const SurfaceName& name : mesh.surface_names) {
            if (first.value_or(name.material) != name.material) {
                return true;
            }
            first = name.material;
        }
        first = first.value_or("");
    }
    return false;
}

std::uint32_t LevelMeshes::add(TriangleMesh mesh, bool materials) {
    mesh.content_hash = hashOf(mesh);
    const auto [found, added] =
        known_.try_emplace({mesh.content_hash, mesh.marks, materials ? materialHash(mesh) : ""},
                           static_cast<std::uint32_t>(meshes_.size()));
    if (added) {
        meshes_.push_back(std::move(mesh));
    }
    return found->second;
}

Result<Level> splitLevel(TriangleMesh all, bool materials) {
    if (!fits(all)) {
        return invalidInput("the importer returned an inconsistent level; export it again");
    }
    const std::string stem = std::filesystem::path(all.name).stem().string();
    Level level;
    level.name = all.name;
    level.unit = all.unit;
    level.dependencies = std::move(all.dependencies);
    level.dependency_hashes = std::move(all.dependency_hashes);
    level.warnings = std::move(all.warnings);
    LevelMeshes meshes;
    std::vector<std::optional<std::uint32_t>> places;  // by mesh
    std::size_t position = 0;
    std::size_t triangle = 0;
    for (const LevelMesh& one : all.level_meshes) {
        TriangleMesh mesh;
        mesh.name = cleanUtf8(one.name.empty() ? stem : one.name, kMeshNameMax);
        mesh.unit = all.unit;
        mesh.positions = cut(all.positions, position, one.positions);
        mesh.triangles = cut(all.triangles, triangle, one.triangles);
        mesh.marks = cut(all.marks, triangle, one.triangles);
        takeLabels(all, triangle, mesh);
        position += one.positions;
        triangle += one.triangles;
        if (!hasAreaOrFault(mesh)) {
            level.warnings.push_back(level.name + ": left out the mesh '" + mesh.name +
                                     "': none of its triangles has an area");
            places.emplace_back(std::nullopt);
            continue;
        }
        mesh = RELIEF_TRY(finishMesh(std::move(mesh)));
        places.emplace_back(meshes.add(std::move(mesh), materials));
    }
    level.meshes = meshes.take();
    std::vector<bool> placed(level.meshes.size(), false);
    for (LevelBody& body : all.level_bodies) {
        if (const std::optional<std::uint32_t> mesh = places[body.mesh]) {
            body.mesh = *mesh;
            placed[*mesh] = true;
            level.bodies.push_back(std::move(body));
        }
    }
    if (level.bodies.empty()) {
        return invalidInput("it has no mesh with an area; export it again");
    }
    if (std::ranges::find(placed, false) != placed.end()) {
        return invalidInput("the importer returned a mesh that no body places; export it again");
    }
    return level;
}

}  // namespace relief

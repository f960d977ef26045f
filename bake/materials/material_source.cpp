// SPDX-License-Identifier: Apache-2.0
#include "bake/materials/material_source.h"

#include <algorithm>
#include <map>
#include <string>

#include "formats/base/text.h"

namespace relief {
namespace {

/// Returns the index of a material by name, and adds new names. Fails if the name has another restitution or friction.
Result<std::size_t> idOf(const SurfaceName& name, const TriangleMesh& mesh,
                         std::map<std::string, std::size_t>& known, std::vector<Material>& list) {
    const auto [found, added] = known.try_emplace(name.material, list.size());
    if (added) {
        list.push_back({name.material, name.restitution, name.friction});
    }
    const Material& one = list[found->second];
    if (one.restitution != name.restitution || one.friction != name.friction) {
        return invalidInput(mesh.name + ": its material '" + name.material + "' has restitution " +
                            shortest(one.restitution) + " and friction " + shortest(one.friction) +
                            " in one place, and " + shortest(name.restitution) + " and " +
                            shortest(name.friction) + " at '" + name.node +
                            "'; give them different names, or bake with --materials drop");
    }
    return found->second;
}

}  // namespace

Result<MaterialSource> materialSource(const TriangleMesh& mesh, bool single) {
    const bool one_surface = mesh.labels.empty();
    if (one_surface && (!single || mesh.surface_names.empty())) {
        return MaterialSource();
    }
    std::vector<double> area(mesh.surface_names.size(), 0.0);
    double whole = 0.0;
    for (std::uint32_t i = 0; i < mesh.triangles.size(); ++i) {
        const std::uint32_t label = one_surface ? 0 : mesh.labels[i];
        if (label < area.size()) {
            const double triangle_area = 0.5 * length(planeOf(mesh, i).normal);
            area[label] += triangle_area;
            whole += triangle_area;
        }
    }
    MaterialSource source;
    std::map<std::string, std::size_t> known;
    std::vector<std::size_t> id_of_label(area.size(), 0);
    std::vector<double> fractions;
    for (std::size_t label = 0; label < area.size(); ++label) {
        if (area[label] > 0.0) {
            id_of_label[label] = RELIEF_TRY(idOf(mesh.surface_names[label], mesh, known, source.list));
            fractions.resize(source.list.size(), 0.0);
            fractions[id_of_label[label]] += area[label] / whole;
        }
    }
    if (source.list.size() < 2 && !(single && source.list.size() == 1 && !source.list[0].name.empty())) {
        return MaterialSource();
    }
    if (source.list.size() > kMaterialsMax) {
        return fail(ErrorCode::kLimit, mesh.name + ": it has " + std::to_string(source.list.size()) +
                                           " materials, but a collider stores at most " +
                                           std::to_string(kMaterialsMax) +
                                           "; merge some, or bake with --materials drop");
    }
    for (std::size_t i = 0; i < fractions.size(); ++i) {
        source.list[i].area_fraction = static_cast<float>(std::min(fractions[i], 1.0));
    }
    source.positions = mesh.positions;
    for (std::uint32_t i = 0; i < mesh.triangles.size(); ++i) {
        const std::uint32_t label = one_surface ? 0 : mesh.labels[i];
        if (label < area.size()) {
            source.triangles.push_back(mesh.triangles[i]);
            source.ids.push_back(static_cast<std::uint8_t>(id_of_label[label]));
        }
    }
    return source;
}

}  // namespace relief

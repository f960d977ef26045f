// [[type]]: how particles of a type move, collide and look.
#include <algorithm>
#include <string>

#include "runtime/scene/scene_readers.h"

namespace relief {
namespace {

/// mass, radius, restitution, friction, friction_threshold, on_collision, lifetime_loss.
/// \param type  holds the defaults.
void readPhysics(SceneTable& table, ParticleType& type) {
    table.number("mass", {1e-15, 1e9}, type.mass);
    table.number("radius", {0.0, kLengthMax}, type.radius);
    table.number("restitution", {0.0, 1.0}, type.restitution);
    table.number("friction", {0.0, 1.0}, type.friction);
    table.number("friction_threshold", {0.0, kSpeedMax}, type.friction_threshold);
    table.word("on_collision", {"bounce", "stop", "slide", "die"}, type.on_collision);
    table.number("lifetime_loss", {0.0, kSecondsMax}, type.lifetime_loss);
}

}  // namespace

void readTypes(SceneTable& top, std::string_view file, Scene& scene) {
    const auto& render = scene.render;
    const std::uint32_t cells = render.atlas.empty() ? 0 : render.atlas_columns * render.atlas_rows;
    bool cell = false;
    for (const toml::table* one : top.tables("type", kLooksMax)) {
        SceneTable table(one, "type", file);
        ParticleLook look;
        readLook(table, cells, look);
        ParticleType type;
        type.restitution = scene.collision.restitution;
        type.friction = scene.collision.friction;
        type.friction_threshold = scene.collision.friction_threshold;
        readPhysics(table, type);
        std::string name;
        if (table.text("name", name)) {
            const bool taken =
                std::find(scene.type_names.begin(), scene.type_names.end(), name) != scene.type_names.end();
            if (name.empty() || taken) {
                table.failAt(*table.find("name"),
                             "type.name is " + std::string(taken ? "taken; choose another" : "empty"));
            }
        }
        table.finish();
        scene.types.push_back(type);
        scene.type_names.push_back(std::move(name));
        scene.type_places.push_back(table.place(one->source().begin));
        cell = cell || look.cell_first.has_value();
        scene.render.looks.push_back(std::move(look));
    }
    if (cells > 0 && !cell) {
        throw SceneError{render.atlas_origin +
                         ": render.atlas does nothing while no [[type]] has a cell; give one " +
                         "'cell = 0', or remove the atlas"};
    }
}

}  // namespace relief

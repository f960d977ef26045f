// [[type]]: how particles of a type move, collide and look.
#include <algorithm>
#include <string>

#include "runtime/scene/scene_readers.h"

namespace relief {
namespace {

constexpr double kGravityMax = 1000.0;

/// collides: the numbers of colliders, from 0, and "ground".
void readCollides(SceneTable& table, const Scene& scene, ParticleType& type) {
    const toml::node* node = table.find("collides");
    if (node == nullptr) {
        return;
    }
    constexpr std::string_view kWanted = "numbers of colliders and perhaps \"ground\", as in [0, \"ground\"]";
    const toml::array* list = node->as_array();
    if (list == nullptr) {
        table.wrongType(*node, "collides", kWanted);
    }
    type.collides = 0;
    for (const toml::node& one : *list) {
        if (one.is_string()) {
            static_cast<void>(table.wordOf(one, "collides", {"ground"}));
            if (!scene.ground.enabled) {
                table.failAt(one, "type.collides names the ground, which ground.enabled = false takes away");
            }
            type.collides |= kCollidesWithGround;
        } else if (one.is_integer()) {
            const double last = static_cast<double>(scene.colliders.size()) - 1.0;
            type.collides |= 1U << table.integerOf(one, "collides", {0.0, last});
        } else {
            table.wrongType(one, "collides", kWanted);
        }
    }
    // What is not there, nobody collides with: that nothing is left out is then worth a faster step.
    const std::uint32_t there =
        (1U << scene.colliders.size()) - 1U + (scene.ground.enabled ? kCollidesWithGround : 0U);
    type.collides = type.collides == there ? kCollidesWithAll : type.collides;
}

/// gravity, mass, radius, restitution, friction, friction_threshold, on_collision, lifetime_loss.
/// \param type  holds the defaults.
void readPhysics(SceneTable& table, ParticleType& type) {
    table.number("gravity", symmetric(kGravityMax), type.gravity);
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
        readLook(table, cells, render.sprite, look);
        ParticleType type;
        type.restitution = scene.collision.restitution;
        type.friction = scene.collision.friction;
        type.friction_threshold = scene.collision.friction_threshold;
        readPhysics(table, type);
        readCollides(table, scene, type);
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

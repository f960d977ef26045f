// What particles look like: keys of [[type]], and the sprites of [render].
#include <string>

#include "runtime/scene/scene_readers.h"

namespace relief {
namespace {

constexpr double kRadiansMax = 1e6;
constexpr double kCellsMax = 4096;

/// One value, or keys [age, value…] of `parts` numbers each besides the age. `add` gets age and numbers of
/// each.
template <class Add>
void readTrack(SceneTable& table, std::string_view key, const SceneRange& range, std::size_t parts,
               const Add& add) {
    const toml::node* node = table.find(key);
    if (node == nullptr) {
        return;
    }
    const std::string wanted =
        parts == 1 ? "a number, or keys [[age, value], …]" : "[r, g, b], or keys [[age, r, g, b], …]";
    const toml::array* list = node->as_array();
    std::vector<double> values(parts);
    if (list == nullptr || list->empty() || !list->get(0)->is_array()) {
        if (parts == 1 ? !node->is_number() : (list == nullptr || list->size() != parts)) {
            table.wrongType(*node, key, wanted);
        }
        for (std::size_t i = 0; i < parts; ++i) {
            values[i] = table.numberOf(parts == 1 ? *node : *list->get(i), key, range);
        }
        add(0.0F, values);
        return;
    }
    if (list->size() > kLookKeysMax) {
        table.failAt(*node, table.full(key) + " has " + std::to_string(list->size()) + " keys; give " +
                                std::to_string(kLookKeysMax) + " at most");
    }
    float before = -1.0F;
    for (const toml::node& one : *list) {
        const toml::array* numbers = one.as_array();
        if (numbers == nullptr || numbers->size() != parts + 1) {
            table.wrongType(one, key, wanted);
        }
        const auto age = static_cast<float>(table.numberOf(*numbers->get(0), key, {0.0, 1.0}));
        if (age <= before) {
            table.failAt(*numbers->get(0), "the ages of " + table.full(key) + " do not rise; sort its keys");
        }
        before = age;
        for (std::size_t i = 0; i < parts; ++i) {
            values[i] = table.numberOf(*numbers->get(i + 1), key, range);
        }
        add(age, values);
    }
}

void readTrack(SceneTable& table, std::string_view key, const SceneRange& range, AgeTrack<float>& track) {
    readTrack(table, key, range, 1, [&](float age, const std::vector<double>& values) {
        track.push_back({age, static_cast<float>(values[0])});
    });
}

void readCells(SceneTable& table, std::uint32_t cells, ParticleLook& look) {
    const toml::node* node = table.find("cell");
    if (node == nullptr) {
        return;
    }
    const toml::array* both = node->as_array();
    if (both != nullptr ? both->size() != 2 : !node->is_integer()) {
        table.wrongType(*node, "cell", "a whole number, or two [first, last]");
    }
    if (cells == 0) {
        table.failUseless("cell", "without render.atlas; name a PNG there, or remove it");
    }
    const SceneRange range{0.0, static_cast<double>(cells - 1)};
    look.cell_first =
        static_cast<std::uint32_t>(table.integerOf(both == nullptr ? *node : *both->get(0), "cell", range));
    look.cell_last =
        static_cast<std::uint32_t>(table.integerOf(both == nullptr ? *node : *both->get(1), "cell", range));
    if (*look.cell_first > look.cell_last) {
        table.failAt(*node, table.full("cell") + " has its first above its last; exchange them");
    }
}

}  // namespace

void readLook(SceneTable& table, std::uint32_t cells, Sprite sprite, ParticleLook& look) {
    readTrack(table, "size", {0.0, kLengthMax}, look.size);
    readTrack(table, "color", {0.0, 1.0}, 3, [&](float age, const std::vector<double>& values) {
        look.color.push_back({age, glm::vec3(values[0], values[1], values[2])});
    });
    readTrack(table, "opacity", {0.0, 1.0}, look.opacity);
    readTrack(table, "rotation", symmetric(kRadiansMax), look.rotation);
    table.number("turn", {0.0, kRadiansMax}, look.turn);
    table.number("spin", {0.0, kRadiansMax}, look.spin);
    table.number("stretch", {0.0, kSecondsMax}, look.stretch);
    if (look.stretch > 0.0F && sprite == Sprite::kPoint) {
        table.failUseless("stretch", "for points; choose render.sprite = \"quad\"");
    }
    for (const std::string_view key : {"rotation", "turn", "spin"}) {
        if (look.stretch > 0.0F && table.find(key) != nullptr) {
            table.failUseless(key, "for sprites that " + table.full("stretch") +
                                       " turns along their way; remove one of them");
        }
    }
    readCells(table, cells, look);
    table.boolean("lit", look.lit);
    if (look.opacity.size() > 1) {  // it says how the particle begins and ends
        look.fade_in = 0.0F;
        look.fade_out = 0.0F;
    }
    table.pair("fade", {0.0, kSecondsMax}, "two numbers of seconds [in, out]", look.fade_in, look.fade_out);
}

void readSprites(SceneTable& render, const SceneFolder& folder, Scene& scene) {
    auto& out = scene.render;
    render.word("sprite", {"point", "quad"}, out.sprite);
    render.word("blend", {"alpha", "additive"}, out.blend);
    render.number("soft", {0.0, kLengthMax}, out.soft);
    const bool atlas = render.path("atlas", folder, out.atlas, out.atlas_origin);
    const bool cells = render.pair("atlas_cells", {1.0, kCellsMax}, "two whole numbers [columns, rows]",
                                   out.atlas_columns, out.atlas_rows);
    if (cells && !atlas) {
        render.failUseless("atlas_cells", "without render.atlas; name a PNG there, or remove it");
    }
    if (render.path("mesh", folder, out.mesh, out.mesh_origin)) {
        // The mesh is drawn in its own space, and only once.
        const SceneCollider& first = scene.colliders.front();
        if (scene.colliders.size() > 1 || !first.keys.empty() || !(first.pose == Pose{})) {
            throw SceneError{out.mesh_origin +
                             ": render.mesh is drawn where it was baked, and for a single collider; remove "
                             "the mesh, or the collider's position, angle, scale and keys"};
        }
        if (first.live && out.mesh != first.path) {
            throw SceneError{out.mesh_origin +
                             ": render.mesh is another mesh than the one that deforms; name collider.mesh"};
        }
    }
}

}  // namespace relief

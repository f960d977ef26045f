// collider.mesh, collider.deform and collider.resolution: a collider that deforms.
#include <algorithm>
#include <cmath>
#include <glm/glm.hpp>
#include <numbers>

#include "runtime/scene/scene_readers.h"

namespace relief {
namespace {

constexpr double kHertzMax = 1000.0;
constexpr double kLiveSizeMin = 16;
constexpr double kLiveSizeMax = 4096;

/// A direction of any length but 0; whether it is there.
bool readDirection(SceneTable& table, std::string_view key, glm::vec3& out) {
    glm::vec3 v = out;
    if (!table.vector(key, symmetric(kLengthMax), v)) {
        return false;
    }
    // Scaled first: the square of a short one would vanish.
    const float largest = std::max({std::abs(v.x), std::abs(v.y), std::abs(v.z)});
    if (!(largest > 0.0F)) {
        table.failAt(*table.find(key), table.full(key) + " is no direction; choose one that is not 0");
    }
    out = glm::normalize(v / largest);
    return true;
}

bool readRange(SceneTable& table, float& low, float& high) {
    const bool found = table.pair("range", symmetric(kLengthMax), "two numbers [low, high]", low, high);
    if (found && !(low < high)) {
        table.failAt(*table.find("range"), table.full("range") + " does not rise; give the lower end first");
    }
    return found;
}

/// Refuses keys that a kind of deformation does not have.
void refuse(SceneTable& table, std::initializer_list<std::string_view> keys, const char* kind) {
    for (const std::string_view key : keys) {
        if (table.find(key) != nullptr) {
            table.failUseless(key, "for a " + std::string(kind) + "; remove it");
        }
    }
}

void readAngles(SceneTable& table, const toml::source_position& at, SceneLive& live) {
    Deformation& d = live.deformation;
    float degrees = 0.0F;
    if (!table.number("amplitude", {-360.0, 360.0}, degrees)) {
        table.failAt(at, "collider.deform needs an amplitude, in degrees for a bend or a twist");
    }
    d.amplitude = std::clamp(glm::radians(degrees), -2.0F * std::numbers::pi_v<float>,
                             2.0F * std::numbers::pi_v<float>);
    live.has_center = table.vector("center", symmetric(kLengthMax), d.center);
    live.has_range = readRange(table, d.range_low, d.range_high);
    readDirection(table, "axis", d.axis);
    if (d.kind == DeformKind::kTwist) {
        refuse(table, {"along", "wavelength"}, "twist");
        return;
    }
    refuse(table, {"wavelength"}, "bend");
    if (!readDirection(table, "along", d.along)) {
        table.failAt(at, "a bend needs collider.deform.along, the direction of what it bends");
    }
    // A person need not write a direction that is exactly across.
    const glm::vec3 across = d.along - glm::dot(d.along, d.axis) * d.axis;
    if (!(glm::length(across) > 0.7F)) {
        table.failAt(*table.find("along"),
                     "collider.deform.along lies along collider.deform.axis, about which it "
                     "bends; choose one across it");
    }
    d.along = glm::normalize(across);
}

void readWobble(SceneTable& table, const toml::source_position& at, SceneLive& live) {
    Deformation& d = live.deformation;
    refuse(table, {"axis", "along", "center", "range"}, "wobble");
    if (!table.number("amplitude", symmetric(kLengthMax), d.amplitude)) {
        table.failAt(at, "collider.deform needs an amplitude, a length for a wobble");
    }
    live.has_wavelength = table.number("wavelength", {0.0, kLengthMax, false}, d.wavelength);
    d.wavelength = std::max(d.wavelength, std::numeric_limits<float>::min());
}

/// The table collider.deform.
SceneLive readDeform(const SceneTable& table, const toml::node& node, std::string_view file) {
    SceneLive live;
    const toml::source_position at = node.source().begin;
    if (!node.is_table()) {
        table.wrongType(node, "deform", "a table, as { kind = \"twist\", amplitude = 40, frequency = 0.5 }");
    }
    SceneTable keys(node.as_table(), "collider.deform", file);
    Deformation& d = live.deformation;
    if (!keys.word("kind", {"bend", "twist", "wobble"}, d.kind)) {
        table.failAt(at, "collider.deform needs a kind: \"bend\", \"twist\" or \"wobble\"");
    }
    if (!keys.number("frequency", {0.0, kHertzMax}, d.frequency)) {
        table.failAt(at, "collider.deform needs a frequency, in 1/s");
    }
    float degrees = 0.0F;
    keys.number("phase", symmetric(1e6), degrees);
    d.phase = glm::radians(degrees);
    if (d.kind == DeformKind::kWobble) {
        readWobble(keys, at, live);
    } else {
        readAngles(keys, at, live);
    }
    keys.finish();
    return live;
}

}  // namespace

bool readLive(SceneTable& table, std::string_view file, const SceneFolder& folder, SceneCollider& collider) {
    std::string name;
    const bool has_mesh = table.text("mesh", name);
    const toml::node* deform = table.find("deform");
    if (!has_mesh) {
        if (deform != nullptr) {
            table.failUseless("deform", "without collider.mesh; name the mesh instead of a container");
        }
        if (table.find("resolution") != nullptr) {
            table.failUseless("resolution", "without collider.mesh: a container has its own");
        }
        return false;
    }
    const toml::node& node = *table.find("mesh");
    if (table.find("file") != nullptr) {
        table.failAt(node, "collider.mesh and collider.file are both given; remove one of them");
    }
    table.path("mesh", folder, collider.path, collider.origin);
    if (deform == nullptr) {
        table.failAt(node,
                     "collider.mesh needs collider.deform; for a mesh at rest give collider.file, baked with "
                     "'relief bake'");
    }
    collider.live = readDeform(table, *deform, file);
    table.integer("resolution", {kLiveSizeMin, kLiveSizeMax}, collider.live->resolution);
    return true;
}

}  // namespace relief

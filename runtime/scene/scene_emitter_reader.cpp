#include <algorithm>
#include <initializer_list>
#include <limits>
#include <string>

#include "runtime/particles/particle_system.h"
#include "runtime/scene/scene_readers.h"

namespace relief {
namespace {

namespace fs = std::filesystem;

constexpr double kSeedMax = 9007199254740992.0;
constexpr double kInheritMax = 1000.0;
// A step of the longest dt then holds 10,000 bursts.
constexpr double kBurstEveryMin = 1e-4;

// In the order of EmitterShape, then the box without extent.
const std::vector<std::string_view> kShapes{"box", "sphere", "shell", "disc", "points", "point"};
constexpr std::size_t kPoint = 5;

/// As a float that is not 0.
float positive(double value) {
    return std::max(static_cast<float>(value), std::numeric_limits<float>::min());
}

void readBox(SceneTable& table, SceneEmitter& emitter) {
    const SceneRange length = symmetric(kLengthMax);
    const bool low = table.vector("box_min", length, emitter.box_min);
    const bool high = table.vector("box_max", length, emitter.box_max);
    if (low != high) {
        const std::string_view given = low ? "box_min" : "box_max";
        table.failAt(*table.find(given),
                     table.full(given) + " needs " + table.full(low ? "box_max" : "box_min") + " beside it");
    }
    for (int i = 0; low && i < 3; ++i) {
        if ((*emitter.box_min)[i] > (*emitter.box_max)[i]) {
            table.failAt(*table.find("box_min"), "emitter.box_min lies above emitter.box_max on the " +
                                                     std::string(1, "xyz"[i]) + " axis; exchange them");
        }
    }
    glm::vec3 point{0.0F};
    if (table.vector("point", length, point)) {
        if (low) {
            table.failAt(*table.find("point"),
                         "emitter.point and emitter.box_min are two places; remove one");
        }
        emitter.box_min = point;
        emitter.box_max = point;
    }
}

/// A vector that must point somewhere.
template <class T>
bool readDirection(SceneTable& table, std::string_view key, T& out) {
    glm::vec3 value{0.0F};
    if (!table.vector(key, symmetric(kLengthMax), value)) {
        return false;
    }
    if (unitVector(value) == glm::vec3(0.0F)) {
        table.failAt(*table.find(key), table.full(key) + " = [0, 0, 0] points nowhere; choose a direction");
    }
    out = value;
    return true;
}

void readPlace(SceneTable& table, const SceneFolder& folder, SceneEmitter& emitter) {
    // Without `shape`, the keys of the place tell the shape.
    std::size_t shape = table.find("points") != nullptr  ? static_cast<std::size_t>(EmitterShape::kPoints)
                        : table.find("point") != nullptr ? kPoint
                                                         : 0;
    const bool named = table.word("shape", kShapes, shape);
    const std::string word = "shape = \"" + std::string(kShapes[shape]) + "\"";
    readBox(table, emitter);
    table.vector("center", symmetric(kLengthMax), emitter.center);
    table.number("radius", {0.0, kLengthMax}, emitter.radius);
    readDirection(table, "normal", emitter.normal);
    std::string file;
    table.text("points", file);
    emitter.shape = shape == kPoint ? EmitterShape::kBox : static_cast<EmitterShape>(shape);

    struct Key {
        std::string_view name;
        std::initializer_list<std::string_view> shapes;  // that it is for
        bool needed;
    };
    for (const Key& key : {Key{"box_min", {"box"}, false},
                           {"point", {"point"}, true},
                           {"center", {"sphere", "shell", "disc"}, true},
                           {"radius", {"sphere", "shell", "disc"}, true},
                           {"normal", {"disc"}, false},
                           {"points", {"points"}, true}}) {
        const bool mine = std::find(key.shapes.begin(), key.shapes.end(), kShapes[shape]) != key.shapes.end();
        const bool given = table.find(key.name) != nullptr;
        if (given && !mine) {
            table.failUseless(key.name, "for emitter." + word + "; remove it, or choose emitter.shape = \"" +
                                            std::string(*key.shapes.begin()) + "\"");
        }
        if (!given && mine && key.needed) {
            table.failAt(*table.find(named ? "shape" : "points"),
                         "emitter." + word + " needs " + table.full(key.name) + " beside it");
        }
    }
    if (emitter.shape == EmitterShape::kPoints) {
        table.path("points", folder, emitter.points, emitter.points_origin);
    }
}

void readMoments(SceneTable& table, std::uint32_t capacity, SceneEmitter& emitter) {
    table.number("start", {0.0, kSecondsMax}, emitter.start);
    table.number("rate", {0.0, kRateMax}, emitter.rate);
    const bool burst = table.integer("burst", {0.0, ParticleSystem::kCapacityMax}, emitter.burst);
    const bool again = table.number("burst_every", {kBurstEveryMin, kSecondsMax}, emitter.burst_every);
    if (again && emitter.burst == 0) {
        table.failUseless("burst_every", "without emitter.burst; say how many, or remove it");
    }
    if (table.number("duration", {0.0, kSecondsMax, false}, emitter.duration) && emitter.rate == 0.0 &&
        !again) {
        table.failUseless("duration", "while emitter.rate is 0; raise the rate or remove it");
    }
    if (emitter.rate == 0.0 && emitter.burst == 0) {
        table.failAt(*table.find(burst ? "burst" : "rate"),
                     "emitter.rate = 0 without emitter.burst gives birth to nothing; raise one of them");
    }
    if (burst && emitter.burst > capacity) {
        table.failAt(*table.find("burst"), "emitter.burst = " + std::to_string(emitter.burst) +
                                               " is more than particles.capacity = " +
                                               std::to_string(capacity) + "; raise the capacity");
    }
    const bool spread = table.find("spread") != nullptr;
    table.boolean("spread", emitter.spread);
    if (spread && emitter.rate == 0.0) {
        table.failUseless("spread", "while emitter.rate is 0: a burst is born at once; remove it");
    }
}

/// `speed`: a number, [least, most], or { mean, deviation }.
void readSpeed(SceneTable& table, std::string_view file, SceneEmitter& emitter) {
    const toml::node* node = table.find("speed");
    if (node == nullptr) {
        return;
    }
    const SceneRange range{0.0, kSpeedMax};
    if (const toml::table* both = node->as_table(); both != nullptr) {
        SceneTable normal(both, "emitter.speed", file);
        float mean = 0.0F;
        if (!normal.number("mean", range, mean)) {
            table.failAt(*node, "emitter.speed needs a mean, as in { mean = 2.0, deviation = 0.5 }");
        }
        normal.number("deviation", range, emitter.speed_deviation);
        normal.finish();
        emitter.speed_min = mean;
        emitter.speed_max = mean;
        return;
    }
    const SceneSpan span =
        table.spanOf(*node, "speed", range, "a number, two [least, most], or { mean = …, deviation = … }");
    emitter.speed_min = static_cast<float>(span.least);
    emitter.speed_max = static_cast<float>(span.most);
}

void readVelocity(SceneTable& table, std::string_view file, SceneEmitter& emitter) {
    const bool velocity = table.vector("velocity", symmetric(kSpeedMax), emitter.velocity);
    table.vector("velocity_spread", {0.0, kSpeedMax}, emitter.velocity_spread);
    const bool direction = readDirection(table, "direction", emitter.direction);
    const bool cone = table.number("cone", {0.0, 180.0}, emitter.cone);
    readSpeed(table, file, emitter);
    emitter.aimed = direction || cone || emitter.speed_min;
    if (!emitter.aimed) {
        return;
    }
    const std::string_view by = direction ? "direction" : cone ? "cone" : "speed";
    if (velocity) {
        table.failAt(*table.find("velocity"),
                     "emitter.velocity and " + table.full(by) + " are two velocities; remove one");
    }
    if (!direction && emitter.shape == EmitterShape::kBox) {
        table.failAt(*table.find(by),
                     table.full(by) + " needs emitter.direction: a box or point has no normal");
    }
}

void readLife(SceneTable& table, SceneEmitter& emitter) {
    if (const toml::node* node = table.find("lifetime"); node != nullptr) {
        const SceneSpan span = table.spanOf(*node, "lifetime", {0.0, kSecondsMax, false},
                                            "a number of seconds, or two [least, most]");
        // A lifetime below the smallest float would be 0.
        emitter.lifetime_min = positive(span.least);
        emitter.lifetime_max = positive(span.most);
    }
    readTypeOf(table, "type", emitter.type, emitter.type_name, emitter.type_origin);
    table.integer("seed", {0.0, kSeedMax}, emitter.seed);
}

void readWay(SceneTable& table, std::string_view file, std::size_t colliders, SceneEmitter& emitter) {
    table.integer("attach", {0.0, static_cast<double>(colliders) - 1.0}, emitter.attach);
    if (emitter.attach && emitter.shape == EmitterShape::kBox && !emitter.box_min) {
        table.failAt(
            *table.find("attach"),
            "emitter.attach needs a place in the collider's space beside it: emitter.point, for example");
    }
    emitter.keys = readPoseKeys(table, file, {}, "emitter.point");
    if (table.number("inherit", {0.0, kInheritMax}, emitter.inherit) && !emitter.moves()) {
        table.failUseless("inherit", "for an emitter that rests; give it emitter.attach or [[emitter.key]]");
    }
}

SceneEmitter readEmitter(SceneTable table, std::string_view file, const SceneFolder& folder,
                         std::uint32_t capacity, std::size_t colliders) {
    SceneEmitter emitter;
    readPlace(table, folder, emitter);
    readMoments(table, capacity, emitter);
    readVelocity(table, file, emitter);
    readLife(table, emitter);
    readWay(table, file, colliders, emitter);
    table.finish();
    return emitter;
}

}  // namespace

std::vector<SceneEmitter> readEmitters(SceneTable& top, std::string_view file, const SceneFolder& folder,
                                       std::uint32_t capacity, std::size_t colliders) {
    constexpr std::string_view kName = "emitter";
    const toml::node* node = top.find(kName);
    const toml::array* several = node == nullptr ? nullptr : node->as_array();
    if (several == nullptr) {
        return {readEmitter(top.sub(kName), file, folder, capacity, colliders)};
    }
    if (several->empty() || !several->is_array_of_tables()) {
        top.wrongType(*node, kName, "a table, as in [emitter], or several, as in [[emitter]]");
    }
    if (several->size() > kEmittersMax) {
        top.failAt(*several->get(kEmittersMax), std::to_string(several->size()) +
                                                    " emitters are too many; choose at most " +
                                                    std::to_string(kEmittersMax));
    }
    std::vector<SceneEmitter> emitters;
    for (const toml::node& one : *several) {
        emitters.push_back(readEmitter({one.as_table(), kName, file}, file, folder, capacity, colliders));
    }
    return emitters;
}

}  // namespace relief

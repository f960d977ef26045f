// SPDX-License-Identifier: Apache-2.0
#include "runtime/scene/scene_types.h"

namespace relief {

void fields(FieldVisitor& visit, ParticleType& type) {
    visit("gravity", type.gravity, {"Factor of forces.gravity; below 0 it rises", {}, within(kFactorMax)});
    visit("mass", type.mass, {"Divides the drag", {}, {1e-15, 1e9}});
    visit("radius", type.radius, {"Radius of collision; size is the picture's", {}, kLengthRange});
    visit("restitution", type.restitution,
          {"Share of the normal speed that comes back", {}, {0.0, 1.0}, "that of [collision]"});
    visit("friction", type.friction,
          {"Share of the tangential speed that is lost", {}, {0.0, 1.0}, "that of [collision]"});
    visit("friction_threshold", type.friction_threshold,
          {"Speed below which there is no friction", "1/s", kSpeedRange, "that of [collision]"});
    visit("on_collision", type.on_collision,
          {"Reaction to a collision, by the method's page, section Collision"});
    visit("lifetime_loss", type.lifetime_loss, {"Life that each step in contact costs", "s", kTimeRange});
}

void fields(FieldVisitor& visit, SpawnSettings& s) {
    visit("on", s.on,
          {"The event. collision: a body or the ground was hit, and the step before touched nothing; "
           "death: of age, or of a hit",
           {},
           {},
           {},
           {.required = true, .selects = true}});
    visit("of", s.of,
          {"Number or name of the type that hits or dies",
           {},
           {0.0, kParticleTypesMax - 1},
           "all",
           {.index_of = "type"}});
    visit("min_speed", s.min_speed,
          {"Least speed of a hit along the normal, relative to the surface",
           "1/s",
           kSpeedRange,
           {},
           {.only = "collision"}});
    visit("type", s.type,
          {"Number or name of the type that is born",
           {},
           {0.0, kParticleTypesMax - 1},
           {},
           {.index_of = "type"}});
    visit("count", FieldSpan{s.count_min, s.count_max}, {"Births for each event", {}, {1.0, 10'000.0}});
    visit("most", s.most, {"Births of a step at most", {}, {1.0, 1 << 24}});
    visit("lifetime", FieldSpan{s.lifetime_min, s.lifetime_max},
          {"Lifetime of what is born", "s", kLifeRange});
    visit("inherit", s.inherit,
          {"Share of the parent's velocity; after a hit of the part along the surface", {}, kFactorRange});
    visit("speed", FieldSpan{s.speed_min, s.speed_max}, {"Speed about the normal", "1/s", kSpeedRange});
    visit("kick", s.kick, {"Share of the hit's speed, on top of speed", {}, kFactorRange});
    visit("cone", s.cone_degrees,
          {"Half angle about the normal",
           "degrees",
           {0.0, 180.0},
           "60; 180 for \"death\"",
           {.needs = "speed kick"}});
}

}  // namespace relief

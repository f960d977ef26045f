// SPDX-License-Identifier: Apache-2.0
#include "runtime/scene/scene_types.h"

namespace relief {

void fields(FieldVisitor& visit, ParticleType& type) {
    visit("gravity", type.gravity,
          {"Factor on forces.gravity; negative makes particles rise", {}, within(kFactorMax)});
    visit("mass", type.mass, {"Divides the drag", {}, {1e-15, 1e9}});
    visit("radius", type.radius, {"Collision radius; independent of size", {}, kLengthRange});
    visit("restitution", type.restitution,
          {"Fraction of the normal speed that is kept", {}, {0.0, 1.0}, "that of [collision]"});
    visit("friction", type.friction,
          {"Fraction of the tangential speed that is lost", {}, {0.0, 1.0}, "that of [collision]"});
    visit("friction_threshold", type.friction_threshold,
          {"Speed below which there is no friction", "1/s", kSpeedRange, "that of [collision]"});
    visit("on_collision", type.on_collision, {"Response to a collision (runtime/METHOD.md, Collision)"});
    visit("lifetime_loss", type.lifetime_loss, {"Lifetime lost in each step in contact", "s", kTimeRange});
}

void fields(FieldVisitor& visit, SpawnSettings& s) {
    visit("on", s.on,
          {"Event. collision: first contact with a body or the ground; death: by age or by a hit",
           {},
           {},
           {},
           {.required = true, .selects = true}});
    visit("parent", s.parent,
          {"Index or name of the type that hits or dies",
           {},
           {0.0, kParticleTypesMax - 1},
           "all",
           {.index_of = "type"}});
    visit("min_speed", s.min_speed,
          {"Minimum speed of a hit along the normal, relative to the surface",
           "1/s",
           kSpeedRange,
           {},
           {.only = "collision"}});
    visit("type", s.type,
          {"Index or name of the type to emit", {}, {0.0, kParticleTypesMax - 1}, {}, {.index_of = "type"}});
    visit("count", FieldSpan{s.count_min, s.count_max}, {"Births per event", {}, {1.0, 10'000.0}});
    visit("max_per_step", s.max_per_step, {"Maximum births per step", {}, {1.0, 1 << 24}});
    visit("lifetime", FieldSpan{s.lifetime_min, s.lifetime_max}, {"Lifetime of births", "s", kLifeRange});
    visit("inherit", s.inherit,
          {"Factor on the parent's velocity, which births inherit; after a hit, only its tangential part",
           {},
           kFactorRange});
    visit("speed", FieldSpan{s.speed_min, s.speed_max}, {"Speed within the cone", "1/s", kSpeedRange});
    visit("kick", s.kick, {"Factor on the hit's speed, which is added to speed", {}, kFactorRange});
    visit("cone", s.cone_degrees,
          {"Half angle of the cone around the normal",
           "degrees",
           {0.0, 180.0},
           "60; 180 for \"death\"",
           {.needs = "speed kick"}});
}

}  // namespace relief

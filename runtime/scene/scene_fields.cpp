// SPDX-License-Identifier: Apache-2.0
// The keys of a scene file.
#include "runtime/scene/scene.h"

namespace relief {
namespace {

/// All keys except `collides_with`, which refers to bodies by name.
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
          {.help = "Event. collision: first contact with a body or the ground; death: by age or by a hit",
           .rules = {.required = true, .selects = true}});
    visit("parent", s.parent,
          {.help = "Index or name of the type that hits or dies",
           .range = {0.0, kParticleTypesMax - 1},
           .fallback = "all",
           .rules = {.index_of = "type"}});
    visit("min_speed", s.min_speed,
          {.help = "Minimum speed of a hit along the normal, relative to the surface",
           .unit = "1/s",
           .range = kSpeedRange,
           .rules = {.only = "collision"}});
    visit("type", s.type,
          {"Index or name of the type to emit", {}, {0.0, kParticleTypesMax - 1}, {}, {.index_of = "type"}});
    visit("count", FieldSpan{s.count_min, s.count_max}, {"Births per event", {}, {1.0, 10'000.0}});
    visit("max_per_step", s.max_per_step, {"Maximum births per step", {}, {1.0, 1 << 24}});
    visit("lifetime", FieldSpan{s.lifetime_min, s.lifetime_max}, {"Lifetime of births", "s", kLifeRange});
    visit("inherit", s.inherit,
          {.help =
               "Factor on the parent's velocity, which births inherit; after a hit, only its tangential part",
           .range = kFactorRange});
    visit("speed", FieldSpan{s.speed_min, s.speed_max}, {"Speed within the cone", "1/s", kSpeedRange});
    visit("kick", s.kick, {"Factor on the hit's speed, which is added to speed", {}, kFactorRange});
    visit("cone", s.cone_degrees,
          {"Half angle of the cone around the normal",
           "degrees",
           {0.0, 180.0},
           "60; 180 for \"death\"",
           {.needs = "speed kick"}});
}

}  // namespace

void fields(FieldVisitor& visit, ParticleLook& look) {
    visit("size", look.size,
          {.help = "Diameter over age",
           .range = kLengthRange,
           .fallback = "render.point_size",
           .left_out = true});
    visit("color", look.color,
          {.help = "Colour over age, in linear light",
           .unit = "[r, g, b]",
           .range = {0.0, 1.0},
           .fallback = "render.color",
           .left_out = true});
    visit("opacity", look.opacity,
          {.help = "Opacity over age", .range = {0.0, 1.0}, .fallback = "render.opacity", .left_out = true});
    visit("rotation", look.rotation,
          {.help = "Anticlockwise rotation of the sprite over age",
           .unit = "radians",
           .range = within(kAngleMax),
           .fallback = "0",
           .left_out = true});
    visit("rotation_spread", look.rotation_spread,
          {"Range ± of each particle's random initial rotation", "radians", {0.0, kAngleMax}});
    visit("spin_spread", look.spin_spread,
          {"Range ± of each particle's random rotation speed", "radians/s", {0.0, kAngleMax}});
    visit("stretch", look.stretch,
          {"Exposure time: stretches the sprite along its path during this time; needs render.sprite = "
           "\"quad\"; excludes rotation, rotation_spread and spin_spread",
           "s", kTimeRange});
    visit("cell", FieldSpan{look.cell_first, look.cell_last},
          {.help = "Cell of the atlas, or [first, last] to play over the lifetime, counted row by row from "
                   "the top left; needs render.atlas",
           .fallback = "a round dot",
           .left_out = true});
    visit("lit", look.lit, {"False: unlit, drawn in its own colour"});
    visit("fade", FieldPair{look.fade_in, look.fade_out},
          {.help = "Fade times after birth and before death",
           .unit = "[in, out] s",
           .range = kTimeRange,
           .fallback = "[0.2, 0.5]; none if opacity has keys",
           .left_out = true});
}

void fields(FieldVisitor& visit, ScenePose& pose) {
    visit("position", pose.position,
          leftOut({"Position of the origin", "[x, y, z]", kPointRange,
                   "[0, 0, 0]; for a key, the value of its table"}));
    visit("axis", pose.axis,
          leftOut({"Axis of rotation, any length",
                   "[x, y, z]",
                   kPointRange,
                   "[0, 1, 0]",
                   {.needs = "angle", .unit_length = true}}));
    visit("angle", pose.angle,
          leftOut({"Rotation about the axis, right-handed", "degrees", within(kAngleMax),
                   "0; for a key, the value of its table"}));
}

void fields(FieldVisitor& visit, SceneKey& key) {
    visit("time", key.time,
          {"Time since time 0; keys in ascending order", "s", {0.0, kKeySecondsMax}, {}, kRequired});
    fields(visit, static_cast<ScenePose&>(key));
}

void fields(FieldVisitor& visit, SceneLive& live) {
    visit("amplitude", live.amplitude, {"Height of the waves", "object units", kPointRange, {}, kRequired});
    visit("frequency", live.frequency, {"Oscillations per second", "1/s", {0.0, 1000.0}, {}, kRequired});
    visit("phase", live.phase, {"Phase at time 0", "degrees", within(kAngleMax)});
    visit("wavelength", live.wavelength,
          leftOut({"Length of the waves", "object units", kSizeRange, "half the longest side"}));
}

void fields(FieldVisitor& visit, ScenePlay& play) {
    visit("clip", FieldPlaced{play.clip, play.clip_origin.text},
          leftOut({"Name of a clip in a container baked with --animated", {}, {}, "the first"}));
    visit("start", play.start, {"Offset into the clip at time 0", "s", within(kClipStartMax)});
    visit("speed", play.speed, {"Playback speed; negative plays backwards", "1", within(kClipSpeedMax)});
    visit("loop", play.loop, {"Loop the clip"});
    visit("bounds_scale", play.bounds_scale,
          {"Scale of the clips' bounding box, to make room for poses set by a program", {}, {1.0, 100.0}});
    visit("resolution", play.resolution, {"Texels along the longest side of the maps", {}, {16.0, 4096.0}});
}

void fields(FieldVisitor& visit, SceneMaterialColor& material) {
    visit("name", FieldPlaced{material.name, material.origin},
          {"Material of the animated mesh, as listed by relief info", {}, {}, {}, kRequired});
    visit("color", material.color, {"Colour in pictures", "[r, g, b]", kFractionRange, {}, kRequired});
}

void fields(FieldVisitor& visit, SceneCollider& c) {
    const FieldPlaced path{c.path, c.origin};
    bool live = c.live.has_value();
    bool baked = !live;
    visit("file", FieldMaybe{path, baked},
          leftOut({"Container (.relief) to collide with", {}, {}, "required unless mesh is set"}));
    visit("mesh", FieldMaybe{path, live},
          leftOut({"OBJ or PLY file that deforms; it is not baked", {}, {}, "none", {.instead_of = "file"}}));
    visit("node", FieldPlaced{c.node, c.origin},
          leftOut({.help = "Node of the scene's world to place or move; needs world",
                   .fallback = "none",
                   .rules = {.instead_of = "file mesh"}}));
    visit("deform", c.live,
          leftOut({"Waves that deform the mesh", {}, {}, "required with mesh", {.needs = "mesh"}}));
    visit("resolution", c.resolution,
          leftOut({.help = "Texels along a side of each map of the deforming mesh",
                   .range = {16.0, 4096.0},
                   .rules = {.needs = "mesh"}}));
    visit("play", c.play,
          leftOut({"Clip that the animated mesh plays", {}, {}, "at rest", {.needs = "file"}}));
    fields(visit, c.given_pose);
    visit("scale", FieldMaybe{c.scale, c.posed}, leftOut({"World units per object unit", {}, {1e-6, 1e6}}));
    visit("restitution", FieldMaybe{c.restitution, c.posed},
          leftOut({"Factor on the particles' restitution", {}, {0.0, 1.0}}));
    visit("friction", FieldMaybe{c.friction, c.posed},
          leftOut({"Multiplies the particles' 1 − friction by 1 − this value", {}, {0.0, 1.0}}));
    visit("color", c.color,
          leftOut({"Colour in pictures if the mesh has none; all maps are drawn in the first collider's "
                   "colour",
                   "[r, g, b]",
                   {0.0, 1.0},
                   "clay"}));
    visit("material", c.materials,
          leftOut({.help = "Colours of the animated mesh's materials",
                   .rules = {.needs = "play", .most = kMeshMaterialsMax}}));
    visit("key", c.given_keys, leftOut({"Poses at times; at least two", {}, {}, {}, {.most = kPoseKeysMax}}));
}

void fields(FieldVisitor& visit, SceneTouching& touching) {
    const NameList names{touching.materials, touching.material_origins};
    bool named = !touching.materials.empty();
    visit("within", touching.within,
          {.help = "Largest distance to the nearest other surface that counts as touching",
           .range = kSizeRange,
           .rules = kRequired});
    visit("material", FieldMaybe{names, named},
          leftOut({"Material that must be touched, or a list of materials", {}, {}, "any, or the ground"}));
    visit("min_speed", touching.min_speed,
          {"Minimum speed relative to the touched surface", "1/s", kSpeedRange});
}

void fields(FieldVisitor& visit, NormalSpeed& speed) {
    visit("mean", speed.mean, {"Mean of a normal distribution", "1/s", kSpeedRange, {}, kRequired});
    visit("deviation", speed.deviation, {"Standard deviation", "1/s", kSpeedRange});
}

void fields(FieldVisitor& visit, SceneEmitter& e) {
    EmitterAim none;
    EmitterAim& aim = e.aim ? *e.aim : visit.fills() ? e.aim.emplace() : none;
    const EmitterSpeed speed{aim};
    visit("shape", e.shape,
          {.help = "Region of births; sphere: a solid ball, shell: its surface, surface: that of a collider "
                   "or mesh",
           .fallback = "\"point\" or \"points\" if that key is set, otherwise \"box\"",
           .rules = {.selects = true}});
    visit("box_min", FieldMaybe{e.box_min, e.has_box},
          {"Lower corner",
           "[x, y, z]",
           kPointRange,
           "1.45 L around the centre in x and z, 0.15 L above the top",
           {.needs = "box_max", .only = "box"}});
    visit("box_max", FieldMaybe{e.box_max, e.has_box},
          {"Upper corner",
           "[x, y, z]",
           kPointRange,
           "as box_min, 0.75 L above the top",
           {.needs = "box_min", .only = "box"}});
    visit("point", e.box_min,
          {.help = "Position",
           .unit = "[x, y, z]",
           .range = kPointRange,
           .rules = {.instead_of = "box_min", .only = "point", .required = true, .chooses = true}});
    visit("center", e.center,
          {"Centre", "[x, y, z]", kPointRange, {}, {.only = "sphere shell disc", .required = true}});
    visit("radius", e.radius,
          {"Radius", {}, kLengthRange, {}, {.only = "sphere shell disc", .required = true}});
    visit("normal", e.normal,
          {"Normal of the disc", "[x, y, z]", kPointRange, {}, {.only = "disc", .not_zero = true}});
    visit("points", FieldPlaced{e.points_file, e.points_origin},
          {.help = "File of 1 to 2²² points (see below)",
           .rules = {.only = "points", .required = true, .chooses = true}});
    visit("mesh", FieldPlaced{e.mesh_file, e.mesh_origin},
          leftOut({.help = "OBJ or PLY file whose surface emits, in the emitter's space",
                   .fallback = "the surface of the attached collider, as it moves and deforms",
                   .rules = {.only = "surface"}}));
    visit(
        "group", FieldPlaced{e.group, e.group_origin},
        leftOut({.help = "Joint or node whose weights set the density of births; for OBJ, a group or object",
                 .fallback = "all",
                 .rules = {.only = "surface"}}));
    visit("material", FieldPlaced{e.material, e.material_origin},
          leftOut({"Material that emits", {}, {}, "all", {.only = "surface"}}));
    visit("touching", e.touching,
          leftOut({.help = "Births only where the surface touches another surface",
                   .fallback = "everywhere",
                   .rules = {.only = "surface"}}));
    visit("start", e.start, {"Time at which births begin", "s", kTimeRange});
    visit("rate", FieldMaybe{e.rate, e.has_rate},
          {"Births per second; emitters without a rate share the capacity that the others leave",
           "1/s",
           {0.0, kRateMax},
           "fills the capacity by the end of the births"});
    visit("duration", e.duration,
          {"Time from the start to the last birth", "s", kLifeRange, "the whole run"});
    visit("burst", e.burst, {"Births at the start; at most the capacity", {}, {0.0, 1 << 24}});
    visit(
        "burst_every", e.burst_every,
        leftOut({"Interval between bursts", "s", {1e-4, kSecondsMax}, "a single burst", {.needs = "burst"}}));
    visit("interpolate", e.interpolate, {"Spread births by rate over their step"});
    visit("velocity", FieldMaybe{e.velocity, e.has_velocity},
          leftOut({"Velocity of every birth",
                   "[x, y, z]/s",
                   within(kSpeedMax),
                   "[0, −0.8 L, 0]; none with direction, cone or speed",
                   {.instead_of = "direction cone speed"}}));
    visit("velocity_spread", FieldMaybe{e.velocity_spread, e.has_velocity_spread},
          {"Largest deviation ± from the velocity, uniform", "[x, y, z]/s", kSpeedRange,
           "[0.12, 0.1, 0.12] L; none with direction, cone or speed"});
    visit("direction", FieldMaybe{aim.direction, e.has_aim},
          leftOut({"Direction of births; required for a box or point",
                   "[x, y, z]",
                   kPointRange,
                   "the normal of the shape, disc, point or surface, outwards",
                   {.not_zero = true}}));
    visit("cone", FieldMaybe{aim.cone_degrees, e.has_aim},
          leftOut({"Half angle of the cone around the direction; uniform over the solid angle",
                   "degrees",
                   {0.0, 180.0}}));
    visit("speed", FieldMaybe{speed, e.has_speed},
          leftOut({"Speed along the direction: a number, [min, max], or { mean, deviation } for a normal "
                   "distribution, truncated at 0",
                   "1/s", kSpeedRange, "0.8 L"}));
    visit("lifetime", FieldSpan{e.lifetime_min, e.lifetime_max}, {"Lifetime", "s", kLifeRange});
    visit("type", e.type,
          {"Index or name of the type", {}, {0.0, kParticleTypesMax - 1}, {}, {.index_of = "type"}});
    visit("seed", e.seed, {"Seed; emitter i uses stream i of its seed", {}, {0.0, kSeedMax}});
    visit("attach", e.attach,
          leftOut(
              {.help = "Index, from 0, of the collider to attach to; needs a position or shape = \"surface\"",
               .range = {0.0, WorldTextures::kBodiesMax - 1},
               .fallback = "the world",
               .rules = {.index_of = "collider"}}));
    visit("key", e.given_keys, leftOut({"Poses at times; at least two", {}, {}, {}, {.most = kPoseKeysMax}}));
    visit("inherit", e.inherit,
          leftOut({.help = "Factor on the emitter's velocity, which births inherit",
                   .range = kFactorRange,
                   .rules = {.needs = "attach key"}}));
}

void fields(FieldVisitor& visit, SceneSpawn& spawn) {
    fields(visit, static_cast<SpawnSettings&>(spawn));
    visit("material", FieldPlaced{spawn.on_material, spawn.material_origin.text},
          leftOut({"Material that was hit", {}, {}, "any", {.only = "collision"}}));
    visit("seed", spawn.seed, {"Seed; each spawn has its own stream", {}, {0.0, kSeedMax}});
}

void fields(FieldVisitor& visit, SceneTime& time) {
    visit("dt", time.dt, {"Length of a step", "s", {1e-6, 1.0}, "1/60"});
    visit("steps", time.steps, {"Number of steps", {}, {0.0, kStepsMax}});
    visit("prewarm", time.prewarm,
          {"Time simulated before time 0, in whole steps, at most 10⁷", "s", kTimeRange});
    visit("integrator", time.integrator, {"Integration of positions: semi-implicit Euler, or Verlet"});
}

void fields(FieldVisitor& visit, SceneParticles& particles) {
    visit("capacity", particles.capacity,
          {"Maximum number of live particles", {}, {1.0, ParticleSystem::kCapacityMax}});
}

void fields(FieldVisitor& visit, SceneForces& forces) {
    visit("gravity", forces.gravity,
          {"Acceleration of gravity", "[x, y, z]/s²", within(kAccelerationMax), "[0, −3 L, 0]"});
    visit("wind", forces.wind, {"Uniform wind velocity; needs drag", "[x, y, z]/s", within(kSpeedMax)});
    visit("drag", FieldMaybe{forces.drag, forces.has_drag},
          leftOut({"Rate at which particles approach the air's velocity", "1/s", {0.0, kDragMax}}));
    visit("viscosity", forces.viscosity,
          leftOut({"Dynamic viscosity: drag by Stokes' law",
                   "mass/(length·s)",
                   {0.0, 1e6},
                   "none",
                   {.instead_of = "drag"}}));
}

void fields(FieldVisitor& visit, SceneCollision& c) {
    visit("restitution", c.restitution, {"Fraction of the normal speed that is kept", {}, {0.0, 1.0}});
    visit("friction", c.friction, {"Fraction of the tangential speed that is lost", {}, {0.0, 1.0}});
    visit("friction_threshold", c.friction_threshold,
          {"Speed below which there is no friction", "1/s", kSpeedRange});
    visit(
        "sweep", c.sweep,
        {.help =
             "Largest distance between two collision tests within a step; 0: tests only the end of the step",
         .range = kLengthRange,
         .fallback =
             "half the thickness of the thinnest collider if that is thinner than a step, otherwise 0"});
}

void fields(FieldVisitor& visit, SceneStream& stream) {
    visit("radius", stream.radius,
          {.help = "Distance from emitters and the camera within which the world has full detail",
           .range = kSizeRange,
           .rules = kRequired});
    visit("memory", stream.memory,
          {"GPU memory for colliders, including coarse ones", "MB", {0.001, 65536.0}});
}

void fields(FieldVisitor& visit, SceneGround& ground) {
    visit("enabled", ground.enabled, {"Ground plane present"});
    visit("height", ground.height, leftOut({"Height of the plane", {}, kPointRange, "bottom of the bounds"}));
}

void fields(FieldVisitor& visit, SceneCameraKey& key) {
    visit("time", key.time,
          {"Time since time 0; keys in ascending order", "s", {0.0, kKeySecondsMax}, {}, kRequired});
    visit("eye", key.eye,
          {"Position of the camera, instead of camera.eye", "[x, y, z]", kPointRange, {}, kRequired});
    visit("target", key.target, {"Point to look at", "[x, y, z]", kPointRange, "camera.target"});
    visit("fov", key.fov, {"Vertical field of view", "degrees", kFovRange, "camera.fov"});
}

void fields(FieldVisitor& visit, SceneCamera& camera) {
    visit("eye", camera.eye,
          leftOut({"Position of the camera",
                   "[x, y, z]",
                   kPointRange,
                   "in front and above, framing the bounds",
                   {.instead_of = "key"}}));
    visit("target", camera.target,
          {"Point to look at, not straight above or below the eye", "[x, y, z]", kPointRange,
           "centre of the bounds"});
    visit("fov", camera.fov, {"Vertical field of view", "degrees", kFovRange});
    visit("key", camera.keys, leftOut({"Positions of the camera at times", {}, {}, {}, {.most = 10'000}}));
}

void fields(FieldVisitor& visit, SceneWeather& weather) {
    visit("time", weather.time, {"Time since time 0; keys in ascending order", "s", {0.0, kKeySecondsMax}});
    visit("sun", weather.sun, {"Brightness of the sun; 0: overcast", {}, {0.0, 1.0}});
    visit("wet", weather.wet, {"Wetness of surfaces exposed to rain", {}, {0.0, 1.0}});
    visit("snow", weather.snow, {"Snow cover of level surfaces exposed to the sky", {}, {0.0, 1.0}});
}

void fields(FieldVisitor& visit, SceneRender& r) {
    visit("size", FieldPair{r.width, r.height},
          {"Size of the pictures, at most 2²⁶ pixels", "[width, height] pixels", {1.0, 65535.0}});
    visit("point_size", r.point_size, {"Diameter of particles", {}, kSizeRange, "0.0065 L"});
    visit("color", r.color, {"Colour of particles", "[r, g, b]", {0.0, 1.0}});
    visit("opacity", r.opacity, {"Opacity of particles", {}, {0.0, 1.0, false}});
    visit("background", r.background, {"Colour of the background", "[r, g, b]", {0.0, 1.0}});
    visit("steps_per_frame", r.steps_per_frame, {"Steps per frame", {}, {1.0, kStepsMax}});
    visit("first_frame", r.first_frame,
          {"Step of the first frame; 0: before the first step", {}, {0.0, kStepsMax}, "steps_per_frame"});
    visit("last_frame", r.last_frame, {"Step of the last frame", {}, {0.0, kStepsMax}, "the last step"});
    visit("sort_frames", r.sort_frames,
          {.help = "Frames over which one depth sort is spread, at least 2; 0: no sort. The compute path "
                   "sorts every frame",
           .range = {0.0, 200.0}});
    visit("sprite", r.sprite, {"Shape of particles; quads may have any size and rotate"});
    visit("blend", r.blend, {"Blend mode of particles"});
    visit("soft_distance", r.soft_distance,
          {"Distance from collider and floor within which sprites fade", {}, kLengthRange});
    visit("atlas", FieldPlaced{r.atlas, r.atlas_origin},
          leftOut({"PNG with alpha, up to 8192 pixels a side; needs a type with cell", {}, {}, "none"}));
    visit("atlas_cells", FieldPair{r.atlas_columns, r.atlas_rows},
          leftOut({.help = "Cells of the atlas; must divide its sides",
                   .unit = "[columns, rows]",
                   .range = {1.0, 4096.0},
                   .rules = {.needs = "atlas"}}));
    visit("mesh", FieldPlaced{r.mesh, r.mesh_origin},
          leftOut({.help = "The collider's source mesh, OBJ or PLY, to draw instead of the maps; the maps "
                           "still cast the shadows",
                   .fallback = "none: the maps are drawn"}));
    visit("meshes", FieldPlaced{r.meshes, r.meshes_origin},
          leftOut({.help = "Folder of PLY and OBJ meshes to draw (see Meshes and weather)",
                   .fallback = "none: the maps are drawn",
                   .rules = {.instead_of = "mesh"}}));
    visit("fog_distance", r.fog_distance,
          {.help = "Distance at which fog, in the background colour, is 63 % opaque; 0: no fog",
           .range = kLengthRange,
           .rules = {.needs = "meshes"}});
    visit("units_per_meter", r.units_per_meter,
          {.help = "World units per metre: scales surface grain, snow drifts and corner shading",
           .range = kSizeRange,
           .rules = {.needs = "meshes"}});
    visit("shadow_distance", r.shadow_distance,
          leftOut(
              {.help =
                   "Distance from camera.target in x and z within which meshes cast shadows and give shelter",
               .range = kSizeRange,
               .fallback = "the whole scene",
               .rules = {.needs = "meshes"}}));
    visit("weather", r.weather,
          leftOut({.help = "Weather of the meshes at times, interpolated linearly",
                   .fallback = "sunny and dry",
                   .rules = {.needs = "meshes", .most = 10'000}}));
}

void fields(FieldVisitor& visit, SceneType& type) {
    visit("name", type.name, leftOut({"Unique name, for emitter.type and spawn", {}, {}, "none"}));
    fields(visit, static_cast<ParticleType&>(type));
    visit("collides_with", CollidesList{type.collides_with},
          {.help = "Indices from 0 of the colliders to collide with (7 means 7 and above), and \"ground\", "
                   "as in [0, \"ground\"]",
           .fallback = "everything"});
    fields(visit, type.look);
}

void fields(FieldVisitor& visit, Scene& scene) {
    visit("world", FieldPlaced{scene.world, scene.world_origin},
          leftOut({.help = "World (world.json) whose bodies are added to the colliders",
                   .fallback = "none; a collider is then required"}));
    visit("collider", scene.colliders,
          {"Colliders", {}, {}, {}, {.most = WorldTextures::kBodiesMax, .single = true}});
    visit("material", scene.materials,
          leftOut({"Responses of the colliders' materials", {}, {}, {}, {.most = kSceneMaterialsMax}}));
    visit("stream", scene.stream, leftOut({"Load the world's colliders on demand"}));
    visit("time", scene.time, {"Steps"});
    visit("particles", scene.particles, {"Capacity"});
    visit("emitter", scene.emitters, {"Births", {}, {}, {}, {.most = kEmittersMax, .single = true}});
    visit("spawn", scene.spawns, leftOut({"Births at hits and deaths", {}, {}, {}, {.most = kSpawnsMax}}));
    visit("forces", scene.forces, {"Gravity, wind and drag"});
    fields(visit, scene.air);
    visit("flow", scene.flow, leftOut({"Wind velocities on a grid; needs drag"}));
    visit("collision", scene.collision, {"Collision response of particles without a type"});
    visit("type", scene.types,
          leftOut({"Types of particles; the first is type 0", {}, {}, {}, {.most = kLooksMax}}));
    visit("ground", scene.ground, {"Ground plane"});
    visit("camera", scene.camera, {"Camera"});
    visit("render", scene.render, {"Pictures"});
}

}  // namespace relief

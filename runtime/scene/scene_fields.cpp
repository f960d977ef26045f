// SPDX-License-Identifier: Apache-2.0
// The keys of a scene file.
#include "runtime/scene/scene.h"
#include "runtime/scene/scene_types.h"

namespace relief {

void fields(FieldVisitor& visit, ParticleLook& look) {
    visit("size", look.size,
          {.help = "Diameter, over age",
           .range = kLengthRange,
           .fallback = "render.point_size",
           .left_out = true});
    visit("color", look.color,
          {.help = "Colour, over age, in linear light",
           .unit = "[r, g, b]",
           .range = {0.0, 1.0},
           .fallback = "render.color",
           .left_out = true});
    visit("opacity", look.opacity,
          {.help = "Opacity, over age", .range = {0.0, 1.0}, .fallback = "render.opacity", .left_out = true});
    visit("rotation", look.rotation,
          {.help = "Anticlockwise turn of the sprite, over age",
           .unit = "radians",
           .range = within(kAngleMax),
           .fallback = "0",
           .left_out = true});
    visit("turn", look.turn,
          {"Each particle starts turned by its own angle within ± turn", "radians", {0.0, kAngleMax}});
    visit("spin", look.spin,
          {"Each particle turns at its own speed within ± spin", "radians/s", {0.0, kAngleMax}});
    visit("stretch", look.stretch,
          {"The sprite reaches back along its path to where it was so long ago, as if exposed so "
           "long; needs render.sprite = \"quad\", and no rotation, turn or spin",
           "s", kTimeRange});
    visit("cell", FieldSpan{look.cell_first, look.cell_last},
          {.help = "Cell of the atlas, or [first, last] played from birth to death; from the top left, row "
                   "by row; needs render.atlas",
           .fallback = "a round dot",
           .left_out = true});
    visit("lit", look.lit, {"False: shines in its colour, whatever light falls on it"});
    visit("fade", FieldPair{look.fade_in, look.fade_out},
          {.help = "Time in which opacity rises after birth and falls before death",
           .unit = "[in, out] s",
           .range = kTimeRange,
           .fallback = "[0.2, 0.5]; none if opacity has several keys",
           .left_out = true});
}

void fields(FieldVisitor& visit, ScenePose& pose) {
    visit(
        "position", pose.position,
        leftOut({"Place of the origin", "[x, y, z]", kPointRange, "[0, 0, 0]; of a key that of its table"}));
    visit("axis", pose.axis,
          leftOut({"Axis of rotation, of any length",
                   "[x, y, z]",
                   kPointRange,
                   "[0, 1, 0]",
                   {.needs = "angle", .unit_length = true}}));
    visit("angle", pose.angle,
          leftOut({"Rotation about the axis, right-handed", "degrees", within(kAngleMax),
                   "0; of a key that of its table"}));
}

void fields(FieldVisitor& visit, SceneKey& key) {
    visit("time", key.time, {"Time since the beginning, rising", "s", {0.0, kKeySecondsMax}, {}, kRequired});
    fields(visit, static_cast<ScenePose&>(key));
}

void fields(FieldVisitor& visit, SceneLive& live) {
    visit("amplitude", live.amplitude, {"Height of the waves", "object units", kPointRange, {}, kRequired});
    visit("frequency", live.frequency, {"Oscillations a second", "1/s", {0.0, 1000.0}, {}, kRequired});
    visit("phase", live.phase, {"Phase at time 0", "degrees", within(kAngleMax)});
    visit("wavelength", live.wavelength,
          leftOut({"Length of the waves", "object units", kSizeRange, "half the longest side"}));
}

void fields(FieldVisitor& visit, ScenePlay& play) {
    visit("clip", play.clip,
          leftOut({"Name of a clip of the container, baked with --animated", {}, {}, "its first"}));
    visit("start", play.start, {"Place in the clip at time 0", "s", within(kClipStartMax)});
    visit("speed", play.speed,
          {"Seconds of the clip a second; below 0 it runs backwards", "1", within(kClipSpeedMax)});
    visit("repeat", play.repeat, {"The clip begins again where it ends"});
    visit("room", play.room,
          {"Factor of the space that its clips take up, for poses of a program", {}, {1.0, 100.0}});
    visit("resolution", play.resolution, {"Texels of its maps along its longest side", {}, {16.0, 4096.0}});
}

void fields(FieldVisitor& visit, SceneMaterialColor& material) {
    visit("name", material.name,
          {"Name of a material of the animated mesh, as in relief info", {}, {}, {}, kRequired});
    visit("color", material.color, {"Its colour in pictures", "[r, g, b]", kShareRange, {}, kRequired});
}

void fields(FieldVisitor& visit, SceneCollider& c) {
    const FieldFile path{c.path, c.origin};
    bool live = c.live.has_value();
    bool baked = !live;
    visit("file", FieldMaybe{path, baked},
          leftOut({"The .relief file to collide with", {}, {}, "required, or mesh"}));
    visit(
        "mesh", FieldMaybe{path, live},
        leftOut(
            {"An .obj or .ply file that deforms; it is not baked", {}, {}, "none", {.instead_of = "file"}}));
    visit("node", c.node,
          leftOut({"Name of a node of the scene's world, to place or move it; needs world",
                   {},
                   {},
                   "none",
                   {.instead_of = "file mesh"}}));
    visit("deform", c.live, leftOut({"How the mesh wobbles", {}, {}, "required by mesh", {.needs = "mesh"}}));
    visit(
        "resolution", c.resolution,
        leftOut(
            {"Texels along a side of the deforming mesh's maps", {}, {16.0, 4096.0}, {}, {.needs = "mesh"}}));
    visit("play", c.play,
          leftOut({"How the container's animated mesh moves", {}, {}, "not at all", {.needs = "file"}}));
    fields(visit, c.given_pose);
    visit("scale", FieldMaybe{c.scale, c.posed}, leftOut({"World units of an object unit", {}, {1e-6, 1e6}}));
    visit("restitution", FieldMaybe{c.restitution, c.posed},
          leftOut({"Factor of the particles' own", {}, {0.0, 1.0}}));
    visit("friction", FieldMaybe{c.friction, c.posed},
          leftOut({"1 − friction is a factor of the particles' own 1 − friction", {}, {0.0, 1.0}}));
    visit("color", c.color,
          leftOut({"Colour in pictures; of a mesh without colours of its own. Where maps are drawn, that of "
                   "the first "
                   "collider is all colliders'",
                   "[r, g, b]",
                   {0.0, 1.0},
                   "clay"}));
    visit("material", c.materials,
          leftOut({"Colours of materials of an animated mesh",
                   {},
                   {},
                   {},
                   {.needs = "play", .most = kMeshMaterialsMax}}));
    visit("key", c.given_keys, leftOut({"Poses at times, two or more", {}, {}, {}, {.most = kPoseKeysMax}}));
}

void fields(FieldVisitor& visit, SceneTouching& touching) {
    const NameList names{touching.materials};
    bool named = !touching.materials.empty();
    visit(
        "within", touching.within,
        {"Distance from the nearest other surface up to which it is touched", {}, kSizeRange, {}, kRequired});
    visit(
        "material", FieldMaybe{names, named},
        leftOut({"Name of the material that is touched, or a list of names", {}, {}, "any, and the ground"}));
    visit("min_speed", touching.min_speed,
          {"Least speed of the emitter's surface relative to the one that it touches", "1/s", kSpeedRange});
}

void fields(FieldVisitor& visit, NormalSpeed& speed) {
    visit("mean", speed.mean, {"Mean of a normal distribution", "1/s", kSpeedRange, {}, kRequired});
    visit("deviation", speed.deviation, {"Its standard deviation", "1/s", kSpeedRange});
}

void fields(FieldVisitor& visit, SceneEmitter& e) {
    EmitterAim none;
    EmitterAim& aim = e.aim ? *e.aim : visit.fills() ? e.aim.emplace() : none;
    const EmitterSpeed speed{aim};
    visit(
        "shape", e.shape,
        {"Place of birth; a sphere is its volume, a shell its surface, a surface that of a collider or mesh",
         {},
         {},
         "\"point\" with point, \"points\" with points, else \"box\"",
         {.selects = true}});
    visit("box_min", FieldMaybe{e.box_min, e.has_box},
          {"Lower corner",
           "[x, y, z]",
           kPointRange,
           "1.45 L about the centre on x and z, 0.15 L above the top",
           {.needs = "box_max", .only = "box"}});
    visit("box_max", FieldMaybe{e.box_max, e.has_box},
          {"Upper corner",
           "[x, y, z]",
           kPointRange,
           "as box_min, 0.75 L above the top",
           {.needs = "box_min", .only = "box"}});
    visit("point", e.box_min,
          {"Place of a point",
           "[x, y, z]",
           kPointRange,
           {},
           {.instead_of = "box_min", .only = "point", .required = true, .chooses = true}});
    visit("center", e.center,
          {"Centre", "[x, y, z]", kPointRange, {}, {.only = "sphere shell disc", .required = true}});
    visit("radius", e.radius,
          {"Radius", {}, kLengthRange, {}, {.only = "sphere shell disc", .required = true}});
    visit("normal", e.normal,
          {"Normal of the disc", "[x, y, z]", kPointRange, {}, {.only = "disc", .not_zero = true}});
    visit("points", FieldFile{e.points_file, e.points_origin},
          {"File of 1 to 2²² points, below",
           {},
           {},
           {},
           {.only = "points", .required = true, .chooses = true}});
    visit("mesh", FieldFile{e.mesh_file, e.mesh_origin},
          leftOut({"The .obj or .ply whose surface it is, in the emitter's space",
                   {},
                   {},
                   "that of the collider it is attached to, as it moves and bends",
                   {.only = "surface"}}));
    visit(
        "group", e.group,
        leftOut({"Joint or node whose weights are the density of the births; of an .obj its group or object",
                 {},
                 {},
                 "all",
                 {.only = "surface"}}));
    visit("material", e.material, leftOut({"Material that gives birth", {}, {}, "all", {.only = "surface"}}));
    visit("touching", e.touching,
          leftOut(
              {"Births only where the surface touches another", {}, {}, "everywhere", {.only = "surface"}}));
    visit("start", e.start, {"Time before anything is born", "s", kTimeRange});
    visit("rate", FieldMaybe{e.rate, e.has_rate},
          {"Births a second; several emitters without a rate share what the others leave of the capacity",
           "1/s",
           {0.0, kRateMax},
           "the capacity by the end of the births"});
    visit("duration", e.duration,
          {"Time from the start to the last birth", "s", kLifeRange, "the whole run"});
    visit("burst", e.burst, {"Births at the start, at most the capacity", {}, {0.0, 1 << 24}});
    visit("burst_every", e.burst_every,
          leftOut(
              {"Time from burst to burst", "s", {1e-4, kSecondsMax}, "a single burst", {.needs = "burst"}}));
    visit("spread", e.spread, {"Births by rate are spread over their step"});
    visit("velocity", FieldMaybe{e.velocity, e.has_velocity},
          leftOut({"Velocity of every birth",
                   "[x, y, z]/s",
                   within(kSpeedMax),
                   "[0, −0.8 L, 0]; none with direction, cone or speed",
                   {.instead_of = "direction cone speed"}}));
    visit("velocity_spread", FieldMaybe{e.velocity_spread, e.has_velocity_spread},
          {"Largest uniform deviation from the velocity, either way", "[x, y, z]/s", kSpeedRange,
           "[0.12, 0.1, 0.12] L; none with direction, cone or speed"});
    visit("direction", FieldMaybe{aim.direction, e.has_aim},
          leftOut({"Direction of births; required for a box or point",
                   "[x, y, z]",
                   kPointRange,
                   "the normal: outwards, the disc's, the point's own, the surface's",
                   {.not_zero = true}}));
    visit("cone", FieldMaybe{aim.cone_degrees, e.has_aim},
          leftOut({"Half angle about the direction, uniform over its solid angle", "degrees", {0.0, 180.0}}));
    visit("speed", FieldMaybe{speed, e.has_speed},
          leftOut({"Speed along the direction: a number, [least, most], or { mean, deviation }, which is "
                   "normal and never below 0",
                   "1/s", kSpeedRange, "0.8 L"}));
    visit("lifetime", FieldSpan{e.lifetime_min, e.lifetime_max}, {"Lifetime", "s", kLifeRange});
    visit("type", e.type,
          {"Number or name of the type", {}, {0.0, kParticleTypesMax - 1}, {}, {.index_of = "type"}});
    visit("seed", e.seed, {"Seed; emitter i draws from the i-th stream of its seed", {}, {0.0, kSeedMax}});
    visit("attach", e.attach,
          leftOut({"Number, from 0, of the collider in whose space the emitter is; needs a place, or the "
                   "shape surface",
                   {},
                   {0.0, WorldTextures::kBodiesMax - 1},
                   "the world",
                   {.index_of = "collider"}}));
    visit("key", e.given_keys, leftOut({"Poses at times, two or more", {}, {}, {}, {.most = kPoseKeysMax}}));
    visit("inherit", e.inherit,
          leftOut({"Share of its own velocity that births take on",
                   {},
                   kFactorRange,
                   {},
                   {.needs = "attach key"}}));
}

void fields(FieldVisitor& visit, SceneSpawn& spawn) {
    fields(visit, static_cast<SpawnSettings&>(spawn));
    visit("material", spawn.on_material,
          leftOut({"Name of the material that was hit", {}, {}, "any", {.only = "collision"}}));
    visit("seed", spawn.seed, {"Seed; spawn i draws from a stream of its own", {}, {0.0, kSeedMax}});
}

void fields(FieldVisitor& visit, SceneTime& time) {
    visit("dt", time.dt, {"Length of a step", "s", {1e-6, 1.0}, "1/60"});
    visit("steps", time.steps, {"Steps of the run", {}, {0.0, kStepsMax}});
    visit("prewarm", time.prewarm,
          {"Time that is played before time 0, in whole steps, at most 10⁷ of them", "s", kTimeRange});
    visit("integrator", time.integrator, {"Integration of positions: semi-implicit Euler, or Verlet"});
}

void fields(FieldVisitor& visit, SceneParticles& particles) {
    visit("capacity", particles.capacity,
          {"Particles alive at once", {}, {1.0, ParticleSystem::kCapacityMax}});
}

void fields(FieldVisitor& visit, SceneForces& forces) {
    visit("gravity", forces.gravity,
          {"Acceleration of gravity", "[x, y, z]/s²", within(kAccelerationMax), "[0, −3 L, 0]"});
    visit("wind", forces.wind,
          {"Velocity of the air everywhere; it needs drag", "[x, y, z]/s", within(kSpeedMax)});
    visit("drag", FieldMaybe{forces.drag, forces.has_drag},
          leftOut({"Rate at which the air carries particles along", "1/s", {0.0, kDragMax}}));
    visit("viscosity", forces.viscosity,
          leftOut({"Dynamic viscosity: drag by Stokes' law",
                   "mass/(length·s)",
                   {0.0, 1e6},
                   "none",
                   {.instead_of = "drag"}}));
}

void fields(FieldVisitor& visit, SceneCollision& c) {
    visit("restitution", c.restitution, {"Share of the normal speed that comes back", {}, {0.0, 1.0}});
    visit("friction", c.friction, {"Share of the tangential speed that is lost", {}, {0.0, 1.0}});
    visit("friction_threshold", c.friction_threshold,
          {"Speed below which there is no friction", "1/s", kSpeedRange});
    visit("sweep", c.sweep,
          {"Longest distance between two tests of a step; 0: only its ends are tested",
           {},
           kLengthRange,
           "half the thickness of the thinnest collider if a step is longer, otherwise 0"});
}

void fields(FieldVisitor& visit, SceneStream& stream) {
    visit("radius", stream.radius,
          {"Distance from emitters and the camera up to which the world has full detail",
           {},
           kSizeRange,
           {},
           kRequired});
    visit("memory", stream.memory,
          {"Bytes of the GPU that the colliders may take, the coarse ones included", "MB", {0.001, 65536.0}});
}

void fields(FieldVisitor& visit, SceneGround& ground) {
    visit("enabled", ground.enabled, {"There is a ground"});
    visit("height", ground.height,
          leftOut({"Its height; needs enabled", {}, kPointRange, "lower end of the bounds"}));
}

void fields(FieldVisitor& visit, SceneCameraKey& key) {
    visit("time", key.time, {"Time since the beginning, rising", "s", {0.0, kKeySecondsMax}, {}, kRequired});
    visit("eye", key.eye,
          {"Place of the camera, instead of camera.eye", "[x, y, z]", kPointRange, {}, kRequired});
    visit("target", key.target, {"Point that it looks at", "[x, y, z]", kPointRange, "camera.target"});
    visit("fov", key.fov, {"Vertical field of view", "degrees", kFovRange, "camera.fov"});
}

void fields(FieldVisitor& visit, SceneCamera& camera) {
    visit("eye", camera.eye,
          leftOut({"Place of the camera",
                   "[x, y, z]",
                   kPointRange,
                   "in front and above, framing the bounds",
                   {.instead_of = "key"}}));
    visit("target", camera.target,
          {"Point that it looks at, not straight above or below the eye", "[x, y, z]", kPointRange,
           "middle of the bounds"});
    visit("fov", camera.fov, {"Vertical field of view", "degrees", kFovRange});
    visit("key", camera.keys, leftOut({"Places of the camera at times", {}, {}, {}, {.most = 10'000}}));
}

void fields(FieldVisitor& visit, SceneWeather& weather) {
    visit("time", weather.time, {"Time since the beginning, rising", "s", {0.0, kKeySecondsMax}});
    visit("sun", weather.sun, {"Light of the sun; 0: clouds hide it", {}, {0.0, 1.0}});
    visit("wet", weather.wet, {"How wet is what rain reaches", {}, {0.0, 1.0}});
    visit("snow", weather.snow, {"How much snow lies where it reaches level ground", {}, {0.0, 1.0}});
}

void fields(FieldVisitor& visit, SceneRender& r) {
    visit("size", FieldPair{r.width, r.height},
          {"Size of the pictures, 2²⁶ pixels at most", "[width, height] pixels", {1.0, 65535.0}});
    visit("point_size", r.point_size, {"Diameter of particles", {}, kSizeRange, "0.0065 L"});
    visit("color", r.color, {"Colour of particles", "[r, g, b]", {0.0, 1.0}});
    visit("opacity", r.opacity, {"Opacity of particles", {}, {0.0, 1.0, false}});
    visit("background", r.background, {"Colour of the background", "[r, g, b]", {0.0, 1.0}});
    visit("every", r.every, {"Steps from frame to frame", {}, {1.0, kStepsMax}});
    visit("first", r.first,
          {"Step of the first frame; 0: before the first step", {}, {0.0, kStepsMax}, "every"});
    visit("last", r.last, {"Step of the last frame", {}, {0.0, kStepsMax}, "the last step"});
    visit("sort_frames", r.sort_frames,
          {"Frames that a whole depth sort is spread over, 2 or more; 0: no sort. On the compute "
           "path each frame has a whole one",
           {},
           {0.0, 200.0}});
    visit("sprite", r.sprite, {"Form of particles; a quad may be of any size and turns with its corners"});
    visit("blend", r.blend, {"Blending of particles"});
    visit("soft", r.soft,
          {"Distance before the collider and the floor over which sprites fade", {}, kLengthRange});
    visit("atlas", FieldFile{r.atlas, r.atlas_origin},
          leftOut({"PNG with alpha, sides up to 8192; needs a type with cell", {}, {}, "none"}));
    visit("atlas_cells", FieldPair{r.atlas_columns, r.atlas_rows},
          leftOut({"Cells of the atlas, dividing its sides",
                   "[columns, rows]",
                   {1.0, 4096.0},
                   {},
                   {.needs = "atlas"}}));
    visit("mesh", FieldFile{r.mesh, r.mesh_origin},
          leftOut({"The .obj or .ply that the collider was baked from: it is drawn, the maps still cast the "
                   "shadows",
                   {},
                   {},
                   "none: the maps are drawn"}));
    visit(
        "meshes", FieldFile{r.meshes, r.meshes_origin},
        leftOut(
            {"Folder of .ply and .obj files, which may have colours at their vertices: a world's mesh NAME "
             "is drawn as "
             "NAME.ply, the container NAME.relief too, with shadows of their own. What plays a clip is drawn "
             "from its container",
             {},
             {},
             "none: the maps are drawn",
             {.instead_of = "mesh"}}));
    visit("fog", r.fog,
          {"Distance over which 63 % is lost in the background's colour; 0: no fog",
           {},
           kLengthRange,
           {},
           {.needs = "meshes"}});
    visit("metre", r.metre,
          {"World units of a metre: of the meshes' grain, snow drifts and shaded corners",
           {},
           kSizeRange,
           {},
           {.needs = "meshes"}});
    visit("shadows", r.shadows,
          leftOut(
              {"Distance from camera.target, along x and z, up to which the meshes have shadows and shelter",
               {},
               kSizeRange,
               "the whole scene",
               {.needs = "meshes"}}));
    visit("weather", r.weather,
          leftOut({"Weather of the meshes at times; between them it changes evenly",
                   {},
                   {},
                   "sun, and nothing wet",
                   {.needs = "meshes", .most = 10'000}}));
}

void fields(FieldVisitor& visit, SceneType& type) {
    visit("name", type.name, leftOut({"Name for emitter.type and spawn, not taken twice", {}, {}, "none"}));
    fields(visit, static_cast<ParticleType&>(type));
    visit("collides", CollidesList{type.collides},
          {"The colliders it meets, by number from 0, 7 standing for all beyond 7 too, and \"ground\", as in "
           "[0, \"ground\"]; it passes through all others",
           {},
           {},
           "everything"});
    fields(visit, type.look);
}

void fields(FieldVisitor& visit, Scene& scene) {
    visit("world", FieldFile{scene.world, scene.world_origin},
          leftOut({"The world.json whose bodies particles collide with, beside the colliders",
                   {},
                   {},
                   "none, and then a collider is required"}));
    visit("collider", scene.colliders,
          {"What particles collide with", {}, {}, {}, {.most = WorldTextures::kBodiesMax, .single = true}});
    visit("material", scene.materials,
          leftOut({"Responses of the colliders' materials", {}, {}, {}, {.most = kSceneMaterialsMax}}));
    visit("stream", scene.stream, leftOut({"Colliders of the world that are there when they are needed"}));
    visit("time", scene.time, {"Steps"});
    visit("particles", scene.particles, {"Room for particles"});
    visit("emitter", scene.emitters, {"Births", {}, {}, {}, {.most = kEmittersMax, .single = true}});
    visit("spawn", scene.spawns, leftOut({"Births by hits and deaths", {}, {}, {}, {.most = kSpawnsMax}}));
    visit("forces", scene.forces, {"Gravity, wind and drag"});
    fields(visit, scene.air);
    visit("flow", scene.flow, leftOut({"Velocities of the air on a grid; it needs drag"}));
    visit("collision", scene.collision, {"Collisions of particles without a type"});
    visit("type", scene.types,
          leftOut({"Types of particles; the first is type 0", {}, {}, {}, {.most = kLooksMax}}));
    visit("ground", scene.ground, {"The floor"});
    visit("camera", scene.camera, {"The camera"});
    visit("render", scene.render, {"Pictures"});
}

}  // namespace relief

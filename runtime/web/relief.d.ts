// relief-particles: particles that collide with baked meshes, in WebGL2.
//
// Lengths are in the collider's units, times in seconds, angles in degrees, colours in sRGB. Points and other lists are
// flat: x, y, z of the first, then of the second. What goes wrong throws a ReliefError of one sentence. Colliders, systems
// and GpuColliders hold memory that only dispose() gives back.

/** Everything that this package throws. Its message is one sentence that names the thing and mostly the cure. */
export class ReliefError extends Error {
    constructor(message: string);
}

export type Vec3 = [number, number, number];
/** Numbers in a row. A Float32Array is taken as it is, others are converted. */
export type Numbers = ArrayLike<number> & (readonly number[] | ArrayBufferView);
/** 16 numbers, column by column, as WebGL takes them; or what keeps them in `elements`, such as three.js's Matrix4. */
export type Matrix = Numbers | { readonly elements: Numbers };
/** A URL, what fetch() answered, a dropped file, or the bytes. */
export type Source = string | URL | Request | Response | Blob | ArrayBuffer | Uint8Array;

export interface InitOptions {
    /** Where relief_wasm.wasm lies, if not beside relief.js. */
    wasmUrl?: string | URL;
    /** Its bytes, where there is nothing to fetch. */
    wasmBinary?: ArrayBuffer | Uint8Array;
}

/** Starts the WebAssembly, once; load() does so itself. Only the first call's options count. */
export function init(options?: InitOptions): Promise<unknown>;

/** Fetches and reads a .relief file. */
export function load(source: Source): Promise<Collider>;

/**
 * The mesh of an OBJ or PLY file, by the ending of its name: three numbers a vertex, three indices a triangle. init() must
 * have ended.
 */
export function readMesh(name: string, bytes: Uint8Array): { vertices: Float32Array; triangles: Uint32Array };

export interface Bounds {
    min: Vec3;
    max: Vec3;
}

/** What a collider says of n points. */
export interface Answers {
    /** n: to the surface, below 0 inside. About 1e30 or beyond where a point is outside, and no more is known. */
    distance: Float32Array;
    /** 3 n: of the surface, outwards; 0 where there is none. */
    normal: Float32Array;
    /** n: the map that decides; -1 where none has a say. */
    map: Int32Array;
}

export interface MapInfo {
    format: string;
    encoding: string;
    compare: string;
    decode: string;
    projection: "orthographic" | "cube";
    width: number;
    height: number;
    /** 6 of a cube, else 1. */
    faces: number;
    /** Object space to map space: three rows of four. */
    rows: [number, number, number, number][];
    object_per_map: [number, number, number, number];
    encloses: boolean;
    empty_is_outside: boolean;
    bytes: number;
}

export interface ColliderInfo {
    bounds: Bounds;
    unit: string;
    mesh: { name: string; hash: string; triangles: number };
    tool: string;
    options: string;
    bytes: number;
    gpu_bytes: number;
    /** Side of the finest texel, in object units. */
    finest_texel: number;
    maps: MapInfo[];
}

/** A collider in memory. It needs no WebGL; systems made of it keep what they need of it. */
export class Collider {
    /** @param bytes of a .relief file; kept, so do not change them. init() must have ended. */
    constructor(bytes: Uint8Array);
    readonly bytes: Uint8Array;
    readonly info: ColliderInfo;
    readonly bounds: Bounds;
    /** Asks the CPU. @param points 3 n numbers. */
    query(points: Numbers): Answers;
    /**
     * The texels of a map, 8 numbers each: depth and normal of the front, then of the back; a depth of NaN where nothing
     * is. Row y = 0 comes first, the faces of a cube one after the other.
     */
    texels(map: number): Float32Array;
    dispose(): void;
}

/** A collider as textures, for one's own shaders in that context. A lost context takes it along: make a new one. */
export class GpuCollider {
    constructor(gl: WebGL2RenderingContext, collider: Collider);
    readonly collider: Collider;
    /**
     * What a fragment or vertex shader has behind its `#version 300 es` line. It then calls
     * `ReliefField reliefEvaluate(vec3 p)`, whose members are `float distance`, `vec3 normal` and `int map`, and
     * `bool reliefInside(ReliefField)`.
     */
    readonly glsl: string;
    /** Asks the GPU, and waits for it; see Collider.query(). */
    query(points: Numbers): Answers;
    /** Tells a linked program its three samplers (units `unit` to `unit` + 2) and its uniform block. Once is enough. */
    attach(program: WebGLProgram, unit?: number, block?: number): void;
    /**
     * Before a draw with that program: binds three textures to units `unit` to `unit` + 2, and a buffer to the uniform
     * block binding `block`. It leaves them bound, on purpose; it is all in this package that changes a context's state.
     */
    bind(unit?: number, block?: number): void;
    dispose(): void;
}

// <!-- generated: scene -->
/** How the mesh deforms. */
export interface SceneColliderDeform {
    /** Bends, twists or wobbles. */
    kind: "bend" | "twist" | "wobble";
    /** Largest angle, up to 360 degrees; of a wobble a length, degrees. */
    amplitude: number;
    /** Oscillations a second, 1/s. */
    frequency: number;
    /** Phase at time 0, degrees. */
    phase?: number;
    /** Axis of a bend or twist, of any length, [x, y, z]. */
    axis?: Vec3 | Numbers;
    /** Direction of the beam that a bend winds, across the axis, [x, y, z]. */
    along?: Vec3 | Numbers;
    /** A point of the axis, [x, y, z]. */
    center?: Vec3 | Numbers;
    /** From the center, along the axis or, of a bend, `along`: the angle grows from 0 to all of it, [low, high]. */
    range?: [number, number];
    /** Wavelength of a wobble. */
    wavelength?: number;
}

/** Poses at times, two or more. */
export interface SceneColliderKey {
    /** Time since the beginning, rising, s. */
    time: number;
    /** Place of the origin, [x, y, z]. */
    position?: Vec3 | Numbers;
    /** Axis of rotation, of any length, [x, y, z]. */
    axis?: Vec3 | Numbers;
    /** Rotation about the axis, right-handed, degrees. */
    angle?: number;
}

/** What particles collide with. */
export interface SceneCollider {
    /** The .relief file to collide with. */
    file?: string;
    /** An .obj or .ply file that deforms; it is not baked. */
    mesh?: string;
    deform?: SceneColliderDeform;
    /** Texels along a side of the deforming mesh's maps. */
    resolution?: number;
    /** Place of the origin, [x, y, z]. */
    position?: Vec3 | Numbers;
    /** Axis of rotation, of any length, [x, y, z]. */
    axis?: Vec3 | Numbers;
    /** Rotation about the axis, right-handed, degrees. */
    angle?: number;
    /** World units of an object unit. */
    scale?: number;
    /** Factor of the particles' own. */
    restitution?: number;
    /** 1 − friction is a factor of the particles' own 1 − friction. */
    friction?: number;
    key?: readonly SceneColliderKey[];
}

/** Steps. */
export interface SceneTime {
    /** Length of a step, s. */
    dt?: number;
    /** Steps of the run. */
    steps?: number;
    /** Time that is played before time 0, in whole steps, at most 10⁷ of them, s. */
    prewarm?: number;
    /** Integration of positions: semi-implicit Euler, or Verlet. */
    integrator?: "euler" | "verlet";
}

/** Room for particles. */
export interface SceneParticles {
    /** Particles alive at once. */
    capacity?: number;
}

/** Poses at times, two or more. */
export interface SceneEmitterKey {
    /** Time since the beginning, rising, s. */
    time: number;
    /** Place of the origin, [x, y, z]. */
    position?: Vec3 | Numbers;
    /** Axis of rotation, of any length, [x, y, z]. */
    axis?: Vec3 | Numbers;
    /** Rotation about the axis, right-handed, degrees. */
    angle?: number;
}

/** Births. */
export interface SceneEmitter {
    /** Place of birth; a sphere is its volume, a shell its surface. */
    shape?: "box" | "sphere" | "shell" | "disc" | "points" | "point";
    /** Lower corner, [x, y, z]. */
    box_min?: Vec3 | Numbers;
    /** Upper corner, [x, y, z]. */
    box_max?: Vec3 | Numbers;
    /** Place of a point, [x, y, z]. */
    point?: Vec3 | Numbers;
    /** Centre, [x, y, z]. */
    center?: Vec3 | Numbers;
    /** Radius. */
    radius?: number;
    /** Normal of the disc, [x, y, z]. */
    normal?: Vec3 | Numbers;
    /** File of 1 to 2²² points, below. */
    points?: string;
    /** Time before anything is born, s. */
    start?: number;
    /** Births a second; several emitters without a rate share what the others leave of the capacity, 1/s. */
    rate?: number;
    /** Time from the start to the last birth, s. */
    duration?: number;
    /** Births at the start, at most the capacity. */
    burst?: number;
    /** Time from burst to burst, s. */
    burst_every?: number;
    /** Births by rate are spread over their step. */
    spread?: boolean;
    /** Velocity of every birth, [x, y, z]/s. */
    velocity?: Vec3 | Numbers;
    /** Largest uniform deviation from the velocity, either way, [x, y, z]/s. */
    velocity_spread?: Vec3 | Numbers;
    /** Direction of births; required for a box or point, [x, y, z]. */
    direction?: Vec3 | Numbers;
    /** Half angle about the direction, uniform over its solid angle, degrees. */
    cone?: number;
    /** Speed along the direction: a number, [least, most], or { mean, deviation }, which is normal and never below 0, 1/s. */
    speed?: number | [number, number] | { mean: number; deviation?: number };
    /** Lifetime, s. */
    lifetime?: number | [number, number];
    /** Number or name of the type. */
    type?: number | string;
    /** Seed; emitter i draws from the i-th stream of its seed. */
    seed?: number;
    /** Number, from 0, of the collider in whose space the emitter is; needs a place. */
    attach?: number | string;
    key?: readonly SceneEmitterKey[];
    /** Share of its own velocity that births take on. */
    inherit?: number;
}

/** Births by hits and deaths. */
export interface SceneSpawn {
    /** The event. collision: a body or the ground was hit, and the step before touched nothing; death: of age, or of a hit. */
    on: "collision" | "death";
    /** Number or name of the type that hits or dies. */
    of?: number | string;
    /** Least speed of a hit along the normal, relative to the surface, 1/s. */
    min_speed?: number;
    /** Number or name of the type that is born. */
    type?: number | string;
    /** Births for each event. */
    count?: number | [number, number];
    /** Births of a step at most. */
    most?: number;
    /** Lifetime of what is born, s. */
    lifetime?: number | [number, number];
    /** Share of the parent's velocity; after a hit of the part along the surface. */
    inherit?: number;
    /** Speed about the normal, 1/s. */
    speed?: number | [number, number];
    /** Share of the hit's speed, on top of speed. */
    kick?: number;
    /** Half angle about the normal, degrees. */
    cone?: number;
    /** Seed; spawn i draws from a stream of its own. */
    seed?: number;
}

/** Gravity, wind and drag. */
export interface SceneForces {
    /** Acceleration of gravity, [x, y, z]/s². */
    gravity?: Vec3 | Numbers;
    /** Velocity of the air everywhere; it needs drag, [x, y, z]/s. */
    wind?: Vec3 | Numbers;
    /** Rate at which the air carries particles along, 1/s. */
    drag?: number;
    /** Dynamic viscosity: drag by Stokes' law, mass/(length·s). */
    viscosity?: number;
}

/** Points that attract or repel. */
export interface SceneAttractor {
    /** Centre of attraction, [x, y, z]. */
    position: Vec3 | Numbers;
    /** Acceleration at the radius; below 0 it repels, 1/s². */
    strength: number;
    /** Distance up to which the strength grows. */
    radius: number;
    /** Beyond the radius the strength falls with this power of the distance. */
    falloff?: number;
    /** Distance beyond which there is no force. */
    reach?: number;
}

/** Axes that particles are driven round. */
export interface SceneVortex {
    /** A point of the axis, [x, y, z]. */
    center: Vec3 | Numbers;
    /** Direction of the axis, of any length, [x, y, z]. */
    axis?: Vec3 | Numbers;
    /** Acceleration at the radius, right-handed about the axis, 1/s². */
    strength: number;
    /** Distance from the axis up to which the strength grows. */
    radius: number;
    /** Beyond the radius the strength falls with this power of the distance. */
    falloff?: number;
}

/** Turbulence; it needs drag. */
export interface SceneCurlNoise {
    /** Mean speed of the turbulence, 1/s. */
    amplitude: number;
    /** Size of the largest eddies. */
    scale: number;
    /** Sizes of eddies, each half as large as the one before. */
    octaves?: number;
    /** Speed at which eddies give way to others; up to 1000 scales a second, 1/s. */
    drift?: number;
    /** Seed of the pattern. */
    seed?: number;
}

/** Velocities of the air on a grid; it needs drag. */
export interface SceneFlow {
    /** Little-endian 32-bit floats, x fastest, then y, then z. */
    raw: string;
    /** Nodes along x, y and z, 2²⁴ at most, [nx, ny, nz]. */
    size: Vec3 | Numbers;
    /** Floats a node. */
    components?: number;
    /** Lower corner of the flow's box, [x, y, z]. */
    box_min: Vec3 | Numbers;
    /** Upper corner of the flow's box, [x, y, z]. */
    box_max: Vec3 | Numbers;
    /** Velocity outside of the box: 0, or that of the nearest point of the box. */
    outside?: "zero" | "edge";
    /** Factor of every velocity. */
    gain?: number;
}

/** Collisions of particles without a type. */
export interface SceneCollision {
    /** Share of the normal speed that comes back. */
    restitution?: number;
    /** Share of the tangential speed that is lost. */
    friction?: number;
    /** Speed below which there is no friction, 1/s. */
    friction_threshold?: number;
    /** Longest distance between two tests of a step; 0: only its ends are tested. */
    sweep?: number;
}

/** Types of particles; the first is type 0. */
export interface SceneType {
    /** Name for emitter.type and spawn, not taken twice. */
    name?: string;
    /** Factor of forces.gravity; below 0 it rises. */
    gravity?: number;
    /** Divides the drag. */
    mass?: number;
    /** Radius of collision; size is the picture's. */
    radius?: number;
    /** Share of the normal speed that comes back. */
    restitution?: number;
    /** Share of the tangential speed that is lost. */
    friction?: number;
    /** Speed below which there is no friction, 1/s. */
    friction_threshold?: number;
    /** Reaction to a collision, by the method's page, section Collision. */
    on_collision?: "bounce" | "stop" | "slide" | "die";
    /** Life that each step in contact costs, s. */
    lifetime_loss?: number;
    /** The colliders it meets, by number from 0, and "ground", as in [0, "ground"]; it passes through all others. */
    collides?: readonly (number | "ground")[];
    /** Diameter, over age. */
    size?: number | readonly [number, number][];
    /** Colour, over age, in linear light, [r, g, b]. */
    color?: Vec3 | Numbers | readonly [number, number, number, number][];
    /** Opacity, over age. */
    opacity?: number | readonly [number, number][];
    /** Anticlockwise turn of the sprite, over age, radians. */
    rotation?: number | readonly [number, number][];
    /** Each particle starts turned by its own angle within ± turn, radians. */
    turn?: number;
    /** Each particle turns at its own speed within ± spin, radians/s. */
    spin?: number;
    /** The sprite reaches back along its path to where it was so long ago, as if exposed so long; needs render.sprite = "quad", and no rotation, turn or spin, s. */
    stretch?: number;
    /** Cell of the atlas, or [first, last] played from birth to death; from the top left, row by row; needs render.atlas. */
    cell?: number | [number, number];
    /** False: shines in its colour, whatever light falls on it. */
    lit?: boolean;
    /** Time in which opacity rises after birth and falls before death, [in, out] s. */
    fade?: [number, number];
}

/** The floor. */
export interface SceneGround {
    /** There is a ground. */
    enabled?: boolean;
    /** Its height; needs enabled. */
    height?: number;
}

/** Places of the camera at times. */
export interface SceneCameraKey {
    /** Time since the beginning, rising, s. */
    time: number;
    /** Place of the camera, instead of camera.eye, [x, y, z]. */
    eye: Vec3 | Numbers;
    /** Point that it looks at, [x, y, z]. */
    target?: Vec3 | Numbers;
    /** Vertical field of view, degrees. */
    fov?: number;
}

/** The camera. */
export interface SceneCamera {
    /** Place of the camera, [x, y, z]. */
    eye?: Vec3 | Numbers;
    /** Point that it looks at, not straight above or below the eye, [x, y, z]. */
    target?: Vec3 | Numbers;
    /** Vertical field of view, degrees. */
    fov?: number;
    /** Interpolation between keys: Catmull-Rom by time, or straight lines. */
    path?: "smooth" | "linear";
    key?: readonly SceneCameraKey[];
}

/** Pictures. */
export interface SceneRender {
    /** Size of the pictures, 2²⁶ pixels at most, [width, height] pixels. */
    size?: [number, number];
    /** Diameter of particles. */
    point_size?: number;
    /** Colour of particles, [r, g, b]. */
    color?: Vec3 | Numbers;
    /** Opacity of particles. */
    opacity?: number;
    /** Colour of the background, [r, g, b]. */
    background?: Vec3 | Numbers;
    /** Steps from frame to frame. */
    every?: number;
    /** Step of the first frame; 0: before the first step. */
    first?: number;
    /** Step of the last frame. */
    last?: number;
    /** Frames that a whole depth sort is spread over, 2 or more; 0: no sort. On the compute path each frame has a whole one. */
    sort_frames?: number;
    /** Form of particles; a quad may be of any size and turns with its corners. */
    sprite?: "point" | "quad";
    /** Blending of particles. */
    blend?: "alpha" | "additive";
    /** Distance before the collider and the floor over which sprites fade. */
    soft?: number;
    /** PNG with alpha, sides up to 8192; needs a type with cell. */
    atlas?: string;
    /** Cells of the atlas, dividing its sides, [columns, rows]. */
    atlas_cells?: [number, number];
    /** The .obj or .ply that the collider was baked from: it is drawn, the maps still cast the shadows. */
    mesh?: string;
}

/** A scene with the keys of scene.toml, as runtime/scene/README.md of the Relief sources describes them. */
export interface Scene {
    collider?: SceneCollider | readonly SceneCollider[];
    time?: SceneTime;
    particles?: SceneParticles;
    emitter?: SceneEmitter | readonly SceneEmitter[];
    spawn?: readonly SceneSpawn[];
    forces?: SceneForces;
    attractor?: readonly SceneAttractor[];
    vortex?: readonly SceneVortex[];
    curl_noise?: SceneCurlNoise;
    flow?: SceneFlow;
    collision?: SceneCollision;
    type?: readonly SceneType[];
    ground?: SceneGround;
    camera?: SceneCamera;
    render?: SceneRender;
}

// <!-- end of scene -->
/** A scene as the text of scene.toml, as relief-sim plays it. */
export function toToml(scene: Scene): string;

export interface ParticleSystemOptions {
    /** The one collider of a scene that names none. */
    collider?: Collider;
    /** Defaults for whatever it leaves out. As text it is scene.toml itself, and names its colliders. */
    scene?: Scene | string;
    /** The files that the scene names, by their paths in it. */
    files?: Record<string, Collider | Uint8Array | string>;
    /** False: the collider casts no shade on particles, which is cheaper. */
    shaded?: boolean;
}

export interface Birth {
    position: Vec3 | Numbers;
    /** Default: 0. */
    velocity?: Vec3 | Numbers;
    /** Seconds; default 1. */
    lifetime?: number;
    /** Index into the scene's types; default 0. */
    type?: number;
}

export interface DrawOptions {
    /** World to eye. Of a three.js camera: matrixWorldInverse. */
    view: Matrix;
    /** Eye to clip space, of a perspective. Of a three.js camera: projectionMatrix. */
    projection: Matrix;
    /** Default: the one that is bound; null: the canvas. */
    framebuffer?: WebGLFramebuffer | null;
    /** Pixels of the target. Default: those of the canvas; of another framebuffer those of the viewport. */
    width?: number;
    height?: number;
    /** False: the target holds linear light, as a float target for tone mapping does. Default true. */
    srgb?: boolean;
}

export interface SystemInfo {
    time: number;
    alive: number;
    born: number;
    died: number;
    /** Births for which there was no room. */
    refused: number;
    /** Texels of the state textures that may hold a particle: 0 … extent - 1, row by row. */
    extent: number;
    capacity: number;
    /** Width of the state textures. */
    width: number;
    dt: number;
    steps: number;
    bounds: Bounds;
    ground: number | null;
    camera: { eye: Vec3; target: Vec3; fov: number };
    background: Vec3;
    /** The scene's colliders, each where it stands now: object to world, by columns. One that deforms names its mesh. */
    bodies: { file: string; deforms: boolean; moves: boolean; matrix: number[] }[];
}

/** A mesh whose vertices move on the GPU, in object space. Item i of a texture lies at (i & ((1 << shift) - 1), i >> shift). */
export interface LiveMesh {
    /** Floats, xyz of each vertex. */
    positions: WebGLTexture;
    vertexShift: number;
    /** Unsigned integers, the vertices of each triangle. */
    corners: WebGLTexture;
    triangleShift: number;
    triangles: number;
}

/** Particles in a WebGL2 context. All it does leaves the context's state as it was. */
export class ParticleSystem {
    constructor(gl: WebGL2RenderingContext, options: ParticleSystemOptions);
    readonly info: SystemInfo;
    /** @param dt seconds, 0 … 1; default: the scene's. Take Math.min(seconds since the last frame, 1 / 30). */
    step(dt?: number): void;
    /** Draws over what is there, hidden by nearer depths of the target; writes no depth. */
    draw(options: DrawOptions): void;
    /** Births on top of the emitters'. Also 8 numbers each: position, velocity, lifetime, type. Returns how many found room. */
    spawn(births: readonly Birth[] | Numbers): number;
    /**
     * Changes a part of a scene given as an object; not its capacity or integrator, and of its colliders only the pose:
     * `set({ collider: { position, axis, angle } })`, or a list with one for each of several, {} for those that stay. Before
     * each step of a collider that moves: it pushes what it meets on its way there. A single collider moves if the scene gave it
     * a pose from the beginning, such as `collider: { position: [0, 0, 0] }`.
     */
    set(patch: Scene): void;
    /** Starts over with nothing alive; also after 'webglcontextrestored'. */
    restart(): void;
    /** The particles, 12 numbers each: position, age, velocity, lifetime, type, steps in contact, contact, id. Waits for the GPU. */
    read(): Float32Array;
    /** The state, for one's own shaders; other textures after each step. They belong to the system. */
    textures(): { position: WebGLTexture; velocity: WebGLTexture; birth: WebGLTexture };
    /** The mesh of a body that deforms, as it is now; null of one that does not. It belongs to the system. */
    mesh(body: number): LiveMesh | null;
    /** The scene as scene.toml. */
    toToml(): string;
    dispose(): void;
}

export const Relief: {
    init: typeof init;
    load: typeof load;
    readMesh: typeof readMesh;
    Collider: typeof Collider;
    GpuCollider: typeof GpuCollider;
    ParticleSystem: typeof ParticleSystem;
    ReliefError: typeof ReliefError;
    toToml: typeof toToml;
};
export default Relief;

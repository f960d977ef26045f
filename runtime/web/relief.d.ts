// SPDX-License-Identifier: Apache-2.0
// relief-particles: particles that collide with baked meshes, in WebGL2.
//
// Lengths are in the collider's units, times in seconds, angles in degrees, colours in sRGB. Lists of points are flat:
// x, y, z of the first point, then of the second. Functions throw ReliefError on failure. Call dispose() on colliders,
// worlds, systems and GpuColliders to free their memory.

/** The error type of this package. The message is one line that names the error and, in most cases, the fix. */
export class ReliefError extends Error {
    constructor(message: string);
}

export type Vec3 = [number, number, number];
/** A flat list of numbers. A Float32Array is used without conversion. */
export type Numbers = ArrayLike<number> & (readonly number[] | ArrayBufferView);
/** 16 numbers in column-major order, or an object that stores them in `elements`, such as a three.js Matrix4. */
export type Matrix = Numbers | { readonly elements: Numbers };
/** A URL, a request or response of fetch(), a file, or the bytes. */
export type Source = string | URL | Request | Response | Blob | ArrayBuffer | Uint8Array;

export interface InitOptions {
    /** URL of relief_wasm.wasm (default: beside relief.js). */
    wasmUrl?: string | URL;
    /** The bytes of relief_wasm.wasm, instead of fetching it. */
    wasmBinary?: ArrayBuffer | Uint8Array;
}

/** Starts the WebAssembly module. load() calls this itself. Only the options of the first call apply. */
export function init(options?: InitOptions): Promise<unknown>;

/** Loads a .relief file. */
export function load(source: Source): Promise<Collider>;

/**
 * Loads a world.json written by `relief bake LEVEL --world`, and the containers that it names, from the same folder.
 */
export function loadWorld(source: string | URL | Request | Response): Promise<World>;

export interface StreamOptions {
    /**
     * Full detail within this distance of emitters, the camera of draw() and points of setPointsOfInterest(); world
     * units, above 0.
     */
    radius: number;
    /** GPU memory budget for the colliders of a system in megabytes, coarse colliders included. Default 256. */
    memory?: number;
}

export interface WorldSource extends StreamOptions {
    /**
     * Loads a container, named as in world.json. The bytes are verified against the hash in world.json. It is called
     * again for containers that were evicted. The signal aborts when no system needs the file any more.
     */
    load(file: string, signal: AbortSignal): Promise<Uint8Array> | Uint8Array;
}

/**
 * Like loadWorld(), for worlds too large to load completely. Loads only the coarse container of each collider that has
 * one. A ParticleSystem loads the full containers near its emitters, the camera of draw() and the points of
 * setPointsOfInterest(): up to six requests at a time, and 128 kB of uploads per step.
 */
export function streamWorld(source: string | URL | Request | Response, options: StreamOptions): Promise<World>;

export interface Bounds {
    min: Vec3;
    max: Vec3;
}

/** Results of Collider.query() at n points. */
export interface Samples {
    /** n: distance to the surface, below 0 inside; about 1e30 or more if the point is far outside or no map votes. */
    distance: Float32Array;
    /** 3 n: outward surface normal; 0 if the point is far outside or no map votes. */
    normal: Float32Array;
    /** n: the map that decides; -1 if no map votes. */
    map: Int32Array;
}

export interface MapInfo {
    /** As in `relief bake --map`: "patches", for example. */
    format: string;
    encoding: string;
    compare: string;
    decode: string;
    /** local: patches, each with its own axis. */
    projection: "orthographic" | "cube" | "local";
    /** In texels. Texels of patches are stored in rows without a spatial meaning. */
    width: number;
    height: number;
    /** 6 for a cube, otherwise 1. */
    faces: number;
    /** Object space to map space: three rows of four numbers. */
    object_to_map: [number, number, number, number][];
    object_per_map: [number, number, number, number];
    encloses: boolean;
    empty_is_outside: boolean;
    bytes: number;
}

export interface ColliderInfo {
    bounds: Bounds;
    unit: string;
    /** `options`: those of `relief bake`, as on its command line. */
    provenance: { mesh_name: string; mesh_hash: string; triangles: number; tool_version: string; options: string };
    gpu_bytes: number;
    /** Side length of the finest texel, in object units. */
    finest_texel: number;
    maps: MapInfo[];
}

/** A collider in memory. Needs no WebGL. You can dispose of it after creating systems from it. */
export class Collider {
    /** @param bytes  a .relief file; kept by reference, so do not modify it. Await init() first. */
    constructor(bytes: Uint8Array);
    readonly bytes: Uint8Array;
    readonly info: ColliderInfo;
    readonly bounds: Bounds;
    /** Evaluates the collider on the CPU. @param points  3 n numbers. */
    query(points: Numbers): Samples;
    /**
     * Returns the texels of a map, 8 numbers each: depth and normal of the front surface, then of the back surface; the
     * depth is NaN if there is no surface. Row y = 0 comes first; the faces of a cube follow each other. Use tree() for
     * patches.
     */
    texels(map: number): Float32Array;
    /**
     * Returns the tree of a patch map: two words per texel, low and high. See "Patches" in the format
     * specification.
     */
    tree(map: number): Uint32Array;
    dispose(): void;
}

/** Results of World.query() at n points. */
export interface WorldSamples {
    /** n: the least distance over all bodies, in world units; otherwise as in Samples. */
    distance: Float32Array;
    /** 3 n: outward surface normal in world space; 0 if the point is far outside or no body votes. */
    normal: Float32Array;
    /** n: the body that decides; -1 if no body votes. */
    body: Int32Array;
}

export interface WorldBody {
    /** Index of its collider. */
    collider: number;
    /** Name of the node in the level; may be empty. */
    node: string;
    position: Vec3;
    /** Unit quaternion x, y, z, w. */
    rotation: [number, number, number, number];
    scale: number;
    restitution: number;
    friction: number;
}

/** A level in memory: placed bodies. Needs no WebGL. You can dispose of it after creating systems from it. */
export class World {
    /**
     * @param files  world.json and the containers, keyed by their names in world.json; kept by reference. Await init()
     * first.
     * @param stream  for a streamed world; `files` then contains the coarse container of each collider that has one,
     * and the full containers of the others
     */
    constructor(files: Record<string, Collider | Uint8Array | string>, stream?: WorldSource);
    readonly files: Record<string, Collider | Uint8Array | string>;
    readonly unit: string;
    readonly colliders: { file: string; hash: string; gpu_bytes: number; mesh: string; min: Vec3; max: Vec3;
                          coarse?: { file: string; hash: string; gpu_bytes: number } }[];
    readonly bodies: WorldBody[];
    /** Null if the world is not streamed. */
    readonly stream: WorldSource | null;
    /** Bounds of all bodies. */
    readonly bounds: Bounds;
    /**
     * Evaluates the world on the CPU, with bodies in the poses of the file; a streamed world uses its coarse colliders.
     * The cost is proportional to the number of bodies.
     * @param points  3 n numbers.
     */
    query(points: Numbers): WorldSamples;
    dispose(): void;
}

/** A collider as textures, for your own shaders in its context. Create a new one after the context was lost. */
export class GpuCollider {
    constructor(gl: WebGL2RenderingContext, collider: Collider);
    readonly collider: Collider;
    /**
     * GLSL to insert into a vertex or fragment shader after its `#version 300 es` line. It defines
     * `ReliefField reliefEvaluate(vec3 p)`, with members `float distance`, `vec3 normal` and `int map`, and
     * `bool reliefInside(ReliefField)`.
     */
    readonly glsl: string;
    /**
     * Sets the three samplers (units `unit` to `unit` + 2) and the uniform block of a linked program. Call once per
     * program.
     */
    attach(program: WebGLProgram, unit?: number, block?: number): void;
    /**
     * Binds three textures to units `unit` to `unit` + 2 and a buffer to uniform block binding `block`. Call it before
     * drawing. The bindings stay; this is the only function of the package that changes the state of the context.
     */
    bind(unit?: number, block?: number): void;
    dispose(): void;
}

// Scene, with the keys of scene.toml: package.py inserts it, generated from runtime/scene/scene.schema.json.

export interface ParticleSystemOptions {
    /** The collider, if the scene names none. */
    collider?: Collider;
    /** The world, if the scene names no collider. Its file name in the scene is "world/world.json". */
    world?: World;
    /** The scene; missing keys have defaults. A string is the text of a scene.toml, which must name its colliders. */
    scene?: Scene | string;
    /** The files that the scene names, keyed by their paths in the scene. */
    files?: Record<string, Collider | Uint8Array | string>;
    /** Whether the collider shades particles; false is faster. Default true. */
    shaded?: boolean;
    /** Called with one line for each collider of a streamed world that fails to load. Default: console.warn(). */
    onWarning?: (line: string) => void;
    /**
     * Called by step() with the hits (new contacts with a surface) of each step, in order. Hits arrive two steps late,
     * so that the CPU does not wait for the GPU.
     */
    onHits?: (hits: StepHits) => void;
    /** Minimum normal speed of reported hits. Default 0. */
    minHitSpeed?: number;
}

export interface StepHits {
    /** Number of the step since the system was created or restarted, from 1. */
    step: number;
    /** Time at the end of the step, in seconds. */
    time: number;
    /** Number of events lost because the step had more than 262,144; some of them may be hits. */
    dropped: number;
    /**
     * 16 numbers per hit: contact position (3), seconds before `time`, velocity before the contact (3), approach speed
     * along the normal, surface normal (3), body (-1: the floor), material (index into info.materials; -1: none), type,
     * 1 if the hit kills the particle or 0, id as in read().
     */
    rows: Float32Array;
}

/** A ball in world space. */
export interface PointOfInterest {
    position: Vec3 | Numbers;
    /** Above 0. */
    radius: number;
}

export interface Birth {
    position: Vec3 | Numbers;
    /** Default 0, 0, 0. */
    velocity?: Vec3 | Numbers;
    /** Seconds; default 1. */
    lifetime?: number;
    /** Index into the scene's types; default 0. */
    type?: number;
}

export interface DrawOptions {
    /** World space to eye space. For a three.js camera: matrixWorldInverse. */
    view: Matrix;
    /** Eye space to clip space; perspective. For a three.js camera: projectionMatrix. */
    projection: Matrix;
    /** Target; null: the canvas. Default: the bound framebuffer. */
    framebuffer?: WebGLFramebuffer | null;
    /** Size of the target in pixels. Default: the size of the canvas, or of the viewport for other framebuffers. */
    width?: number;
    height?: number;
    /** Whether the target stores sRGB values; false: linear, such as a float target for tone mapping. Default true. */
    srgb?: boolean;
}

export interface SystemInfo {
    time: number;
    alive: number;
    born: number;
    died: number;
    /** Number of births rejected because the system was full. */
    rejected: number;
    /** Texels 0 to extent - 1 of the state textures, row by row, may hold a particle. */
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
    /** Whether the scene has `render.meshes` for drawMeshes(). */
    meshes: boolean;
    /** Names of the materials of all colliders; hits refer to them by index. */
    materials: string[];
    /**
     * Null unless the world is streamed: the numbers of colliders requested in full detail, of those loaded and of those
     * that failed to load, and the GPU bytes of everything loaded.
     */
    stream: { requested: number; loaded: number; failed: number; gpu_bytes: number } | null;
    /**
     * The colliders of the scene; `matrix`: object space to world space, column-major. For a deforming collider, `file` is its
     * mesh.
     */
    bodies: { file: string; node: string; deforms: boolean; moves: boolean; matrix: number[] }[];
}

/**
 * A mesh deformed on the GPU, in object space. Item i of a texture is at texel (i & ((1 << shift) - 1), i >> shift).
 */
export interface LiveMesh {
    /** Float texture: xyz of each vertex. */
    positions: WebGLTexture;
    vertexShift: number;
    /** Unsigned integer texture: the three vertex indices of each triangle. */
    corners: WebGLTexture;
    triangleShift: number;
    triangles: number;
}

/** Particles in a WebGL2 context. All functions restore the state of the context. */
export class ParticleSystem {
    constructor(gl: WebGL2RenderingContext, options: ParticleSystemOptions);
    readonly info: SystemInfo;
    /**
     * Advances the simulation.
     * @param dt  seconds, 0 to 1 (default: the scene's). In a frame loop, pass Math.min(seconds since last frame, 1 / 30).
     */
    step(dt?: number): void;
    /** Draws the particles over the contents of the target, tested against its depth buffer. Writes no depth. */
    draw(options: DrawOptions): void;
    /**
     * Draws the meshes of the scene's `render.meshes` (from the option `files`) with their colours and
     * `render.weather`, like the pictures of relief-sim. Call it before draw(). Overwrites the colour and depth of the
     * target, and draws the sky as background. Adds the footprints made since the last call. Characters are drawn in the
     * poses of their clips.
     */
    drawMeshes(options: DrawOptions): void;
    /**
     * Queues births in addition to those of the emitters. A flat list has 8 numbers per birth: position, velocity,
     * lifetime, type. Returns the number accepted.
     */
    spawn(births: readonly Birth[] | Numbers): number;
    /**
     * Changes part of a scene that was given as an object, except capacity and integrator. Only the pose and the clip
     * of a collider can change: `set({ collider: { position, axis, angle } })`, or a list with one entry per collider,
     * {} for no change. Call it before each step while a collider moves; the collider pushes particles on its way. A
     * single collider can move only if the scene gave it a pose, such as `collider: { position: [0, 0, 0] }`; a body of
     * a world, only if the scene names its node, as in `collider: [{ node: "door" }]`.
     */
    set(patch: Scene): void;
    /**
     * Sets additional points around which a streamed world has full detail, besides the emitters and the camera of
     * draw(). Replaces the previous points. Takes effect with the next step.
     */
    setPointsOfInterest(points: readonly PointOfInterest[]): void;
    /**
     * Resolves when all requested colliders of a streamed world are loaded or have failed. Useful before the first step.
     */
    loaded(): Promise<void>;
    /** Restarts without particles, and retries failed loads. Call it after 'webglcontextrestored', too. */
    restart(): void;
    /**
     * Reads the particles back, which waits for the GPU. 12 numbers each: position, age, velocity, lifetime, type,
     * steps in contact, contact in the last step, id.
     */
    read(): Float32Array;
    /** Returns the state textures for your own shaders. They are owned by the system and differ after each step. */
    textures(): { position: WebGLTexture; velocity: WebGLTexture; birth: WebGLTexture };
    /** Returns the current mesh of a deforming body, owned by the system; null for other bodies. */
    mesh(body: number): LiveMesh | null;
    /**
     * Describes the animation of a body whose collider has `play`; null for other bodies. Joints are those of the glTF
     * skin, or the node of a mesh without a skin.
     */
    animation(body: number): { clips: { name: string; duration: number }[]; joints: string[]; weights: number } | null;
    /**
     * Sets the pose of a body that plays a clip, from the next step on. Without `joints`, the clip continues. The pose
     * may not exceed the extent of the clips, scaled by `play.bounds_scale`.
     * @param joints  glTF joint matrices, column-major, one per joint. For a three.js skeleton: boneMatrices, multiplied
     *                by the mesh's bindMatrix on the right and bindMatrixInverse on the left.
     * @param weights  one weight per morph target.
     */
    pose(body: number, joints?: Numbers, weights?: Numbers): void;
    dispose(): void;
}

export const Relief: {
    init: typeof init;
    load: typeof load;
    loadWorld: typeof loadWorld;
    streamWorld: typeof streamWorld;
    Collider: typeof Collider;
    GpuCollider: typeof GpuCollider;
    ParticleSystem: typeof ParticleSystem;
    ReliefError: typeof ReliefError;
    World: typeof World;
};
export default Relief;

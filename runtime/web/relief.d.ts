// SPDX-License-Identifier: Apache-2.0
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

/** Fetches and reads a world.json of `relief bake LEVEL --world`, and the containers that it names, from beside it. */
export function loadWorld(source: string | URL | Request | Response): Promise<World>;

export interface StreamOptions {
    /** How far from emitters, from the eye of draw() and from points of near() a world has full detail: world units, above 0. */
    radius: number;
    /** Megabytes of the GPU that the colliders of a system may take, the coarse ones included. Default 256. */
    memory?: number;
}

export interface WorldSource extends StreamOptions {
    /**
     * Brings a container, named as in world.json; it may be any bytes, which are compared with the world's hash. Called again
     * where one has made room for others in between. The signal aborts when no system waits for it any more.
     */
    load(file: string, signal: AbortSignal): Promise<Uint8Array> | Uint8Array;
}

/**
 * As loadWorld(), for worlds that are too large: of each collider that has a coarse container it fetches that one only. A
 * ParticleSystem fetches the others when its emitters, the eye of its pictures or near() come near, up to six at a time, and
 * copies 128 kB a step to the GPU.
 */
export function streamWorld(source: string | URL | Request | Response, options: StreamOptions): Promise<World>;

export interface Bounds {
    min: Vec3;
    max: Vec3;
}

/** A collider at n points. */
export interface Answers {
    /** n: to the surface, below 0 inside. About 1e30 or beyond where a point is outside, and no more is known. */
    distance: Float32Array;
    /** 3 n: of the surface, outwards; 0 where there is none. */
    normal: Float32Array;
    /** n: the map that decides; -1 where none votes. */
    map: Int32Array;
}

export interface MapInfo {
    /** float, fixed8, front-back, cube or patches. */
    format: string;
    encoding: string;
    compare: string;
    decode: string;
    /** local: of patches, each with an axis of its own. */
    projection: "orthographic" | "cube" | "local";
    /** Texels; those of patches only lie in rows, and have no place. */
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
    /** On the CPU. @param points 3 n numbers. */
    query(points: Numbers): Answers;
    /**
     * The texels of a map, 8 numbers each: depth and normal of the front, then of the back; a depth of NaN where nothing
     * is. Row y = 0 comes first, the faces of a cube one after the other. A map of patches has a tree instead.
     */
    texels(map: number): Float32Array;
    /** The tree of a map of patches: two words a texel, low and high, as "Patches" of the container's description has them. */
    tree(map: number): Uint32Array;
    dispose(): void;
}

/** A world at n points. */
export interface WorldAnswers {
    /** n: the least of all bodies, in world units; as that of Answers. */
    distance: Float32Array;
    /** 3 n: of the surface, outwards, in the world; 0 where there is none. */
    normal: Float32Array;
    /** n: the body that decides; -1 where none votes. */
    body: Int32Array;
}

export interface WorldBody {
    /** Index of its collider. */
    collider: number;
    /** Name of its node in the level; may be empty. */
    node: string;
    position: Vec3;
    /** A unit quaternion x, y, z, w. */
    rotation: [number, number, number, number];
    scale: number;
    restitution: number;
    friction: number;
}

/** A level in memory: placed bodies. It needs no WebGL; systems made of it keep what they need of it. */
export class World {
    /**
     * @param files world.json and the containers, by the names it has for them; kept. init() must have ended.
     * @param stream for a world that is streamed, whose files are the coarse containers, and others of colliders without one
     */
    constructor(files: Record<string, Collider | Uint8Array | string>, stream?: WorldSource);
    readonly files: Record<string, Collider | Uint8Array | string>;
    readonly unit: string;
    readonly colliders: { file: string; hash: string; gpu_bytes: number; mesh: string; min: Vec3; max: Vec3;
                          coarse?: { file: string; hash: string; gpu_bytes: number } }[];
    readonly bodies: WorldBody[];
    /** Null: all of it is there in full detail. */
    readonly stream: WorldSource | null;
    /** The box that holds all bodies. */
    readonly bounds: Bounds;
    /** On the CPU, where the file places the bodies; of a world that is streamed the coarse ones. Takes time by their number. @param points 3 n numbers. */
    query(points: Numbers): WorldAnswers;
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
    /** Tells a linked program its three samplers (units `unit` to `unit` + 2) and its uniform block. Once is enough. */
    attach(program: WebGLProgram, unit?: number, block?: number): void;
    /**
     * Before a draw with that program: binds three textures to units `unit` to `unit` + 2, and a buffer to the uniform
     * block binding `block`. It leaves them bound, on purpose; it is all in this package that changes a context's state.
     */
    bind(unit?: number, block?: number): void;
    dispose(): void;
}

// Scene, with the keys of scene.toml: package.py puts it here, made of runtime/scene/scene.schema.json.

export interface ParticleSystemOptions {
    /** The one collider of a scene that names none. */
    collider?: Collider;
    /** The world of a scene that names none, in place of a collider; as a file it is "world/world.json". */
    world?: World;
    /** Defaults for whatever it leaves out. As text it is scene.toml itself, and names its colliders. */
    scene?: Scene | string;
    /** The files that the scene names, by their paths in it. */
    files?: Record<string, Collider | Uint8Array | string>;
    /** False: the collider casts no shade on particles, which is cheaper. */
    shaded?: boolean;
    /** Takes a line for each collider of a world that is streamed that cannot be loaded, once. Default: console.warn(). */
    warn?: (line: string) => void;
    /**
     * Takes the hits of each step, new contacts with a surface, in the order of steps. step() calls it, two steps late, so that
     * nothing waits for the GPU.
     */
    hits?: (hits: StepHits) => void;
    /** Hits that approach the surface slower are left out. Default 0. */
    hitSpeed?: number;
}

export interface StepHits {
    /** From 1; since the system began or was restarted. */
    step: number;
    /** Its end, in seconds. */
    time: number;
    /** Events beyond the 262,144 that a step has room for, some of which were hits. */
    dropped: number;
    /**
     * 16 numbers each: position of the contact; seconds before `time`; velocity that it came with; speed of approach along the
     * normal; the surface's normal; body (-1: the floor); material (index into info.materials; -1: none); type; 1 where the
     * particle dies of it, else 0; id, as read() has it.
     */
    rows: Float32Array;
}

/** A ball in the world. */
export interface PointOfInterest {
    position: Vec3 | Numbers;
    /** Above 0. */
    radius: number;
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
    /** Whether the scene has `render.meshes`, which drawMeshes() draws. */
    meshes: boolean;
    /** Names of the materials of all colliders, which hits number. */
    materials: string[];
    /**
     * Of a world that is streamed, else null: colliders wanted in full detail, those of them that are there, those that cannot
     * be loaded, and the bytes of all that is there.
     */
    stream: { wanted: number; present: number; failed: number; gpu_bytes: number } | null;
    /** The scene's colliders, each where it stands now: object to world, by columns. One that deforms names its mesh. */
    bodies: { file: string; node: string; deforms: boolean; moves: boolean; matrix: number[] }[];
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
    /**
     * Before draw(): the colliders by the meshes that the scene's `render.meshes` names, files of the option `files`, in their
     * colours and under `render.weather`, as relief-sim's pictures show them. Fills the target's colour, where there is no mesh
     * with the sky, and its depth. Footprints are those since the last call, or the beginning. Figures are as their clips have them.
     */
    drawMeshes(options: DrawOptions): void;
    /** Births on top of the emitters'. Also 8 numbers each: position, velocity, lifetime, type. Returns how many found room. */
    spawn(births: readonly Birth[] | Numbers): number;
    /**
     * Changes a part of a scene given as an object; not its capacity or integrator, and of its colliders only the pose and the clip:
     * `set({ collider: { position, axis, angle } })`, or a list with one for each of several, {} for those that stay. Before
     * each step of a collider that moves: it pushes what it meets on its way there. A single collider moves if the scene gave it
     * a pose from the beginning, such as `collider: { position: [0, 0, 0] }`; a body of a world, if the scene named its node, as
     * in `collider: [{ node: "door" }]`.
     */
    set(patch: Scene): void;
    /**
     * Places beside the emitters and the eye of draw() where a world that is streamed has full detail, from the next step on, in
     * place of those before.
     */
    near(points: readonly PointOfInterest[]): void;
    /** Waits until all that is wanted now of a world that is streamed is there or has failed; before a first step, say. */
    loaded(): Promise<void>;
    /** Starts over with nothing alive, and asks again for what could not be loaded; also after 'webglcontextrestored'. */
    restart(): void;
    /** The particles, 12 numbers each: position, age, velocity, lifetime, type, steps in contact, contact, id. Waits for the GPU. */
    read(): Float32Array;
    /** The state, for one's own shaders; other textures after each step. They belong to the system. */
    textures(): { position: WebGLTexture; velocity: WebGLTexture; birth: WebGLTexture };
    /** The mesh of a body that deforms, as it is now; null of one that does not. It belongs to the system. */
    mesh(body: number): LiveMesh | null;
    /** Of a body that plays a clip (`play` of its collider), else null. Joints are glTF's, or the node of a mesh without a skin. */
    animation(body: number): { clips: { name: string; seconds: number }[]; joints: string[]; weights: number } | null;
    /**
     * A pose of one's own for a body that plays a clip, from the next step on; without joints its clip again. It may take up as much
     * space as the clips do, times `room` of `play`.
     * @param joints  a matrix each, by columns: glTF's joint matrices. Of a three.js skeleton: boneMatrices, with the mesh's
     *                bindMatrix and bindMatrixInverse about them.
     * @param weights  of the morph targets, as many as there are.
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

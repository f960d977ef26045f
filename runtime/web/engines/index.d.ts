// SPDX-License-Identifier: Apache-2.0
// A collider for other engines, without WebAssembly: reads a container, evaluates it on the CPU, and exports the collision
// function as shader source. Lengths are in object units; distances are positive outside.

/** Three numbers that a function writes: an array, or a Float32Array. */
export type WritableVec3 = [number, number, number] | number[] | Float32Array;
export type Vec3 = readonly [number, number, number] | readonly number[] | Float32Array;

/**
 * A collider with a single patch map, the default of `relief bake`. An animated collider is in its rest pose. Materials
 * are ignored. The buffers are for upload; do not change them.
 */
export interface Collider {
    /** The uniform block ReliefCollider in the layout std140: 80 bytes. `floats` and `integers` are views of it. */
    readonly constants: ArrayBuffer;
    /** 16 floats: row_x, row_y, row_z and size of ReliefCollider, four each; as a mat4, its columns. */
    readonly floats: Float32Array;
    /** Four integers: place of ReliefCollider. */
    readonly integers: Int32Array;
    /** The texture, RGBA16UI: four words per texel, row by row. Sample it without filtering. */
    readonly texels: Uint16Array;
    /** The same bytes in 32-bit words. */
    readonly words: Uint32Array;
    /** Texels: always 2048. */
    readonly width: number;
    /** Texels: 1 to 8192. WebGPU guarantees 8192; WebGL2 supports gl.getParameter(gl.MAX_TEXTURE_SIZE). */
    readonly height: number;
    /** The box of the mesh. */
    readonly bounds: { readonly min: readonly number[]; readonly max: readonly number[] };
    /** The unit of length, such as "m"; "" if the mesh has none. */
    readonly unit: string;
}

export interface OpenOptions {
    /**
     * Decompresses a zstd frame of known size: (packed, size) => fzstd.decompress(packed, new Uint8Array(size)). Only for
     * `relief bake --compress`. Its result is checked, but only this function detects a malformed frame whose checksum is
     * correct.
     */
    decompress?: (packed: Uint8Array, size: number) => Uint8Array;
}

/**
 * Reads a `.relief` container. The result owns its memory.
 * @throws Error with a one-line message if the bytes are damaged, have another version, or are not a single patch map
 */
export function openCollider(bytes: ArrayBuffer | ArrayBufferView, options?: OpenOptions): Collider;

/**
 * Returns the signed distance of a point from the surface, the same float as the C++ library; 1e30 outside the cells.
 * @param normal  is set to the normal: outwards, of unit length; 0 outside the cells
 */
export function distance(collider: Collider, point: Vec3, normal?: WritableVec3): number;

export interface CollideOptions {
    /** Radius of the particle, at least 0 (default: 0). */
    radius?: number;
    /** Fraction of the normal velocity that is kept, 0 to 1 (default: 0). */
    restitution?: number;
    /** Fraction of the tangential velocity that is lost, 0 to 1 (default: 0). With restitution 0: 0 slides, 1 sticks. */
    friction?: number;
    /** Is set to the normal of the surface that was hit, or to 0. */
    normal?: WritableVec3;
}

/**
 * Moves a particle that overlaps the collider to its surface, and reflects its velocity: reliefCollide() on the CPU.
 * @param position  after the step; changed if the particle hits
 * @param velocity  likewise
 * @returns the distance minus the radius: negative if the particle hit
 */
export function collide(collider: Collider, position: WritableVec3, velocity: WritableVec3, options?: CollideOptions): number;

/** shaders/engines/relief.glsl, for GLSL ES 3.00, 3.30 and Vulkan: reliefDistance() and reliefCollide(). */
export const glsl: string;
/** shaders/engines/relief.wgsl, for WebGPU. */
export const wgsl: string;

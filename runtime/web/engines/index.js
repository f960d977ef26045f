// SPDX-License-Identifier: Apache-2.0
// The entry relief-particles/collider: a collider for other engines, without WebAssembly. index.d.ts documents it.
export { openCollider } from "./open.js";
export { collide, distance } from "./patches.js";
export { glsl, wgsl } from "./shaders.js";

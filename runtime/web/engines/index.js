// SPDX-License-Identifier: Apache-2.0
// The entry relief-particles/collider: a collider for other engines, without WebAssembly. index.d.ts documents it.
// The npm package is one file of these modules with the texts of the shaders.
export { openCollider } from "./open.js";
export { collide, distance } from "./patches.js";
export { default as glsl } from "../../../shaders/engines/relief.glsl";
export { default as wgsl } from "../../../shaders/engines/relief.wgsl";

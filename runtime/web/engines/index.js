// SPDX-License-Identifier: Apache-2.0
// The entry relief-particles/collider: a collider for other engines, without WebAssembly. index.d.ts documents it.
// The npm package bundles these modules and the shader sources into one file.
export { openCollider } from "./open.js";
export { collide, distance } from "./patches.js";
export { default as glsl } from "../../../shaders/engines/relief.glsl";
export { default as wgsl } from "../../../shaders/engines/relief.wgsl";

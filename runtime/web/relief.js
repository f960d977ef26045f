// SPDX-License-Identifier: Apache-2.0
// relief-particles: the Relief runtime in a browser. relief.d.ts documents the API.
//
// One WebAssembly instance serves all contexts of a page. Functions that draw or step restore the state of the context.
import { Collider, GpuCollider, load } from "./collider.js";
import { ReliefError } from "./fetch.js";
import { ParticleSystem } from "./particle_system.js";
import { init } from "./wasm.js";
import { World, loadWorld, streamWorld } from "./world.js";

export { init, load, loadWorld, streamWorld, Collider, GpuCollider, ParticleSystem, ReliefError, World };
export const Relief = { init, load, loadWorld, streamWorld, Collider, GpuCollider, ParticleSystem, ReliefError, World };
export default Relief;

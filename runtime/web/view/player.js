// SPDX-License-Identifier: Apache-2.0
// Added to pages that play a scene: relief-particles, which needs WebAssembly.
import * as particles from "relief-particles";

globalThis.reliefParticles = particles;

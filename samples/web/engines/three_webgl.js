// SPDX-License-Identifier: Apache-2.0
// Snow on a bunny: GPUComputationRenderer of three.js moves the particles, and reliefCollide() in GLSL stops them.
import * as THREE from "three";
import { GPUComputationRenderer } from "three/addons/misc/GPUComputationRenderer.js";
import { glsl, openCollider } from "relief-particles/collider";
import { kParticles, lookAt, randomPlaces } from "./snow.js";

// The collider: a texture, and a structure of five vectors.
function colliderUniforms({ texels, width, height, floats, integers }) {
    const image = new THREE.DataTexture(texels, width, height, THREE.RGBAIntegerFormat, THREE.UnsignedShortType);
    image.internalFormat = "RGBA16UI";
    image.needsUpdate = true;
    const row = (at) => new THREE.Vector4(...floats.subarray(at, at + 4));
    const value = { row_x: row(0), row_y: row(4), row_z: row(8), size: row(12), place: new THREE.Vector4(...integers) };
    return { texels: { value: image }, collider: { value } };
}

/** The shader that writes `result` of the motion. */
const moving = (result) => `${glsl}
    uniform highp usampler2D texels;
    uniform ReliefCollider collider;
    uniform float dt;
    void main() {
        vec2 uv = gl_FragCoord.xy / resolution.xy;
        vec3 p = texture2D(places, uv).xyz;
        if (p.y < -1.5) {
            p.y += 4.0; // below the picture: falls again
        }
        vec3 v = texture2D(velocities, uv).xyz;
        v += dt * (vec3(0.0, -3.0, 0.0) - v);
        ReliefMotion motion = reliefCollide(texels, collider, p + dt * v, v, 0.005, 0.2, 0.1);
        gl_FragColor = vec4(motion.${result}, 1.0);
    }`;

const kWidth = 400;

export async function start() {
    const collider = openCollider(await (await fetch("body.relief")).arrayBuffer());
    const renderer = new THREE.WebGLRenderer({ antialias: true, preserveDrawingBuffer: true });
    renderer.setSize(innerWidth, innerHeight);
    document.body.append(renderer.domElement);

    const computation = new GPUComputationRenderer(kWidth, kParticles / kWidth, renderer);
    const dt = { value: 0 };
    const add = (name, result, data) => {
        const image = computation.createTexture();
        image.image.data.set(data);
        const variable = computation.addVariable(name, moving(result), image);
        Object.assign(variable.material.uniforms, colliderUniforms(collider), { dt });
        return variable;
    };
    const variables = [add("places", "position", randomPlaces(collider.bounds, 4)),
                       add("velocities", "velocity", new Float32Array(4 * kParticles))];
    variables.forEach((variable) => computation.setVariableDependencies(variable, variables));
    const fault = computation.init();
    if (fault) {
        throw new Error(fault);
    }

    const geometry = new THREE.BufferGeometry();
    geometry.setAttribute("position", new THREE.BufferAttribute(new Float32Array(3 * kParticles), 3));
    const material = new THREE.ShaderMaterial({
        uniforms: { places: { value: null } },
        vertexShader: `uniform sampler2D places;
            void main() {
                vec3 p = texelFetch(places, ivec2(gl_VertexID % ${kWidth}, gl_VertexID / ${kWidth}), 0).xyz;
                gl_Position = projectionMatrix * viewMatrix * vec4(p, 1.0);
                gl_PointSize = 1.0;
            }`,
        fragmentShader: "void main() { gl_FragColor = vec4(0.75, 0.84, 0.92, 1.0); }",
    });
    const snow = new THREE.Points(geometry, material);
    snow.frustumCulled = false;
    const scene = new THREE.Scene();
    scene.background = new THREE.Color(0x22303c);
    scene.add(snow);
    const camera = lookAt(THREE);

    const target = () => computation.getCurrentRenderTarget(variables[0]);
    return {
        collider,
        step: (seconds) => {
            dt.value = seconds;
            computation.compute();
        },
        draw: () => {
            material.uniforms.places.value = target().texture;
            renderer.render(scene, camera);
        },
        /** Four floats for each particle: its place, 1. */
        read: async () => {
            const places = new Float32Array(4 * kParticles);
            await renderer.readRenderTargetPixelsAsync(target(), 0, 0, kWidth, kParticles / kWidth, places);
            return places;
        },
    };
}

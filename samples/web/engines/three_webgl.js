// SPDX-License-Identifier: Apache-2.0
// Snow on a bunny: GPUComputationRenderer of three.js moves the particles, and reliefCollide() in GLSL stops them.
import * as THREE from "three";
import { GPUComputationRenderer } from "three/addons/misc/GPUComputationRenderer.js";
import { glsl, openCollider } from "relief-particles/collider";
import { cameraOf, kParticles, randomPlaces, sceneOf } from "./snow.js";

// The collider: a texture, a matrix and a vector.
function colliderUniforms({ texels, width, height, floats, integers }) {
    const image = new THREE.DataTexture(texels, width, height, THREE.RGBAIntegerFormat, THREE.UnsignedShortType);
    image.needsUpdate = true;
    return { texels: { value: image }, rows: { value: floats }, place: { value: integers } };
}

/** The shader that writes `result` of the motion. */
const moving = (result) => `${glsl}
    uniform highp usampler2D texels;
    uniform mat4 rows;
    uniform ivec4 place;
    uniform vec4 snow;
    uniform float dt;
    void main() {
        vec2 uv = gl_FragCoord.xy / resolution.xy;
        vec3 v = mix(texture2D(velocities, uv).xyz, vec3(0.0, -snow.z, 0.0), dt);
        vec3 p = texture2D(places, uv).xyz + dt * v;
        p.y += p.y < snow.x ? snow.y : 0.0; // falls again
        ReliefCollider collider = ReliefCollider(rows[0], rows[1], rows[2], rows[3], place);
        ReliefMotion motion = reliefCollide(texels, collider, p, v, snow.w, 0.2, 0.1);
        gl_FragColor = vec4(motion.${result}, 1.0);
    }`;

export async function start() {
    const kWidth = 400; // of the textures of particles
    const collider = openCollider(await (await fetch(new URL("body.relief", import.meta.url))).arrayBuffer());
    const renderer = new THREE.WebGLRenderer({ antialias: true, preserveDrawingBuffer: true });
    renderer.setSize(innerWidth, innerHeight);
    document.body.append(renderer.domElement);

    const computation = new GPUComputationRenderer(kWidth, kParticles / kWidth, renderer);
    const scene = sceneOf(collider.bounds);
    const snow = { value: new THREE.Vector4(scene.top - scene.height, scene.height, scene.speed, scene.radius) };
    const dt = { value: 0 };
    const add = (name, result, data) => {
        const image = computation.createTexture();
        image.image.data.set(data);
        const variable = computation.addVariable(name, moving(result), image);
        Object.assign(variable.material.uniforms, colliderUniforms(collider), { snow, dt });
        return variable;
    };
    const variables = [add("places", "position", randomPlaces(collider.bounds)),
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
    const flakes = new THREE.Points(geometry, material);
    flakes.frustumCulled = false;
    const picture = new THREE.Scene();
    picture.background = new THREE.Color(0x22303c);
    picture.add(flakes);
    const camera = cameraOf(THREE, scene);

    const target = () => computation.getCurrentRenderTarget(variables[0]);
    return {
        collider,
        step: (seconds) => {
            dt.value = seconds;
            computation.compute();
        },
        draw: () => {
            material.uniforms.places.value = target().texture;
            renderer.render(picture, camera);
        },
        /** Four floats for each particle: its position, and 1. */
        read: async () => {
            const places = new Float32Array(4 * kParticles);
            await renderer.readRenderTargetPixelsAsync(target(), 0, 0, kWidth, kParticles / kWidth, places);
            return places;
        },
    };
}

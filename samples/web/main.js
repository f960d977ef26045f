// SPDX-License-Identifier: Apache-2.0
// Relief's snow in a three.js scene: it settles on a three.js mesh, and both are depth-tested against each other.
import * as THREE from "three";
import { OBJLoader } from "three/addons/loaders/OBJLoader.js";
import { OrbitControls } from "three/addons/controls/OrbitControls.js";
import { ParticleSystem, Relief, ReliefError } from "relief-particles";

const note = document.getElementById("note");

function makeScene(body, bounds) {
    const scene = new THREE.Scene();
    scene.background = new THREE.Color(0xb9c6d3);
    scene.add(new THREE.HemisphereLight(0xdfeaf5, 0x8d8577, 1.4));
    const size = bounds.max.map((to, i) => to - bounds.min[i]);
    const side = Math.max(...size);
    const sun = new THREE.DirectionalLight(0xfff1dd, 2.4);
    sun.position.set(1.2 * side, 2.2 * side, 1.4 * side);
    sun.castShadow = true;
    sun.shadow.mapSize.set(2048, 2048);
    Object.assign(sun.shadow.camera, { left: -2 * side, right: 2 * side, top: 2 * side, bottom: -2 * side, far: 6 * side });
    sun.shadow.normalBias = 0.01 * side;
    scene.add(sun);

    const add = (geometry, color, x, y, z) => {
        const mesh = new THREE.Mesh(geometry, new THREE.MeshStandardMaterial({ color, roughness: 0.85 }));
        mesh.position.set(x, y, z);
        mesh.castShadow = mesh.receiveShadow = true;
        scene.add(mesh);
        return mesh;
    };
    const [x, , z] = [0, 1, 2].map((i) => 0.5 * (bounds.min[i] + bounds.max[i]));
    const floor = add(new THREE.CircleGeometry(6 * side, 64), 0x9fb0a4, x, bounds.min[1], z);
    floor.rotation.x = -Math.PI / 2;
    const box = add(new THREE.BoxGeometry(0.3 * side, 0.8 * side, 0.3 * side), 0xb5523b,
                    x + 0.75 * side, bounds.min[1] + 0.4 * side, z + 0.45 * side);
    add(new THREE.TorusKnotGeometry(0.16 * side, 0.05 * side, 128, 24), 0x3b6ea5,
        x - 0.85 * side, bounds.min[1] + 0.3 * side, z + 0.2 * side);
    body.traverse((part) => {
        if (part.isMesh) {
            part.geometry.deleteAttribute("normal"); // smoother than the normals of the file
            part.geometry.computeVertexNormals();
            part.material = new THREE.MeshStandardMaterial({ color: 0xc9b79c, roughness: 0.7 });
            part.castShadow = part.receiveShadow = true;
        }
    });
    scene.add(body);
    return { scene, box, side, center: new THREE.Vector3(x, bounds.min[1] + 0.45 * size[1], z) };
}

async function run() {
    const [collider, body] = await Promise.all([Relief.load("body.relief"), new OBJLoader().loadAsync("body.obj")]);
    const renderer = new THREE.WebGLRenderer({ antialias: true, preserveDrawingBuffer: location.hash === "#test" });
    renderer.shadowMap.enabled = true;
    renderer.toneMapping = THREE.ACESFilmicToneMapping;
    document.body.append(renderer.domElement);

    const { scene, box, side, center } = makeScene(body, collider.bounds);
    const camera = new THREE.PerspectiveCamera(35, 1, 0.02 * side, 40 * side);
    camera.position.set(center.x + 1.6 * side, center.y + 0.7 * side, center.z + 2.8 * side);
    const controls = new OrbitControls(camera, renderer.domElement);
    controls.target.copy(center);
    controls.enableDamping = true;
    controls.maxPolarAngle = 0.49 * Math.PI;

    const system = new ParticleSystem(renderer.getContext(), {
        collider,
        scene: {
            particles: { capacity: 40000 },
            emitter: { rate: 6000, lifetime: [5, 6] },
            forces: { gravity: [0, -1.2 * side, 0], drag: 2.5 },
            type: [{ radius: 0.004 * side, on_collision: "stop" }],
            render: { point_size: 0.014 * side },
        },
    });

    const resize = () => {
        renderer.setPixelRatio(Math.min(devicePixelRatio, 2));
        renderer.setSize(innerWidth, innerHeight);
        camera.aspect = innerWidth / innerHeight;
        camera.updateProjectionMatrix();
    };
    addEventListener("resize", resize);
    resize();

    const draw = () => {
        controls.update();
        renderer.render(scene, camera);
        system.draw({ view: camera.matrixWorldInverse, projection: camera.projectionMatrix });
    };
    // After a lost context, three.js restores its own state; the particles start again.
    renderer.domElement.addEventListener("webglcontextrestored", () => system.restart());
    let before = performance.now();
    const frame = (now) => {
        if (!renderer.getContext().isContextLost()) {
            system.step(Math.min(Math.max(now - before, 0) / 1000, 1 / 30));
            draw();
        }
        before = now;
    };
    if (location.hash !== "#test") { // tests call step and draw themselves
        renderer.setAnimationLoop(frame);
    }
    note.textContent = "Drag to turn, scroll to zoom.";
    return { THREE, renderer, camera, controls, scene, box, center, side, system, draw };
}

run().then(
    (sample) => (window.sample = sample),
    (error) => {
        note.textContent = error instanceof ReliefError ? error.message : `The page cannot start: ${error.message}`;
    },
);

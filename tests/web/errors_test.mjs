// SPDX-License-Identifier: Apache-2.0
// Invalid calls throw a ReliefError with one sentence that names the cause. All other objects stay usable.
import assert from "node:assert/strict";
import { readFileSync, writeFileSync } from "node:fs";
import path from "node:path";
import test from "node:test";

import { bakeCube } from "./lib/boxes.mjs";
import { libraryPage } from "./lib/library.mjs";
import { run, scratch } from "./lib/native.mjs";

// Code (with a collider, gpu and system created for each), and the expected message.
const kErrors = {
    // loading
    "relief.load('/files/nothing.relief')": /nothing\.relief: the server returned 404/,
    "relief.load('/page.html')": /page\.html: the server sent a web page instead of a collider/,
    "relief.load('http://127.0.0.1:1/a.relief')": /a\.relief: the server does not respond/,
    "relief.load('/files/noise.relief')": /noise\.relief: .*(not|no) /,
    "relief.load('/files/cut.relief')": /cut\.relief: /,
    "relief.load(new ArrayBuffer(0))": /./,
    "relief.load()": /load\(\) needs a URL/,
    "relief.load(7)": /load\(\) needs a URL/,
    "new relief.Collider('text')": /Uint8Array/,
    // contexts
    "new relief.ParticleSystem(null, { collider })": /no WebGL2 context/,
    "new relief.ParticleSystem(document.createElement('canvas').getContext('webgl'), { collider })": /WebGL2 context/,
    "new relief.ParticleSystem(document.createElement('canvas').getContext('2d'), { collider })": /WebGL2 context/,
    "new relief.GpuCollider(gl)": /needs a Collider/,
    "new relief.GpuCollider(gl, relief.load('/files/cube.relief'))": /forget to await/,
    // options and scenes
    "new relief.ParticleSystem(gl)": /the option 'collider'/,
    "new relief.ParticleSystem(gl, { colider: collider })": /no option 'colider'/,
    "new relief.ParticleSystem(gl, { collider: 'cube.relief' })": /needs a Collider/,
    "new relief.ParticleSystem(gl, { collider, scene: { particels: {} } })": /^scene: unknown table 'particels'; did you mean/,
    "new relief.ParticleSystem(gl, { collider, scene: { emitter: { rate: '3' } } })": /^scene: emitter.rate must be a number/,
    "new relief.ParticleSystem(gl, { collider, scene: { emitter: { velocity: [0, , 0] } } })": /^scene: emitter.velocity must be a number/,
    "new relief.ParticleSystem(gl, { collider, scene: { emitter: [{}, { rate: -1 }] } })": /^scene: emitter.rate = -1 is out of range/,
    "new relief.ParticleSystem(gl, { collider, scene: { particles: { 'my key': 1 } } })": /my key/,
    "new relief.ParticleSystem(gl, { collider, scene: { forces: { gravity: [0, NaN, 0] } } })": /^scene: forces.gravity must be a number/,
    "new relief.ParticleSystem(gl, { collider, scene: { emitter: { rate: () => 3 } } })": /a scene can contain numbers/,
    "new relief.ParticleSystem(gl, { collider, scene: { particles: { capacity: 2e7 } } })": /capacity.*16777216/,
    "new relief.ParticleSystem(gl, { collider, scene: 'capacity = 3' })": /pass it in 'files'/,
    "new relief.ParticleSystem(gl, { scene: '[collider]\\nfile = \"other.relief\"' })": /other\.relief/,
    "new relief.ParticleSystem(gl, { scene: '[collider' })": /scene\.toml:1/,
    "new relief.ParticleSystem(gl, { scene: { collider: { file: '../../etc/passwd' } } })": /passwd/,
    "new relief.ParticleSystem(gl, { collider, files: { '../x': '' } })": /'\.\.\/x' is outside/,
    "new relief.ParticleSystem(gl, { collider, files: { x: 3 } })": /the file 'x' must be/,
    "new relief.ParticleSystem(gl, { collider, scene: { flow: { raw: 'a.raw', size: [1, 1, 1], box_min: [0, 0, 0], box_max: [1, 1, 1] } }, files: { 'a.raw': 'x' } })":
        /'a\.raw' has 1 bytes/,
    // stepping and drawing
    "system.step(NaN)": /step\(NaN\)/,
    "system.step(-1)": /step\(-1\)/,
    "system.step(7)": /step\(7\).*Math\.min/,
    "system.step('1')": /step\("1"\)/,
    "system.draw()": /view: 16 numbers/,
    "system.draw({ view: eye })": /projection: 16 numbers/,
    "system.draw({ view: eye, projection: eye.slice(1) })": /projection: 16 numbers/,
    "system.draw({ view: eye, projection: eye.map(() => NaN) })": /projection: number 0 is NaN/,
    "system.draw({ view: eye, projection: eye, width: -3 })": /the width is -3/,
    "system.spawn([{ velocity: [0, 0, 0] }])": /birth 0 needs a position/,
    "system.spawn([1, 2, 3])": /births: the number of values, 3, is not a multiple of 8/,
    "system.spawn([{ position: [0, NaN, 0] }])": /births: number 1 is NaN/,
    "system.spawn([{ position: [0, 0, 0], lifetime: 0 }])": /birth 0 needs .* lifetime above 0/,
    "system.spawn([{ position: [0, 0, 0], type: -1 }])": /birth 0: there is no type -1/,
    "system.spawn(3)": /births must be an array/,
    "system.set(3)": /set\(\) takes a part of a scene/,
    "system.set({ forces: { gravitation: 3 } })": /^scene: unknown key 'forces.gravitation'/,
    "system.set({ particles: { capacity: 4096 } })": /create a new system/,
    // queries
    "collider.query([1, 2])": /points: the number of values, 2, is not a multiple of 3/,
    "collider.query()": /points must be an array/,
    "collider.query([1, NaN, 2])": /points: number 1 is NaN/,
    "collider.query([1, 2, Infinity])": /points: number 2 is Infinity/,
    "collider.texels(99)": /no map 99/,
    "collider.texels('0')": /no map 0/,
    "relief.load('/files/patches.relief').then((one) => one.texels(0))": /map 0 contains patches/,
    "collider.tree(0)": /map 0 has no tree, because its format is front-back/,
    "gpu.attach(null)": /linked WebGLProgram/,
    "gpu.bind(1000)": /no texture unit 1000/,
    "gpu.bind(0, -1)": /no uniform block binding -1/,
    // disposed objects
    "(collider.dispose(), collider.query([0, 0, 0]))": /this collider has been disposed of/,
    "(collider.dispose(), new relief.GpuCollider(gl, collider))": /this collider has been disposed of/,
    "(collider.dispose(), new relief.ParticleSystem(gl, { collider }))": /this collider has been disposed of/,
    "(gpu.dispose(), gpu.dispose(), gpu.attach(null))": /this GpuCollider has been disposed of/,
    "(gpu.dispose(), gpu.bind())": /this GpuCollider has been disposed of/,
    "(system.dispose(), system.dispose(), system.step())": /this system has been disposed of/,
    "(system.dispose(), system.draw({ view: eye, projection: eye }))": /this system has been disposed of/,
    "(system.dispose(), system.restart())": /this system has been disposed of/,
    "(system.dispose(), system.info)": /this system has been disposed of/,
};

test("each error has its message", { timeout: 60_000 }, async (t) => {
    const folder = scratch(t);
    bakeCube(folder);
    run("relief", "bake", path.join(folder, "cube.obj"), "-q", "-o", path.join(folder, "patches.relief"), "--map", "patches:budget=4kB");
    const whole = readFileSync(path.join(folder, "cube.relief"));
    writeFileSync(path.join(folder, "cut.relief"), whole.subarray(0, 9000));
    writeFileSync(path.join(folder, "noise.relief"), whole.map((byte, i) => (byte * 31 + i) & 255));
    const { page, messages } = await libraryPage(t, folder);
    const answers = await page.evaluate(async (errors) => {
        const eye = [1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1];
        const answers = {};
        for (const error of errors) {
            const collider = await relief.load("/files/cube.relief");
            const gpu = new relief.GpuCollider(gl, collider);
            const system = new relief.ParticleSystem(gl, { collider, scene: { particles: { capacity: 256 } } });
            try {
                await new Function("relief", "collider", "gpu", "system", "eye", `return ${error};`)(
                    relief, collider, gpu, system, eye);
                answers[error] = ["nothing", "no error"];
            } catch (thrown) {
                answers[error] = [thrown instanceof relief.ReliefError ? "ReliefError" : thrown.name, thrown.message];
            }
            gpu.dispose();
            system.dispose();
            collider.dispose();
        }
        const collider = await relief.load("/files/cube.relief");
        const system = new relief.ParticleSystem(gl, { collider });
        system.step(0);
        system.step();
        return { answers, error: gl.getError(), alive: system.info.alive, time: system.info.time };
    }, Object.keys(kErrors));
    for (const [error, expected] of Object.entries(kErrors)) {
        const [name, message] = answers.answers[error];
        t.diagnostic(`${error}: ${message}`);
        assert.equal(name, "ReliefError", `${error}: ${message}`);
        assert.match(message, expected, error);
        assert.ok(message.length < 240 && !/\n|\/scene\d/.test(message), `${error}: ${message}`);
    }
    assert.equal(answers.error, 0, "a GL error");
    assert.ok(answers.alive > 0 && answers.time > 0, "afterwards everything works");
    const expected = /Failed to load resource|net::ERR_CONNECTION_REFUSED|^failed: http:\/\/127.0.0.1:1\/|ERR_UNSAFE_PORT/;
    assert.deepEqual(messages.filter((line) => !expected.test(line)), []);
});

// SPDX-License-Identifier: Apache-2.0
// The native tools, with which the browser is compared.
import assert from "node:assert/strict";
import { execFileSync } from "node:child_process";
import { mkdtempSync, readFileSync, rmSync, writeFileSync } from "node:fs";
import { tmpdir } from "node:os";
import path from "node:path";

import { root } from "./browser.mjs";

export const bin = process.env.RELIEF_BIN ?? path.join(root, "build/release/bin");
export const bunny = "/usr/share/glmark2/models/bunny.obj";

/** Runs relief or relief-sim. @returns its standard output */
export function run(tool, ...words) {
    return execFileSync(path.join(bin, tool), words, { encoding: "utf8", maxBuffer: 1 << 28 });
}

/** A folder that is removed at the end of the test. */
export function scratch(t) {
    const folder = mkdtempSync(path.join(tmpdir(), "relief-web-"));
    t.after(() => rmSync(folder, { recursive: true, force: true }));
    return folder;
}

/** The tables of a scene as TOML. */
export const tomlOf = (tables) => Object.entries(tables).map(([table, keys]) =>
    `[${table}]\n${Object.entries(keys).map(([key, value]) => `${key} = ${JSON.stringify(value)}\n`).join("")}`).join("");

/** Plays a scene in a folder. words: options of relief-sim. @returns { place, age } of the final particles, by id */
export function play(folder, scene, ...words) {
    writeFileSync(path.join(folder, "scene.toml"), scene);
    run("relief-sim", path.join(folder, "scene.toml"), "-q", "--dump", path.join(folder, "final.ply"), ...words);
    const bytes = readFileSync(path.join(folder, "final.ply"));
    const particles = new Map();
    for (let at = bytes.indexOf("end_header\n") + "end_header\n".length; at < bytes.length; at += 40) {
        const number = (k) => bytes.readFloatLE(at + 4 * k);
        particles.set(bytes.readUInt32LE(at + 32), { place: [number(0), number(1), number(2)], age: number(6) });
    }
    return particles;
}

/** Distances of a page's particles, from ParticleSystem.read(), to those of relief-sim. */
export function distances(rows, native) {
    assert.equal(rows.length / 12, native.size);
    return Array.from({ length: native.size }, (_, i) => {
        const [id, place] = [rows[12 * i + 11], rows.slice(12 * i, 12 * i + 3)];
        assert.ok(native.has(id), `relief-sim has no particle ${id}`);
        return Math.hypot(...native.get(id).place.map((x, k) => x - place[k]));
    });
}

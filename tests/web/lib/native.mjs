// The native tools, which the browser is compared with.
import { execFileSync } from "node:child_process";
import { mkdtempSync, rmSync } from "node:fs";
import { tmpdir } from "node:os";
import path from "node:path";

import { root } from "./browser.mjs";

export const bin = process.env.RELIEF_BIN ?? path.join(root, "build/release/bin");
export const bunny = "/usr/share/glmark2/models/bunny.obj";

/** relief or relief-sim; its standard output. */
export function run(tool, ...words) {
    return execFileSync(path.join(bin, tool), words, { encoding: "utf8", maxBuffer: 1 << 28 });
}

/** A folder that goes with the test. */
export function scratch(t) {
    const folder = mkdtempSync(path.join(tmpdir(), "relief-web-"));
    t.after(() => rmSync(folder, { recursive: true, force: true }));
    return folder;
}

/** Numbers in 0…1, the same in every run (mulberry32). */
export function generator(seed) {
    let state = seed;
    return () => {
        state = (state + 0x6d2b79f5) | 0;
        let t = Math.imul(state ^ (state >>> 15), 1 | state);
        t = (t + Math.imul(t ^ (t >>> 7), 61 | t)) ^ t;
        return ((t ^ (t >>> 14)) >>> 0) / 4294967296;
    };
}

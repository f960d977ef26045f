// SPDX-License-Identifier: Apache-2.0
// The picture of a collider shows all of it, compared with rays that sample the CPU's maps step by step. Sheets and
// struts are thinner than a grid could resolve, in every format.
import assert from "node:assert/strict";
import { writeFileSync } from "node:fs";
import path from "node:path";
import test from "node:test";

import { boxes } from "./lib/boxes.mjs";
import { bunny, run, scratch } from "./lib/native.mjs";
import { keptDepths, scenePage, viewer } from "./lib/view.mjs";

/** A point rotated by `turn` degrees about an oblique axis. */
function turned([x, y, z], turn) {
    const [c, s] = [Math.cos(turn * Math.PI / 180), Math.sin(turn * Math.PI / 180)];
    const [u, v] = [c * x - s * y, s * x + c * y];
    return [u, c * v - s * z, s * v + c * z];
}

/** Boxes [x0, y0, z0, x1, y1, z1] as an OBJ file, rotated. */
const obj = (list, turn) => boxes(list.map((box) => ({ low: box.slice(0, 3), high: box.slice(3) })), (corner) => turned(corner, turn));

// A table of plates 0.4 % thick, and a tower of struts: legs 0.8 % wide, seven floors.
const plates = [[-1, 0, -1, 1, 0.008, 1], [-1, 0.5, -0.2, 1, 0.508, 1], [-0.004, 0, -1, 0.004, 0.5, 1]];
const struts = [
    ...[[-0.5, -0.5], [0.5, -0.5], [-0.5, 0.5], [0.5, 0.5]].map(([x, z]) => [x - 0.008, -1, z - 0.008, x + 0.008, 1, z + 0.008]),
    ...[-1, -0.7, -0.4, -0.1, 0.2, 0.5, 0.8].flatMap((y) => [[-0.5, y, -0.508, 0.5, y + 0.016, -0.492],
                                                              [-0.5, y, 0.492, 0.5, y + 0.016, 0.508],
                                                              [-0.508, y, -0.5, -0.492, y + 0.016, 0.5],
                                                              [0.492, y, -0.5, 0.508, y + 0.016, 0.5]])];
// Both sides in one cell: a plate 0.1 % thick, and an air gap of 0.2 % between two blocks, seen from its opening.
const plate = [[-1, -0.001, -0.7, 1, 0.001, 0.7]];
const gap = [[-1, 0.002, -0.7, 1, 0.3, 0.7], [-1, -0.3, -0.7, 1, -0.002, 0.7]];
const mouth = [[0.15, 0.03, 0.9], [0, 0, 0.65]].map((place) => turned(place, 25));
const square = "v -1 0 -1\nv 1 0.3 -1\nv 1 0.3 1\nv -1 0 1\nf 4 3 2 1\n";

/** Runs in the page. Compares rays through pixels in the picture and on the CPU. */
async function compare([columns, rows, steps, places]) {
    const { view, camera, body, look } = reliefView;
    look.floor = null;
    document.getElementById("sheets").hidden = true;
    Object.assign(camera, { yaw: 0.6, pitch: 0.32 }); // instead of the scene's camera
    camera.frame(body.box, reliefView.panel.room());
    if (places) {
        camera.look(...places);
    }
    view.dirty = true;
    const { error } = reliefView.pixelsNow();
    const { width, height } = view.kept;
    const depths = keptDepths(reliefView);

    const { view: V, projection: P, eye } = camera.matrices(width, height);
    const { min, max, longest } = body.box;
    const answer = { error, rays: 0, drawn: 0, seen: 0, holes: 0, nothing: 0 };
    for (let r = 0; r < rows; ++r) {
        const tries = [];
        const points = [];
        for (let c = 0; c < columns; ++c) {
            const px = Math.floor((c + 0.5) * width / columns);
            const py = Math.floor((r + 0.5) * height / rows);
            const x = (2 * (px + 0.5) / width - 1 + P[8]) / P[0];
            const y = (2 * (py + 0.5) / height - 1 + P[9]) / P[5];
            const d = [0, 1, 2].map((k) => x * V[4 * k] + y * V[4 * k + 1] - V[4 * k + 2]);
            let [from, to] = [0, Infinity];
            for (let k = 0; k < 3; ++k) {
                const [a, b] = [min[k], max[k]].map((v) => (v - eye[k]) / d[k]);
                from = Math.max(from, Math.min(a, b));
                to = Math.min(to, Math.max(a, b));
            }
            const z = 2 * depths[py * width + px] - 1;
            const drawn = z < 1 - 1e-6 ? P[14] / (z + P[10]) : Infinity;
            if (!(from < to)) {
                continue;
            }
            const l = Math.hypot(...d);
            const at = Array.from({ length: steps }, (_, i) => from + (i + 0.5) / steps * (to - from));
            tries.push({ at, drawn, slack: 2e-3 * longest / l });
            at.forEach((t) => points.push(...[0, 1, 2].map((k) => eye[k] + t * d[k])));
            // Also 5 × 5 × 5 points around the drawn position.
            for (let i = 0; i < 125 && drawn < Infinity; ++i) {
                points.push(...[0, 1, 2].map((k) => eye[k] + drawn * d[k] + (Math.floor(i / 5 ** k) % 5 - 2) * 1.5e-4 * longest));
            }
        }
        const { distance, map } = body.collider.query(Float32Array.from(points));
        let i = 0;
        const inside = (least = 0) => (map[i] >= 0 && distance[i] < -least ? ++i : (++i, 0)) > 0;
        // The picture's rays pass through a box whose corners the rasterizer rounds to subpixels: they may miss just
        // beyond an outline.
        const least = 5e-5 * longest;
        for (const { at, drawn, slack } of tries) {
            const first = at.map((t) => (inside(least) ? t : Infinity)).reduce((a, b) => Math.min(a, b), Infinity);
            const around = Array.from({ length: drawn < Infinity ? 125 : 0 }, () => inside()).some(Boolean);
            answer.rays += 1;
            answer.drawn += drawn < Infinity;
            answer.seen += first < Infinity;
            answer.holes += first < Infinity && drawn > first + slack; // inside, but drawn farther away or not at all
            answer.nothing += drawn < Infinity && !around;
        }
    }
    return answer;
}

test("every sheet and strut of a collider is drawn, and nothing else", { timeout: 300_000 }, async (t) => {
    const folder = scratch(t);
    const at = (name) => path.join(folder, name);
    writeFileSync(at("plates.obj"), obj(plates, 17));
    writeFileSync(at("struts.obj"), obj(struts, 8));
    writeFileSync(at("plate.obj"), obj(plate, 25));
    writeFileSync(at("gap.obj"), obj(gap, 25));
    writeFileSync(at("square.obj"), square);
    const cases = {
        "plates, planes": ["plates.obj", "--map", "front-back:dir=-x", "--map", "front-back:dir=-y", "--resolution", "128", "--as", "solid"],
        "plates, the paper's": ["plates.obj", "--paper", "--resolution", "256"],
        "struts, planes": ["struts.obj", "--map", "front-back:dir=-z", "--map", "front-back:dir=1/2/3", "--resolution", "192", "--as", "solid"],
        "an open sheet": ["square.obj", "--map", "front-back:dir=-y", "--resolution", "64", "--thickness", "0.003"],
        "bunny, cubes": [bunny, "--map", "cube:size=96"],
        "a thin plate, pairs": ["plate.obj", "--budget", "60kB", "--as", "solid"],
        "a narrow gap, pairs": ["gap.obj", "--budget", "100kB", "--as", "solid"],
        "plates, patches": ["plates.obj", "--map", "patches:budget=200kB", "--as", "solid"],
        "struts, patches": ["struts.obj", "--map", "patches:budget=400kB", "--as", "solid"],
        "an open sheet, patches": ["square.obj", "--map", "patches:budget=60kB", "--thickness", "0.02"],
        "bunny, few patches": [bunny, "--map", "patches:budget=20kB"],
        "bunny, patches among maps": [bunny, "--map", "patches:budget=40kB", "--map", "cube:size=48", "--map", "front-back:dir=+x,size=64"],
    };
    const open = await viewer(t);
    for (const [name, [mesh, ...options]] of Object.entries(cases)) {
        run("relief", "bake", mesh === bunny ? bunny : at(mesh), "-q", "-o", at("c.relief"), ...options);
        const { page, messages, close } = await open(scenePage(folder, at("c.relief")), { viewport: { width: 300, height: 260 } });
        await page.evaluate(`window.keptDepths = ${keptDepths}`);
        const found = await page.evaluate(compare, [50, 44, 500, mesh === "gap.obj" ? mouth : null]);
        t.diagnostic(`${name}: ${JSON.stringify(found)}`);
        assert.equal(found.error, 0, name);
        assert.ok(found.seen > 20, `${name}: ${found.seen} rays hit it`);
        assert.equal(found.holes, 0, `${name}: ${found.holes} of ${found.seen} rays pass through the collider`);
        assert.equal(found.nothing, 0, `${name}: ${found.nothing} of ${found.drawn} drawn points are not on the collider`);
        assert.deepEqual(messages, []);
        await close();
    }
});

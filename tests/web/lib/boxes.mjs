// SPDX-License-Identifier: Apache-2.0
// Boxes as OBJ text, and the smallest body, for tests that do not depend on the collider.
import { writeFileSync } from "node:fs";
import path from "node:path";

import { run } from "./native.mjs";

const kSides = [[0, 2, 3, 1], [4, 5, 7, 6], [0, 1, 5, 4], [2, 6, 7, 3], [0, 4, 6, 2], [1, 3, 7, 5]];

/** Each box has corners `low` and `high`, an optional `name` of its object, and an optional `color` of its vertices. */
export function boxes(list, placed = (corner) => corner) {
    return list.map(({ low, high, name, color = [] }, n) => {
        const corners = Array.from({ length: 8 }, (_, i) => placed([0, 1, 2].map((k) => ((i >> k) & 1 ? high : low)[k])));
        return (name ? `o ${name}\n` : "") + corners.map((corner) => `v ${[...corner, ...color].join(" ")}\n`).join("") +
            kSides.map((side) => `f ${side.map((i) => 8 * n + i + 1).join(" ")}\n`).join("");
    }).join("");
}

/** Writes cube.relief to the folder: side 2, centred at the origin, fast to bake. */
export function bakeCube(folder) {
    writeFileSync(path.join(folder, "cube.obj"), boxes([{ low: [-1, -1, -1], high: [1, 1, 1] }]));
    run("relief", "bake", path.join(folder, "cube.obj"), "-q", "-o", path.join(folder, "cube.relief"), "--paper",
        "--resolution", "32");
}

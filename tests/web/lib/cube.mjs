// The smallest body for tests that are not about the collider: a cube of side 2 about the origin, baked in an instant.
import { writeFileSync } from "node:fs";
import path from "node:path";

import { run } from "./native.mjs";

const kCube = `v -1 -1 -1
v 1 -1 -1
v 1 1 -1
v -1 1 -1
v -1 -1 1
v 1 -1 1
v 1 1 1
v -1 1 1
f 1 4 3 2
f 5 6 7 8
f 1 2 6 5
f 3 4 8 7
f 2 3 7 6
f 1 5 8 4
`;

/** Leaves cube.relief in the folder. */
export function bakeCube(folder) {
    writeFileSync(path.join(folder, "cube.obj"), kCube);
    run("relief", "bake", path.join(folder, "cube.obj"), "-q", "-o", path.join(folder, "cube.relief"), "--paper",
        "--resolution", "32");
}

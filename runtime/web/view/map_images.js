// SPDX-License-Identifier: Apache-2.0
// Pictures and titles of maps.
import { levelCss } from "./colors.js";
import { treeOf, visitLeaves } from "./patches.js";

const kSide = 144; // pixels of a picture's longer side
const kShades = 64; // shades of a colour, by depth

/** Returns the colours of leaves: one row per level, from far to near. */
function leafColors(index, levels) {
    const canvas = new OffscreenCanvas(kShades, levels + 1);
    const context = canvas.getContext("2d");
    for (let level = 0; level <= levels; ++level) {
        for (let shade = 0; shade < kShades; ++shade) {
            context.fillStyle = levelCss(index, level / Math.max(levels, 1), 0.45 + 0.55 * shade / (kShades - 1));
            context.fillRect(shade, level, 1, 1);
        }
    }
    return context.getImageData(0, 0, kShades, levels + 1).data;
}

/** Draws the cells of a patch map, seen along its −z axis. */
function drawPatches(canvas, collider, index) {
    const tree = treeOf(collider, index);
    const { roots, levels } = tree;
    const per_root = kSide / Math.max(roots[0], roots[1]);
    canvas.width = Math.max(1, Math.round(roots[0] * per_root));
    canvas.height = Math.max(1, Math.round(roots[1] * per_root));
    const nearest = new Float32Array(canvas.width * canvas.height).fill(-1);
    const level_of = new Uint8Array(nearest.length);
    visitLeaves(tree, (kind, [x, y, z], size, level) => {
        const [left, right, low, high] = [x, x + size, y, y + size].map((v) => v * per_root);
        for (let row = Math.floor(low); kind === "patch" && row < Math.min(high, canvas.height); ++row) {
            for (let column = Math.floor(left); column < Math.min(right, canvas.width); ++column) {
                const at = (canvas.height - 1 - row) * canvas.width + column;
                if (z + size > nearest[at]) {
                    nearest[at] = z + size;
                    level_of[at] = level;
                }
            }
        }
    });
    const colors = leafColors(index, levels);
    const context = canvas.getContext("2d");
    const image = context.createImageData(canvas.width, canvas.height);
    nearest.forEach((z, at) => {
        const shade = Math.round((kShades - 1) * Math.max(z, 0) / roots[2]);
        const from = 4 * (kShades * level_of[at] + shade);
        image.data.set(z < 0 ? [0, 0, 0, 0] : colors.subarray(from, from + 4), 4 * at);
    });
    context.putImageData(image, 0, 0);
}

/** Draws the depths of a map to a canvas. */
export function drawMap(canvas, collider, index) {
    if (collider.info.maps[index].projection === "local") {
        drawPatches(canvas, collider, index);
        return;
    }
    const { width, height, faces } = collider.info.maps[index];
    const texels = collider.texels(index);
    const [columns, rows] = faces === 6 ? [3, 2] : [1, 1];
    const shrink = Math.max(1, Math.max(width * columns, height * rows) / kSide);
    canvas.width = Math.max(1, Math.round(width * columns / shrink));
    canvas.height = Math.max(1, Math.round(height * rows / shrink));
    const depths = texels.filter((v, i) => i % 4 === 0 && !Number.isNaN(v));
    const low = depths.reduce((a, b) => Math.min(a, b), Infinity);
    const span = Math.max(depths.reduce((a, b) => Math.max(a, b), -Infinity) - low, 1e-9);
    const context = canvas.getContext("2d");
    const image = context.createImageData(canvas.width, canvas.height);
    for (let y = 0; y < canvas.height; ++y) {
        for (let x = 0; x < canvas.width; ++x) {
            const tx = Math.min(Math.floor((x + 0.5) * width * columns / canvas.width), width * columns - 1);
            const ty = Math.min(Math.floor((y + 0.5) * height * rows / canvas.height), height * rows - 1);
            const face = Math.floor(ty / height) * columns + Math.floor(tx / width);
            // Rows of an orthographic map go up; rows of cube faces go down.
            const row = faces === 6 ? ty % height : height - 1 - ty;
            const at = 8 * ((face * height + row) * width + tx % width);
            const depth = texels[Number.isNaN(texels[at]) ? at + 4 : at];
            const value = 245 - 200 * (depth - low) / span;
            image.data.set(Number.isNaN(depth) ? [0, 0, 0, 0] : [value, value, value, 255], 4 * (y * canvas.width + x));
        }
    }
    context.putImageData(image, 0, 0);
}

export function mapTitle(collider, index) {
    const { width, height, projection, object_to_map: rows, format } = collider.info.maps[index];
    if (projection === "local") {
        const { roots, levels } = treeOf(collider, index);
        return `patches in ${roots.join(" × ")} roots, up to ${levels} levels`;
    }
    const size = `${width} × ${height}`;
    const z = rows[2].slice(0, 3);
    const l = Math.hypot(...z) || 1;
    const axis = z.findIndex((v) => Math.abs(v) > 0.999 * l);
    const direction = axis >= 0 ? `${z[axis] > 0 ? "+" : "−"}${"xyz"[axis]}` : z.map((v) => (v / l).toFixed(2)).join(" / ");
    return projection === "cube" ? `cube, 6 faces of ${size}, ${format}` : `looks ${direction}, ${size}, ${format}`;
}

// The maps as pictures, and where each looks in space.
import { inverseRows } from "./math.js";

const kSide = 144; // pixels of a picture's longer side
const kCubeGrid = [3, 2];

/** Depth in [0, 1] or normals of a map, drawn to a canvas; top up. */
export function drawMap(canvas, collider, index, what) {
    const { width, height, faces } = collider.info.maps[index];
    const texels = collider.texels(index);
    const [columns, rows] = faces === 6 ? kCubeGrid : [1, 1];
    const shrink = Math.max(1, Math.max(width * columns, height * rows) / kSide);
    canvas.width = Math.max(1, Math.round(width * columns / shrink));
    canvas.height = Math.max(1, Math.round(height * rows / shrink));
    const range = depthRange(texels);
    const context = canvas.getContext("2d");
    const image = context.createImageData(canvas.width, canvas.height);
    for (let y = 0; y < canvas.height; ++y) {
        for (let x = 0; x < canvas.width; ++x) {
            const tx = Math.min(Math.floor((x + 0.5) * width * columns / canvas.width), width * columns - 1);
            const ty = Math.min(Math.floor((y + 0.5) * height * rows / canvas.height), height * rows - 1);
            const face = Math.floor(ty / height) * columns + Math.floor(tx / width);
            // The rows of a view go up; those of a cube's faces go down.
            const row = faces === 6 ? ty % height : height - 1 - ty;
            const at = 8 * ((face * height + row) * width + tx % width);
            image.data.set(texelColor(texels, at, what, range), 4 * (y * canvas.width + x));
        }
    }
    context.putImageData(image, 0, 0);
}

function depthRange(texels) {
    let low = Infinity;
    let high = -Infinity;
    for (let i = 0; i < texels.length; i += 4) {
        if (texels[i] === texels[i]) {
            low = Math.min(low, texels[i]);
            high = Math.max(high, texels[i]);
        }
    }
    return [low, Math.max(high - low, 1e-9)];
}

function texelColor(texels, at, what, [low, span]) {
    const from = texels[at] === texels[at] ? at : at + 4;
    if (texels[from] !== texels[from]) {
        return [0, 0, 0, 0];
    }
    if (what === "normals") {
        return [127.5 + 127.5 * texels[from + 1], 127.5 + 127.5 * texels[from + 2], 127.5 + 127.5 * texels[from + 3], 255];
    }
    const value = 245 - 200 * (texels[from] - low) / span;
    return [value, value, value, 255];
}

/** Lines round what a map sees: [from, to]. */
export function frustum(map) {
    const toObject = inverseRows(map.rows);
    const cube = map.projection === "cube";
    const corners = [0, 1, 2, 3, 4, 5, 6, 7].map((i) =>
        toObject([i & 1, (i >> 1) & 1, (i >> 2) & 1].map((v) => (cube ? 2 * v - 1 : v))));
    const lines = [];
    for (let i = 0; i < 8; ++i) {
        for (const bit of [1, 2, 4]) {
            if (!(i & bit)) {
                lines.push([corners[i], corners[i | bit]]);
            }
        }
    }
    if (cube) {
        const eye = toObject([0, 0, 0]);
        corners.forEach((corner) => lines.push([eye, corner]));
    } else {
        lines.push(...arrow(toObject));
    }
    return lines;
}

/** In the middle of the near side, the way the view looks. */
function arrow(toObject) {
    const tip = toObject([0.5, 0.5, 0.3]);
    return [[0.5, 0.5, 0], [0.45, 0.5, 0.22], [0.55, 0.5, 0.22], [0.5, 0.45, 0.22], [0.5, 0.55, 0.22]].map((from) => [toObject(from), tip]);
}

/** Of a unit axis: "+x", or two digits of each. */
function direction(map) {
    const z = map.rows[2].slice(0, 3);
    const l = Math.hypot(...z) || 1;
    const axis = z.findIndex((v) => Math.abs(v) > 0.999 * l);
    return axis >= 0 ? `${z[axis] > 0 ? "+" : "−"}${"xyz"[axis]}` : z.map((v) => (v / l).toFixed(2)).join(" / ");
}

export function mapTitle(map) {
    const size = `${map.width} × ${map.height}`;
    return map.projection === "cube" ? `cube, 6 faces of ${size}` : `looks ${direction(map)}, ${size}`;
}

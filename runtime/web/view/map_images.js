// The maps as pictures, and where each looks in space.

const kSide = 144; // pixels of a picture's longer side

/** The depths of a map, drawn to a canvas; top up. */
export function drawMap(canvas, collider, index) {
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
            // The rows of a view go up; those of a cube's faces go down.
            const row = faces === 6 ? ty % height : height - 1 - ty;
            const at = 8 * ((face * height + row) * width + tx % width);
            const depth = texels[Number.isNaN(texels[at]) ? at + 4 : at];
            const value = 245 - 200 * (depth - low) / span;
            image.data.set(Number.isNaN(depth) ? [0, 0, 0, 0] : [value, value, value, 255], 4 * (y * canvas.width + x));
        }
    }
    context.putImageData(image, 0, 0);
}

export function mapTitle({ width, height, projection, rows }) {
    const size = `${width} × ${height}`;
    const z = rows[2].slice(0, 3);
    const l = Math.hypot(...z) || 1;
    const axis = z.findIndex((v) => Math.abs(v) > 0.999 * l);
    const direction = axis >= 0 ? `${z[axis] > 0 ? "+" : "−"}${"xyz"[axis]}` : z.map((v) => (v / l).toFixed(2)).join(" / ");
    return projection === "cube" ? `cube, 6 faces of ${size}` : `looks ${direction}, ${size}`;
}

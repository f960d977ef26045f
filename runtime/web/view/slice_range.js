// The largest distance that a slice's colours tell apart: as bake/picture/slice_image.cpp has it.
import { quantile } from "./math.js";

const kSide = 96;
const kMargin = 0.1;

export function sliceRange(collider, box, axis, at) {
    const [right, up] = [axis === 0 ? 2 : 0, axis === 1 ? 2 : 1];
    const margin = kMargin * (Math.max(box.size[right], box.size[up]) || 1);
    const points = new Float32Array(3 * kSide * kSide);
    for (let i = 0; i < kSide * kSide; ++i) {
        const place = (k, n) => box.min[k] - margin + (n + 0.5) / kSide * (box.size[k] + 2 * margin);
        points[3 * i + axis] = at;
        points[3 * i + right] = place(right, i % kSide);
        points[3 * i + up] = place(up, Math.floor(i / kSide));
    }
    const { distance, map } = collider.query(points);
    const known = [...distance].filter((d, i) => map[i] >= 0 && Math.abs(d) < 1e29);
    const inside = known.filter((d) => d < 0).map((d) => -d);
    const outside = known.filter((d) => d >= 0);
    const range = Math.max(quantile(inside, 0.995), 0.5 * quantile(outside, 0.9));
    return range > 0 && Number.isFinite(range) ? range : box.longest;
}

// SPDX-License-Identifier: Apache-2.0
// Vectors are arrays of three numbers; matrices are Float32Arrays of 16 numbers, column-major.

export const add = (a, b) => [a[0] + b[0], a[1] + b[1], a[2] + b[2]];
export const sub = (a, b) => [a[0] - b[0], a[1] - b[1], a[2] - b[2]];
export const scale = (a, s) => [a[0] * s, a[1] * s, a[2] * s];
export const dot = (a, b) => a[0] * b[0] + a[1] * b[1] + a[2] * b[2];
export const cross = (a, b) => [a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]];
export const mix = (a, b, t) => [0, 1, 2].map((k) => a[k] + t * (b[k] - a[k]));
export const length = (a) => Math.hypot(a[0], a[1], a[2]);
export const clamp = (v, low, high) => Math.min(Math.max(v, low), high);
export const identity = () => new DOMMatrix().toFloat32Array();
export const multiply = (a, b) => DOMMatrix.fromFloat32Array(a).multiply(DOMMatrix.fromFloat32Array(b)).toFloat32Array();

export function normalize(a) {
    const l = length(a);
    return l > 0 ? scale(a, 1 / l) : [0, 1, 0];
}

/** Inverts a regular matrix by Gauss-Jordan elimination with pivoting; DOMMatrix rejects small determinants in some browsers. */
export function inverse(m) {
    const rows = [0, 1, 2, 3].map((i) => [0, 1, 2, 3, 4, 5, 6, 7].map((c) => (c < 4 ? m[4 * c + i] : Number(c - 4 === i))));
    for (let c = 0; c < 4; ++c) {
        const pivot = rows.reduce((best, row, i) => (i >= c && Math.abs(row[c]) > Math.abs(rows[best][c]) ? i : best), c);
        [rows[c], rows[pivot]] = [rows[pivot], rows[c]];
        rows[c] = rows[c].map((v) => v / rows[c][c]);
        rows.forEach((row, i) => {
            if (i !== c) {
                rows[i] = row.map((v, k) => v - row[c] * rows[c][k]);
            }
        });
    }
    return [0, 1, 2, 3].flatMap((c) => rows.map((row) => row[4 + c]));
}

/** Transforms a point (w = 1); returns four numbers. */
export const transform = (m, p) => [0, 1, 2, 3].map((i) => m[i] * p[0] + m[4 + i] * p[1] + m[8 + i] * p[2] + m[12 + i]);

export function lookAt(eye, target, up) {
    const z = normalize(sub(eye, target));
    const x = normalize(cross(up, z));
    const y = cross(z, x);
    return new Float32Array([x[0], y[0], z[0], 0, x[1], y[1], z[1], 0, x[2], y[2], z[2], 0,
                             -dot(x, eye), -dot(y, eye), -dot(z, eye), 1]);
}

/** fov: vertical, in radians. */
export function perspective(fov, aspect, near, far) {
    const f = 1 / Math.tan(fov / 2);
    return new Float32Array([f / aspect, 0, 0, 0, 0, f, 0, 0, 0, 0, (far + near) / (near - far), -1,
                             0, 0, 2 * far * near / (near - far), 0]);
}

/** Returns bounds with derived values. */
export function boxOf(bounds) {
    const size = sub(bounds.max, bounds.min);
    return {
        min: bounds.min,
        max: bounds.max,
        size,
        center: scale(add(bounds.min, bounds.max), 0.5),
        longest: Math.max(...size) || 1,
        radius: 0.5 * length(size) || 1,
    };
}

export function shortNumber(v) {
    if (Math.abs(v) >= 1000 && Math.abs(v) < 1e7) {
        return Math.round(v).toLocaleString("en").replace("-", "−");
    }
    const text = Math.abs(v) >= 1e7 || (v !== 0 && Math.abs(v) < 1e-4) ? v.toExponential(1) : v.toPrecision(3);
    return (text.includes(".") && !text.includes("e") ? text.replace(/\.?0+$/, "") : text).replace("-", "−");
}

/** unit: of the collider; may be empty. */
export const lengthText = (v, unit) => shortNumber(v) + (unit ? ` ${unit}` : "");

// SPDX-License-Identifier: Apache-2.0
// Reads the data that `relief view` wrote into the page.

export function fromBase64(text, what) {
    try {
        return Uint8Array.from(atob(text), (c) => c.charCodeAt(0));
    } catch {
        throw damaged(`its ${what} cannot be decoded`);
    }
}

export const damaged = (how) => new Error(`this page is damaged: ${how}; create it again with 'relief view' or 'relief-sim --page'`);

/** Returns the decoded data, or null if the page is empty. For a scene, `file` is the collider in the panel. */
export function readPageData() {
    const place = document.getElementById("relief-page-data");
    const format = Number(place?.dataset.format);
    let data;
    try {
        data = JSON.parse(place.textContent);
    } catch {
        throw damaged("its data cannot be read");
    }
    if (data === null) {
        return null;
    }
    if (data.format !== format) {
        throw new Error(`the data of this page has format ${data.format}, but the page needs ${format}; create it again ` +
                        "with tools of one release");
    }
    if (!data.scene) {
        return { ...data, mesh: data.mesh && meshOf(data.mesh) };
    }
    const files = Object.fromEntries(Object.entries(data.files).map(([name, text]) => [name, fromBase64(text, name)]));
    const file = data.shows ?? data.name;
    files[file] ??= fromBase64(data.collider, "collider");
    return { ...data, bytes: files[file].length, file, files };
}

function meshOf(mesh) {
    const [vertices, triangles] = [mesh.vertices, mesh.triangles].map((text) => fromBase64(text, "mesh"));
    if (vertices.length % 12 !== 0 || triangles.length % 12 !== 0) {
        throw damaged("its mesh is truncated");
    }
    const corners = new Uint32Array(triangles.buffer);
    if (corners.some((i) => i >= vertices.length / 12)) {
        throw damaged("its mesh has an invalid vertex index");
    }
    return { vertices: new Float32Array(vertices.buffer), triangles: corners };
}

/** Returns the WebAssembly module of a page that plays a scene, which is stored as gzip in base64. */
export async function readWasm() {
    const packed = fromBase64(document.getElementById("relief-wasm").textContent.trim(), "WebAssembly");
    if (typeof DecompressionStream === "undefined") {
        throw new Error("this browser is too old for this page (no DecompressionStream); use one from 2023 or later");
    }
    const stream = new Blob([packed]).stream().pipeThrough(new DecompressionStream("gzip"));
    return new Uint8Array(await new Response(stream).arrayBuffer());
}

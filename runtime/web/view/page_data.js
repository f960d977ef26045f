// What `relief view` put into the page, and what people drop onto it.

function fromBase64(text) {
    const raw = atob(text);
    const bytes = new Uint8Array(raw.length);
    for (let i = 0; i < raw.length; ++i) {
        bytes[i] = raw.charCodeAt(i);
    }
    return bytes;
}

function decoded(text, what) {
    try {
        return fromBase64(text);
    } catch {
        throw new Error(`this page is damaged: its ${what} cannot be decoded; make the page again with 'relief view'`);
    }
}

/** { name, collider, shows, mesh, check, scene, files, serve } with bytes in place of base64, or null of an empty page. */
export function readPageData() {
    let data;
    try {
        data = JSON.parse(document.getElementById("relief-page-data").textContent);
    } catch {
        throw new Error("this page is damaged: its data cannot be read; make the page again with 'relief view'");
    }
    if (data === null) {
        return null;
    }
    if (data.format !== 2) {
        throw new Error(`this page's data has the format ${data.format}, and the page understands 2; make it again ` +
                              "with the 'relief view' of one release");
    }
    const files = {};
    for (const [name, text] of Object.entries(data.files ?? {})) {
        files[name] = decoded(text, name);
    }
    return {
        ...data,
        collider: data.shows ? files[data.shows] : data.collider ? decoded(data.collider, "collider") : null,
        mesh: data.mesh ? { name: data.mesh.name, ...meshOf(data.mesh) } : null,
        files,
    };
}

function meshOf(mesh) {
    const vertices = decoded(mesh.vertices, "mesh");
    const triangles = decoded(mesh.triangles, "mesh");
    if (vertices.length % 12 !== 0 || triangles.length % 12 !== 0) {
        throw new Error("this page is damaged: its mesh is cut off; make the page again with 'relief view'");
    }
    const corners = new Uint32Array(triangles.buffer);
    if (corners.some((i) => i >= vertices.length / 12)) {
        throw new Error("this page is damaged: its mesh names a vertex that is not there; make the page again with " +
                              "'relief view'");
    }
    return { vertices: new Float32Array(vertices.buffer), triangles: corners };
}

/** The WebAssembly that the page carries: gzip in base64. */
export async function readWasm() {
    const packed = fromBase64(document.getElementById("relief-wasm").textContent.trim());
    if (typeof DecompressionStream === "undefined") {
        throw new Error("this browser is too old for this page (no DecompressionStream); try one of 2023 or later");
    }
    const stream = new Blob([packed]).stream().pipeThrough(new DecompressionStream("gzip"));
    return new Uint8Array(await new Response(stream).arrayBuffer());
}

/** Files dropped on the page, or picked: gives a list to take(). */
export function followDrops(take, hover) {
    let depth = 0;
    const holdsFiles = (event) => [...(event.dataTransfer?.types ?? [])].includes("Files");
    const set = (value) => {
        depth = Math.max(value, 0);
        hover(depth > 0);
    };
    addEventListener("dragenter", (event) => holdsFiles(event) && set(depth + 1));
    addEventListener("dragleave", (event) => holdsFiles(event) && set(depth - 1));
    addEventListener("dragover", (event) => holdsFiles(event) && event.preventDefault());
    addEventListener("drop", (event) => {
        if (holdsFiles(event)) {
            event.preventDefault();
            set(0);
            take([...event.dataTransfer.files]);
        }
    });
}

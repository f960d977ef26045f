// SPDX-License-Identifier: Apache-2.0
// Fetches files for relief.js: colliders, and the containers that a world names. Independent of the WebAssembly module.

export class ReliefError extends Error {
    constructor(message) {
        super(message);
        this.name = "ReliefError";
    }
}

export function check(valid, message) {
    if (!valid) {
        throw new ReliefError(message);
    }
}

/** Fetches a source, or returns it if it already is a Response. */
async function responseOf(source, signal) {
    return source instanceof Response ? source : fetch(source, { signal }).catch((error) => {
        throw new ReliefError(`${source?.url ?? source}: the server does not respond (${error.message})`);
    });
}

/** Returns the bytes of a source; see Source in relief.d.ts. */
export async function bytesOf(source, signal) {
    if (source instanceof Uint8Array) {
        return source;
    }
    if (source instanceof ArrayBuffer || source instanceof Blob) {
        return new Uint8Array(await new Response(source).arrayBuffer());
    }
    check(typeof source === "string" || [URL, Request, Response].some((kind) => source instanceof kind),
          "load() needs a URL, a Response, a Blob, an ArrayBuffer or a Uint8Array");
    const response = await responseOf(source, signal);
    const name = response.url || source;
    check(response.ok, `${name}: the server returned ${response.status} ${response.statusText}`.trim());
    check(!/^text\/html/.test(response.headers.get("content-type")),
          `${name}: the server sent a web page instead of a collider; check the path`);
    return new Uint8Array(await response.arrayBuffer());
}

/**
 * Fetches a world.json and the containers that it names. With `coarse`, fetches the coarse container of each collider
 * that has one. Returns { files, base: the URL of world.json }.
 */
export async function worldFiles(source, coarse) {
    // The containers are relative to the final URL, after redirects.
    const response = await responseOf(source);
    check(response.url,
          "this Response has no URL, so the containers of the world cannot be found; " +
          "pass the files to new World()");
    const base = new URL(response.url);
    const text = await bytesOf(response);
    const files = { "world.json": text };
    const names = namesOf(text, base, coarse);
    const next = names.values();
    // Browsers reject thousands of simultaneous requests.
    await Promise.all(Array.from({ length: 32 }, async () => {
        for (const name of next) {
            files[name] = await bytesOf(urlIn(base, name));
        }
    }));
    return { files, base };
}

/** Running fetches. Results and failures go to a callback. */
export class Fetches {
    #load;
    #stop = new AbortController();
    #running = new Set();

    /** @param load  load(file, signal) returns the bytes of a file. */
    constructor(load) {
        this.#load = load;
    }

    /** Starts a fetch, which ends with done(bytes, null) or done(null, reason); neither is called after stop(). */
    start(file, done) {
        const fetched = this.#run(file, this.#stop.signal, done);
        this.#running.add(fetched);
        fetched.then(() => this.#running.delete(fetched));
    }

    async #run(file, signal, done) {
        let bytes = null;
        let reason = null;
        try {
            bytes = await this.#load(file, signal);
            check(bytes instanceof Uint8Array, `${file}: 'load' returned no Uint8Array`);
        } catch (error) {
            reason = String(error?.message ?? error);
        }
        if (!signal.aborted) {
            done(reason === null ? bytes : null, reason);
        }
    }

    /** Resolves when any fetch has ended. */
    next() {
        return Promise.race(this.#running);
    }

    stop() {
        this.#stop.abort();
        this.#stop = new AbortController();
    }
}

/** Returns the URL of a file in the folder of a world. */
export function urlIn(base, name) {
    return new URL(name.split("/").map(encodeURIComponent).join("/"), base);
}

/** Returns the files that a world names. Only checks that they are in its folder; World validates the rest. */
function namesOf(text, base, coarse) {
    let colliders;
    try {
        ({ colliders } = JSON.parse(new TextDecoder().decode(text)));
    } catch (error) {
        throw new ReliefError(`${base}: not a world.json of 'relief bake --world' (${error.message})`);
    }
    const list = Array.isArray(colliders) ? colliders : [];
    const outside = (name) => typeof name !== "string" || name.split("/").some((part) => ["", ".", ".."].includes(part));
    const wrong = list.findIndex((one) => outside(one?.file) || (coarse && one.coarse && outside(one.coarse.file)));
    check(list.length > 0 && wrong < 0,
          `${base}: not a world.json of 'relief bake --world': ` +
          (wrong >= 0 ? `colliders[${wrong}] names no file in its folder` : "it has no colliders"));
    return [...new Set(list.map((one) => (coarse && one.coarse ? one.coarse.file : one.file)))];
}

// SPDX-License-Identifier: Apache-2.0
// The page of `relief view`, filled as the tool fills it, and opened from disk.
import { readFileSync, writeFileSync } from "node:fs";
import path from "node:path";
import { pathToFileURL } from "node:url";

import { built, launch, openPage } from "./browser.mjs";

const kEmpty = '<script type="application/json" id="relief-page-data">null</script>';

/** Data of a page that shows a collider's bytes. */
export const pageData = (name, bytes, more = {}) =>
    ({ format: 2, name, collider: bytes && Buffer.from(bytes).toString("base64"), shows: null, mesh: null, check: null, scene: null,
       files: null, ...more });

/** Data of a page that `relief view` made. */
export const dataOf = (file) => JSON.parse(/id="relief-page-data">(.*)<\/script>/.exec(readFileSync(file, "utf8"))[1]);

/** Writes the page with that data; its address. data: an object, or text as it is. */
export function writePage(folder, name, data) {
    const template = readFileSync(path.join(built, "bin/view.html"), "utf8");
    const text = typeof data === "string" ? data : JSON.stringify(data).replaceAll("<", "\\u003c");
    const file = path.join(folder, name);
    writeFileSync(file, template.replace(kEmpty, () => kEmpty.replace("null", text)));
    return pathToFileURL(file).href;
}

/** A browser that ends with the test, and what opens pages in it: where nothing falls by itself, but for other options. */
export async function viewer(t, folder, more = []) {
    const browser = await launch(more);
    t.after(() => browser.close());
    return async (data, options = {}) => {
        const opened = await openPage(browser, writePage(folder, "page.html", data), { reducedMotion: "reduce", ...options });
        await opened.page.waitForFunction("window.reliefView?.ready", undefined, { timeout: 60_000 });
        return opened;
    };
}

/** The page in a file, in a browser that ends with the test. */
export async function openFile(t, file, options = {}) {
    const browser = await launch();
    t.after(() => browser.close());
    const opened = await openPage(browser, pathToFileURL(file).href, options);
    await opened.page.waitForFunction("window.reliefView?.ready", undefined, { timeout: 60_000 });
    return opened;
}

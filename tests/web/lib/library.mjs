// SPDX-License-Identifier: Apache-2.0
// A page with the library, as `relief` and `gl`, and with the test's files under /files.
import path from "node:path";

import { launch, modules, openPage, root, serve } from "./browser.mjs";

/** Closes at the end of the test. @returns { page, messages } */
export async function libraryPage(t, files, more = []) {
    const server = await serve({
        "/": path.join(root, "tests/web/lib"),
        "/files": files,
        "/modules": modules,
        "/package": path.join(root, "out/npm"),
    });
    const browser = await launch(more);
    t.after(async () => {
        await browser.close();
        server.close();
    });
    const opened = await openPage(browser, `${server.url}/page.html`);
    await opened.page.waitForFunction("window.ready", undefined, { timeout: 30_000 });
    return opened;
}

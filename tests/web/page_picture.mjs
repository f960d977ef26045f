// SPDX-License-Identifier: Apache-2.0
// Draws the README's picture of the page: node tests/web/page_picture.mjs FILE.jpg, after scripts/build.sh release.
import { mkdtempSync, rmSync } from "node:fs";
import { tmpdir } from "node:os";
import path from "node:path";
import { pathToFileURL } from "node:url";

import { launch, openPage } from "./lib/browser.mjs";
import { bunny, run } from "./lib/native.mjs";

const folder = mkdtempSync(path.join(tmpdir(), "relief-page-"));
const browser = await launch();
try {
    const file = path.join(folder, "bunny.relief");
    run("relief", "bake", bunny, "-q", "-o", file);
    run("relief", "view", file, "--mesh", bunny, "-o", path.join(folder, "page.html"));
    const { page } = await openPage(browser, pathToFileURL(path.join(folder, "page.html")).href,
                                    { viewport: { width: 1440, height: 900 }, colorScheme: "dark" });
    await page.waitForFunction("window.reliefView?.ready && reliefView.body");
    await page.mouse.move(700, 880);
    await page.waitForTimeout(3000);
    await page.screenshot({ path: process.argv[2] ?? "relief_view.jpg", type: "jpeg", quality: 70, timeout: 120_000 });
} finally {
    await browser.close();
    rmSync(folder, { recursive: true });
}

// SPDX-License-Identifier: Apache-2.0
// A real browser for tests: Debian's Chromium, headless, with software WebGL2 (SwiftShader).
import { createServer } from "node:http";
import { readFile } from "node:fs/promises";
import { createRequire } from "node:module";
import path from "node:path";
import { fileURLToPath } from "node:url";

export const root = path.resolve(path.dirname(fileURLToPath(import.meta.url)), "../../..");
export const built = process.env.RELIEF_WEB_BUILD ?? path.join(root, "build/web");
export const modules = path.join(built, "node_modules");
const require = createRequire(path.join(built, "package.json"));
const { chromium } = require("playwright-core");

const kTypes = {
    ".css": "text/css",
    ".html": "text/html; charset=utf-8",
    ".js": "text/javascript",
    ".json": "application/json",
    ".mjs": "text/javascript",
    ".png": "image/png",
    ".svg": "image/svg+xml",
    ".wasm": "application/wasm",
};

/** Serves folders to this machine only: { "/": folder, "/npm": folder }, longest prefix first. */
export async function serve(folders) {
    const mounts = Object.entries(folders).sort(([a], [b]) => b.length - a.length);
    const server = createServer(async (request, response) => {
        const url = decodeURIComponent(new URL(request.url, "http://localhost").pathname);
        const mount = mounts.find(([prefix]) => url === prefix || url.startsWith(prefix.replace(/\/?$/, "/")));
        try {
            if (url === "/favicon.ico") {
                response.writeHead(204).end();
                return;
            }
            const rest = url.slice(mount[0].length).replace(/^\//, "") || "index.html";
            const file = path.join(mount[1], path.normalize(`/${rest}`));
            const bytes = await readFile(file);
            response.writeHead(200, { "content-type": kTypes[path.extname(file)] ?? "application/octet-stream" });
            response.end(bytes);
        } catch {
            response.writeHead(404).end(url);
        }
    });
    await new Promise((done) => server.listen(0, "127.0.0.1", done));
    return { url: `http://127.0.0.1:${server.address().port}`, close: () => server.close() };
}

/** Starts Chromium with the default arguments and `more`. */
export async function launch(more = []) {
    return chromium.launch({
        executablePath: process.env.CHROMIUM ?? "/usr/bin/chromium",
        args: ["--no-sandbox", "--enable-unsafe-swiftshader", "--use-angle=swiftshader", "--disable-dev-shm-usage",
               ...more],
    });
}

/** Messages of a page, without the driver's messages about uploads of drawn maps. */
export const pageMessages = (messages) => messages.filter((line) => !/GL Driver Message .*TexSubImage with unpack buffer/.test(line));

/** A page whose console messages and errors are collected in `messages`, one line each. Its policy applies to playwright too. */
export async function openPage(browser, url, options = {}) {
    const context = await browser.newContext({ viewport: { width: 1000, height: 700 }, bypassCSP: true, ...options });
    const page = await context.newPage();
    page.setDefaultTimeout(120_000); // software rendering on a busy machine is slow
    const messages = [];
    page.on("console", (message) => messages.push(`${message.type()}: ${message.text()}`));
    page.on("pageerror", (error) => messages.push(`error: ${error.message}`));
    page.on("requestfailed", (request) => messages.push(`failed: ${request.url()}`));
    await page.goto(url);
    return { page, messages, close: () => context.close() };
}

import { launch, openPage, built } from "./lib/browser.mjs";
import { pathToFileURL } from "node:url";
const browser = await launch();
const { page, said } = await openPage(browser, pathToFileURL(process.argv[2]).href, { viewport: { width: 900, height: 600 }, reducedMotion: "reduce" });
await page.waitForFunction("window.reliefView?.ready", undefined, { timeout: 60000 });
await page.waitForTimeout(1000);
const t = await page.evaluate(() => {
    const { view, camera, gl } = reliefView;
    const one = (off) => {
        const cells = reliefView.body.cells;
        const times = [];
        for (let i = 0; i < 5; ++i) {
            camera.yaw += 0.3;
            view.dirty = true;
            const before = performance.now();
            view.drawBodies(camera.matrices(900, 600), 900, 600, reliefView.look, false);
            gl.bindFramebuffer(gl.FRAMEBUFFER, view.kept.name);
            gl.readPixels(0, 0, 1, 1, gl.RGBA, gl.UNSIGNED_BYTE, new Uint8Array(4));
            gl.bindFramebuffer(gl.FRAMEBUFFER, null);
            times.push(performance.now() - before);
        }
        return times.map(Math.round);
    };
    const withCells = one();
    const { body } = reliefView;
    const none = new Uint8Array(body.cells.far.length);
    gl.bindTexture(gl.TEXTURE_3D, body.far);
    gl.pixelStorei(gl.UNPACK_ALIGNMENT, 1);
    gl.texSubImage3D(gl.TEXTURE_3D, 0, 0, 0, 0, ...body.cells.n, gl.RED, gl.UNSIGNED_BYTE, none);
    gl.bindTexture(gl.TEXTURE_3D, null);
    const without = one();
    return { withCells, without, n: body.cells.n };
});
console.log(JSON.stringify(t), said);
await browser.close();

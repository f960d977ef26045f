// SPDX-License-Identifier: Apache-2.0
// relief.d.ts and engines.d.ts type-check an example that uses everything, by `tsc --strict`, and declare exactly the
// exports of relief.js and engines.js.
import assert from "node:assert/strict";
import { spawnSync } from "node:child_process";
import { copyFileSync, mkdirSync, readFileSync, symlinkSync, writeFileSync } from "node:fs";
import path from "node:path";
import test from "node:test";

import { modules, root } from "./lib/browser.mjs";
import { scratch } from "./lib/native.mjs";

test("the types compile and are complete", { timeout: 60_000 }, async (t) => {
    const folder = scratch(t);
    mkdirSync(path.join(folder, "node_modules"));
    symlinkSync(path.join(root, "out/npm"), path.join(folder, "node_modules/relief-particles"));
    copyFileSync(path.join(root, "tests/web/types_example.ts"), path.join(folder, "example.ts"));
    writeFileSync(path.join(folder, "package.json"), '{ "type": "module" }');
    const { status, stdout } = spawnSync(process.execPath, [
        path.join(modules, "typescript/bin/tsc"), "--strict", "--noEmit", "--target", "es2022", "--module", "nodenext",
        "--lib", "es2022,dom,dom.iterable", "example.ts"], { cwd: folder, encoding: "utf8" });
    assert.equal(status, 0, stdout);

    const exported = (file) => [...readFileSync(path.join(root, "out/npm", file), "utf8")
        .matchAll(/^export (?:(?:async )?(?:class|function|const) (\w+)|\{ (.*) \})/gm)]
        .flatMap(([, name, names]) => name ?? names.split(", ")).sort();
    assert.deepEqual(exported("relief.d.ts"), exported("relief.js"));
    assert.deepEqual(exported("engines.d.ts"), Object.keys(await import("../../out/npm/engines.js")).sort());
});

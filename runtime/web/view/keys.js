// The keyboard.
import { $, element, say } from "./controls.js";

const kTurn = 0.09;

export function followKeys(app, panel) {
    const toggle = (id) => $(id).click();
    const sliceBy = (by) => panel.setSlice(panel.axis, Math.min(Math.max(Number($("slice-at").value) + by, 0), 1));
    const across = (axis) => panel.setSlice(app.look.slice?.axis === axis ? null : axis);
    const turn = (x, y) => (event) => (event.shiftKey ? app.camera.pan(x * 0.05, y * 0.05) : app.camera.orbit(x * kTurn, y * kTurn));
    const keys = [
        ["← ↑ → ↓", "turn; with Shift: move", { ArrowLeft: turn(1, 0), ArrowRight: turn(-1, 0), ArrowUp: turn(0, 1), ArrowDown: turn(0, -1) }],
        ["+  −", "nearer, farther", { "+": () => app.camera.zoom(0.85), "=": () => app.camera.zoom(0.85),
                                       "-": () => app.camera.zoom(1 / 0.85) }],
        ["F", "frame the body", { f: () => panel.frame() }],
        ["1 2 3", "maps, mesh, split", { 1: () => app.body && panel.setShow("surface"), 2: () => app.mesh && panel.setShow("mesh"),
                                          3: () => app.mesh && app.body && panel.setShow("split") }],
        ["M", "colour by map", { m: () => toggle("tint") }],
        ["E", "heat map of errors", { e: () => toggle("heat") }],
        ["X Y Z", "slice across an axis", { x: () => across(0), y: () => across(1), z: () => across(2) }],
        ["[  ]", "move the slice", { "[": () => sliceBy(-0.02), "]": () => sliceBy(0.02) }],
        ["Space", "pause, play", { " ": () => app.particles?.system && panel.pause() }],
        [".", "one step", { ".": () => panel.step() }],
        ["R", "particles from the beginning", { r: () => panel.restart() }],
        ["O", "open a file", { o: () => toggle("files") }],
        ["P", "fold the panel", { p: () => panel.fold() }],
        ["Esc", "let go of a map or a place", { Escape: () => (say(null), panel.letGo()) }],
        ["?", "this list", { "?": () => $("keys").showModal() }],
    ];
    const gestures = [["Drag", "turn"], ["Shift or right drag", "move"], ["Wheel, pinch", "nearer, farther"]];
    $("key-list").append(...[...gestures, ...keys].flatMap(([name, what]) =>
        [element("dt", {}, element("kbd", {}, name)), element("dd", {}, what)]));
    const table = Object.assign({}, ...keys.map(([, , does]) => does));
    addEventListener("keydown", (event) => {
        const does = table[event.key.length === 1 ? event.key.toLowerCase() : event.key];
        // Controls have the arrows and the space bar for themselves.
        const taken = /^( |Arrow.*)$/.test(event.key) && event.target.closest?.("input, button");
        if (does && app.opened && !taken && !event.ctrlKey && !event.metaKey && !event.altKey && !$("keys").open) {
            event.preventDefault();
            does(event);
        }
    });
}

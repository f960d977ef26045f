// The keyboard.
import { $, element, say } from "./controls.js";

const kTurn = 0.09;

export function followKeys(app, panel) {
    const toggle = (id) => {
        if (!$(id).disabled) {
            $(id).click();
        }
    };
    const sliceBy = (by) => panel.setSlice(panel.axis, Math.min(Math.max(Number($("slice-at").value) + by, 0), 1));
    const across = (axis) => {
        const { slice } = app.look;
        panel.setSlice(slice?.axis === axis ? null : axis);
    };
    const keys = [
        ["← ↑ → ↓", "turn", null],
        ["Shift ← ↑ → ↓", "move", null],
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
        ["O", "open a file", { o: () => $("files").click() }],
        ["T", "dark or light", { t: () => toggle("theme") }],
        ["P", "fold the panel", { p: () => panel.fold() }],
        ["Esc", "let go of a map or a place", { Escape: () => (say(null), panel.dropPin()) }],
        ["?", "this list", { "?": () => $("keys").showModal() }],
    ];
    const gestures = [["Drag", "turn"], ["Shift or right drag", "move"], ["Wheel, pinch", "nearer, farther"]];
    $("key-list").append(...[...gestures, ...keys].flatMap(([name, what]) =>
        [element("dt", {}, element("kbd", {}, name)), element("dd", {}, what)]));
    const table = Object.assign({}, ...keys.map(([, , does]) => does ?? {}));
    addEventListener("keydown", (event) => {
        const inField = event.target.closest?.("input[type=range], textarea, dialog");
        if (event.ctrlKey || event.metaKey || event.altKey || $("keys").open) {
            return;
        }
        const way = { ArrowLeft: [1, 0], ArrowRight: [-1, 0], ArrowUp: [0, 1], ArrowDown: [0, -1] }[event.key];
        if (way && !inField) {
            event.preventDefault();
            if (event.shiftKey) {
                app.camera.pan(way[0] * 0.05, way[1] * 0.05);
            } else {
                app.camera.orbit(way[0] * kTurn, way[1] * kTurn);
            }
            return;
        }
        const onButton = event.target.closest?.("button, input[type=checkbox]");
        if (event.key === " " && onButton) {
            return;
        }
        const does = table[event.key.length === 1 ? event.key.toLowerCase() : event.key];
        if (does && app.opened) {
            event.preventDefault();
            does();
        }
    });
}

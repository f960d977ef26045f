// The panel and the title: what the buttons and sliders do.
import { css, mapColor } from "./colors.js";
import { $, choice, element, fillLegends, linear, powersOfTwo, say, slider } from "./controls.js";
import { drawMap, frustum, mapTitle } from "./map_images.js";
import { add, lengthText, scale, shortNumber } from "./math.js";
import { followKeys } from "./keys.js";
import { sliceRange } from "./slice_range.js";

const narrow = matchMedia("(max-width: 720px)");
// The causes of wrong places, as `relief check` names them to programs.
const kKinds = { sheet: "thin sheet", open: "open mesh", unseen: "no map sees it", silhouette: "behind a silhouette",
                 other: "of another mesh", texel: "finer than a texel" };
const percent = (v) => `${Math.round(100 * v)} %`;

export class Panel {
    #map = -1;
    #picture = "depth";
    #queue = 0;
    #lastTick = 0;
    #heatSeen = false;

    constructor(app) {
        this.app = app;
        fillLegends();
        this.#title();
        this.tabs = choice("tab", (tab) => this.show(tab));
        $("tabs").onclick = () => this.#setFolded(false);
        this.#viewSheet();
        this.#sliceFields();
        choice("picture", (value) => {
            this.#picture = value;
            this.#pictures();
        });
        $("heat").onchange = () => this.#heat();
        this.#particleSheet();
        followKeys(app, this);
    }

    show(tab) {
        this.tabs.show(tab);
        for (const section of $("sheets").children) {
            section.hidden = section.id !== `sheet-${tab}`;
        }
        if (tab === "errors" && !this.#heatSeen && this.app.measured) {
            this.#heatSeen = true;
            $("heat").checked = true;
            this.#heat();
        }
        this.app.changed();
    }

    /** How far the picture's middle moves out from under the panel. */
    shift() {
        const panel = $("panel");
        if (panel.hidden) {
            return [0, 0];
        }
        const box = panel.getBoundingClientRect();
        return narrow.matches ? [0, -box.height / innerHeight * 0.9] : [box.width / innerWidth * 0.9, 0];
    }

    /** What the panel leaves free: the shorter side, in heights of the picture. */
    room() {
        const panel = $("panel").getBoundingClientRect();
        const free = narrow.matches ? [innerWidth, innerHeight - panel.height - $("title").offsetHeight]
            : [innerWidth - panel.width, innerHeight];
        return Math.max(Math.min(...free) / innerHeight, 0.2);
    }

    #title() {
        $("help").onclick = () => $("keys").showModal();
        $("open").onclick = $("pick").onclick = () => $("files").click();
        $("frame").onclick = () => this.frame();
        $("files").onchange = () => {
            const files = [...$("files").files];
            this.app.attempt(() => this.app.openFiles(files)).finally(() => ($("files").value = ""));
        };
        $("fold").onclick = () => this.fold();
        $("message").querySelector("button").onclick = () => say(null);
    }

    fold() {
        this.#setFolded(!$("panel").classList.contains("folded"));
    }

    #setFolded(folded) {
        $("panel").classList.toggle("folded", folded);
        $("fold").setAttribute("aria-expanded", !folded);
        this.app.changed();
    }

    /** A length as this collider counts them. */
    #length(v) {
        return lengthText(v, this.app.body?.collider.info.unit);
    }

    frame() {
        const { camera, look } = this.app;
        if (look.box) {
            camera.frame(look.box, this.room());
        }
    }

    #viewSheet() {
        const { look } = this.app;
        this.showChoice = choice("show", (value) => this.setShow(value));
        $("tint").onchange = () => {
            const tint = $("tint").checked;
            this.selectMap(-1);
            $("tint").checked = tint;
            look.map = tint ? -2 : -1;
        };
        $("floor").onchange = () => this.app.setFloor($("floor").checked);
        $("split-at").oninput = () => {
            look.split = Number($("split-at").value);
            this.app.changed();
        };
    }

    setShow(value) {
        this.app.look.show = value;
        this.showChoice.show(value);
        $("split-at").hidden = value !== "split" || !this.app.mesh || !this.app.body;
        this.app.changed();
    }

    // --- the slice

    #sliceFields() {
        this.axis = 2;
        this.axisChoice = choice("axis", (value) => {
            this.axis = Number(value);
            this.#slice();
        });
        $("slice-on").onchange = () => this.#slice();
        $("slice-at").oninput = () => this.#slice();
    }

    setSlice(axis, share) {
        $("slice-on").checked = axis !== null;
        if (axis !== null) {
            this.axis = axis;
            this.axisChoice.show(String(axis));
            $("slice-at").value = share ?? $("slice-at").value;
        }
        this.#slice();
    }

    #slice() {
        const { look, body } = this.app;
        const on = $("slice-on").checked && Boolean(body);
        $("slice-fields").disabled = !on;
        if (on) {
            const { min, size } = body.box;
            const at = min[this.axis] + Number($("slice-at").value) * size[this.axis];
            // One range for an axis, so that the colours keep their meaning while the slice moves.
            const range = look.slice?.axis === this.axis ? look.slice.range
                : sliceRange(body.collider, body.box, this.axis, min[this.axis] + 0.5 * size[this.axis]);
            look.slice = { axis: this.axis, at, range };
            $("slice-value").textContent = this.#length(at);
            this.#legend("slice", range);
        } else {
            look.slice = null;
        }
        this.app.changed();
    }

    #legend(name, range) {
        $(`${name}-low`).textContent = `${this.#length(-range)} inside`;
        $(`${name}-high`).textContent = `outside ${this.#length(range)}`;
    }

    // --- maps

    #fillMaps() {
        const maps = this.app.body?.collider.info.maps ?? [];
        $("maps").replaceChildren(...maps.map((map, i) => element("button", {
            "aria-pressed": false, "data-map": i, onclick: () => this.selectMap(this.#map === i ? -1 : i),
        }, element("span", { class: "frame" }, element("canvas", { role: "img", "aria-label": `Map ${i}` })),
           element("span", { class: "what" }, element("i", { style: `background:${css(mapColor(i))}` }),
                   element("b", {}, `${i}`), ` ${mapTitle(map)}, ${map.format}`))));
        this.#map = -1;
        this.#pictures();
    }

    /** One after the other, so that the page stays alive however many there are. */
    async #pictures() {
        const turn = ++this.#queue;
        const { body } = this.app;
        for (const button of [...$("maps").children]) {
            if (turn !== this.#queue || body !== this.app.body) {
                return;
            }
            await this.app.attempt(() => drawMap(button.querySelector("canvas"), body.collider, Number(button.dataset.map), this.#picture));
            await new Promise((done) => setTimeout(done));
        }
        this.picturesDone = turn;
    }

    selectMap(i) {
        const { look, view, body } = this.app;
        this.#map = i;
        [...$("maps").children].forEach((button, k) => button.setAttribute("aria-pressed", k === i));
        look.map = i;
        $("tint").checked = false;
        if (i >= 0 && look.show === "mesh") {
            this.setShow("surface");
        }
        if (view && body) {
            view.setLines(i >= 0 ? frustum(body.collider.info.maps[i]) : [], mapColor(i));
        }
        this.app.changed();
    }

    // --- errors

    #heat() {
        const { look, measured } = this.app;
        look.heat = measured && $("heat").checked ? measured.range : 0;
        look.depth = measured?.depth ?? 0;
        this.app.changed();
    }

    #fillErrors() {
        const { measured, body } = this.app;
        $("errors-none").hidden = Boolean(measured);
        $("errors-some").hidden = !measured;
        this.#heatSeen = false;
        $("heat").checked = false;
        $("why").textContent = "";
        this.#heat();
        if (!measured) {
            return;
        }
        const { check } = measured;
        const side = body.box.longest;
        const length = (v) => `${this.#length(v)} (${shortNumber(100 * v / side)} %)`;
        const rows = check ? checkRows(check, length)
            : [["median on the mesh", length(measured.median)], ["mean", length(measured.mean)], ["99 % below", length(measured.p99)]];
        $("measures").replaceChildren(...rows.flatMap(([name, value]) => [element("dt", {}, name), element("dd", {}, value)]));
        $("verdict").className = check?.verdict.grade ?? "ungraded";
        $("verdict").textContent = check?.verdict.text ?? "How far the maps are from the mesh";
        $("parts").textContent = check?.parts.text ?? "";
        $("sheets-note").hidden = measured.depth === 0;
        $("sheets-note").textContent = `Sheets have a thickness of ${this.#length(2 * measured.depth)} round the mesh: ` +
            "white is where they lie in its middle.";
        $("what-to-do").hidden = check?.verdict.grade === "good" || check?.advice.length > 0;
        $("check-command").textContent = `relief check ${this.app.opened.name} --mesh ${this.app.mesh.name} --html check.html`;
        $("advice-title").hidden = !check?.advice.length;
        $("advice").replaceChildren(...(check?.advice ?? []).map(({ command, ...one }) => element("li", {},
            ...(one.tried && !one.helps ? [] : [element("code", {}, command)]), element("p", { class: "hint" }, adviceText(one, check)))));
        this.#legend("heat", measured.range);
        const places = check?.worst_places ?? [];
        $("places-title").hidden = !check;
        $("places-title").textContent = places.length ? "Worst places, by their share of what is wrong" : "No place is wrong";
        $("places").replaceChildren(...places.map((place) => element("li", {}, element("button", {
            onclick: (event) => this.#goTo(place, event.currentTarget),
        }, element("b", {}, `${shortNumber(place.share_percent)} %`), element("span", {}, this.#placeText(place))))));
    }

    #placeText(place) {
        return [`${this.#length(place.size)} across`, kKinds[place.cause], place.map === null ? "no map" : `map ${place.map}`].join(", ");
    }

    #goTo({ position, normal, why }, button) {
        const { camera, view, body } = this.app;
        const side = body.box.longest;
        this.letGo();
        button.setAttribute("aria-current", true);
        camera.lookAt(position, normal, 0.9 * side);
        const arms = [0, 1, 2].map((i) => [0, 0, 0].with(i, 0.02 * side));
        view.setLines([[position, add(position, scale(normal, 0.12 * side))],
                       ...arms.map((arm) => [add(position, arm), add(position, scale(arm, -1))])], [1, 0.75, 0.2]);
        $("why").textContent = why;
    }

    letGo() {
        $("why").textContent = "";
        [...$("places").querySelectorAll("button")].forEach((button) => button.removeAttribute("aria-current"));
        this.selectMap(-1);
    }

    // --- particles

    #particleSheet() {
        const lengths = (v) => this.#length(v * (this.app.look.box?.longest ?? 1));
        const parts = [
            { id: "bounce", name: "Bounce", scale: linear(0, 1), text: percent },
            { id: "friction", name: "Friction", scale: linear(0, 1), text: percent },
            { id: "radius", name: "Radius", scale: linear(0, 0.03), text: lengths },
            { id: "wind", name: "Wind", scale: linear(-1.5, 1.5), text: (v) => (Math.abs(v) < 0.02 ? "0" : `${lengths(v)}/s`) },
            { id: "count", name: "Count", scale: powersOfTwo(1024, 262144), text: (v) => v.toLocaleString("en") },
        ];
        const change = (key) => (value) => {
            this.app.attempt(() => this.app.particles.change({ [key]: value }));
            this.app.changed(false);
        };
        this.sliders = Object.fromEntries(parts.map((part) => [part.id, slider({ ...part, changed: change(part.id) })]));
        $("sliders").append(...Object.values(this.sliders).map((one) => one.label));
        this.presetChoice = choice("preset", (value) => this.app.attempt(() => this.app.startPreset(value)));
        $("pause").onclick = () => this.pause();
        $("step").onclick = () => this.step();
        $("restart").onclick = () => this.restart();
        $("copy").onclick = () => this.copy();
    }

    /** share: of the pixels of each side that are drawn. */
    tellQuality(share) {
        $("quality").hidden = share === 1;
        $("quality").textContent = `Coarser, to keep up: ${percent(share)} of the pixels each way`;
    }

    pause() {
        const { particles } = this.app;
        particles.paused = !particles.paused;
        $("pause").textContent = particles.paused ? "Play" : "Pause";
        this.app.changed(false);
    }

    step() {
        const { particles } = this.app;
        if (!particles.system) {
            return;
        }
        if (!particles.paused) {
            this.pause();
        }
        this.app.attempt(() => particles.step());
        this.app.changed(false);
    }

    restart() {
        this.app.attempt(() => this.app.particles.restart());
        this.app.changed(false);
    }

    async copy() {
        this.copiedText = this.app.particles.system.toToml();
        const told = await navigator.clipboard.writeText(this.copiedText).then(() => "copied", () => "this browser lets no page copy");
        $("copied").textContent = `${told}; save beside ${this.app.opened.file}`;
        setTimeout(() => ($("copied").textContent = ""), 4000);
    }

    refreshParticles() {
        const { particles } = this.app;
        const running = Boolean(particles?.system);
        const free = running && particles.preset !== "scene";
        this.presetChoice.show(running ? particles.preset : "none");
        $("playing").hidden = !running;
        $("sliders").hidden = !free;
        for (const [key, one] of Object.entries(free ? this.sliders : {})) {
            one.show(particles.settings[key]);
        }
        $("scene-note").hidden = free;
        $("scene-note").textContent = running ? "A scene of its own is playing; a preset above takes its place."
            : this.app.body ? "Nothing falls. Choose rain, snow, a fountain or smoke." : "Particles need a collider: drop a .relief here.";
        $("pause").textContent = particles?.paused ? "Play" : "Pause";
        $("alive").textContent = "";
    }

    /** Now and then: how many particles live. */
    tick(now) {
        const { particles } = this.app;
        if (now - this.#lastTick > 250 && particles.system) {
            this.#lastTick = now;
            $("alive").textContent = `${particles.alive.toLocaleString("en")} alive`;
        }
    }

    /** After another file was opened. */
    refresh() {
        const { opened, body, mesh, look } = this.app;
        $("name").textContent = opened?.name ?? "";
        $("facts").textContent = this.app.facts;
        this.showChoice.allow("mesh", Boolean(mesh));
        this.showChoice.allow("split", Boolean(mesh && body));
        this.showChoice.allow("surface", Boolean(body));
        $("slice-on").disabled = !body;
        $("preset").querySelectorAll("input").forEach((one) => (one.disabled = !body));
        this.#fillMaps();
        this.#fillErrors();
        this.setShow(look.show);
        look.split = $("split-at").value = 0.5 - 0.5 * this.shift()[0];
        $("slice-on").checked = false;
        $("tint").checked = false;
        this.#slice();
        this.refreshParticles();
    }
}

/** What `relief check` measured against the mesh that was baked. */
function checkRows({ accuracy: original, repaired, sampling }, length) {
    const accuracy = repaired?.accuracy ?? original;
    const percent = (v) => `${shortNumber(v)} %`;
    const { near, uniform, distance_error: distance, normal_error_degrees: normal } = accuracy;
    return [["called inside near it", percent(near.false_inside_percent)], ["called outside near it", percent(near.false_outside_percent)],
            ["wrong anywhere in the box", percent(uniform.wrong_percent)],
            ["mean error", length(distance.mean)], ["99 % below", length(distance.p99)],
            ["normal, mean", `${shortNumber(normal.mean)}°`], ["normal, 99 % below", `${shortNumber(normal.p99)}°`],
            ["surface that no map sees", percent(accuracy.unseen_area_percent)],
            ["outside without a distance", percent(accuracy.far_percent)], ["no map votes", percent(accuracy.unknown_percent)],
            ["no normal", percent(accuracy.no_normal_percent)],
            ["on the GPU", `${accuracy.gpu_bytes.toLocaleString("en")} bytes`],
            ["points of each kind", sampling.samples.toLocaleString("en")], ["seed", `${sampling.seed}`]];
}

function adviceText({ about, tried, helps, wrong_percent: left, untried }, { verdict }) {
    return !tried ? `${about}; not tried: ${untried}` : helps
        ? `${about}; tried: ${shortNumber(left)} % wrong instead of ${shortNumber(verdict.wrong_percent)} %`
        : `Tried, and of no help: ${about} (${shortNumber(left)} %)`;
}

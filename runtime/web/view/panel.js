// SPDX-License-Identifier: Apache-2.0
// The panel and the title bar.
import { kLegend, mapCss } from "./colors.js";
import { drawMap, mapTitle } from "./map_images.js";
import { lengthText, shortNumber } from "./math.js";

export const $ = (id) => document.getElementById(id);

const narrow = matchMedia("(max-width: 720px)");
// Causes of wrong places, keyed as in the JSON report of `relief check`.
const kCauses = { sheet: "thin sheet", open: "open mesh", unseen: "no map sees it", silhouette: "behind a silhouette",
                 texel: "finer than a texel" };

export function element(tag, attributes = {}, ...children) {
    const { onclick, ...rest } = attributes;
    const made = Object.assign(document.createElement(tag), onclick && { onclick });
    Object.entries(rest).forEach(([key, value]) => made.setAttribute(key, value));
    made.append(...children);
    return made;
}

/** Creates a row of radio buttons. choices: values and labels. Returns a function that selects a value. */
function choice(id, choices, changed) {
    const show = (value) => $(id).querySelectorAll("input").forEach((one) => (one.checked = one.value === value));
    $(id).append(...Object.entries(choices).map(([value, words]) => element("label", { id: `${id}-${value}` },
        element("input", { type: "radio", name: id, value }), element("span", {}, words))));
    $(id).onchange = (event) => changed(event.target.value);
    show(Object.keys(choices)[0]);
    return show;
}

export class Panel {
    #map = -1;
    #lastTick = 0;
    #axis = 2;
    #heatSeen = false;

    constructor(app) {
        this.app = app;
        document.querySelectorAll(".legend > i").forEach((one) => (one.style.background = kLegend));
        this.showTab = choice("tab", { view: "View", maps: "Maps", errors: "Errors", particles: "Particles" }, (tab) => this.show(tab));
        this.showWhat = choice("show", { picture: "Picture", surface: "Maps", mesh: "Mesh", split: "Split" }, (value) => this.setShow(value));
        choice("axis", ["x", "y", "z"], (value) => {
            this.#axis = Number(value);
            this.#slice();
        })(String(this.#axis));
        const when = (id, event, does) => ($(id)[event] = does);
        when("frame", "onclick", () => this.frame());
        when("tint", "onchange", () => this.selectMap($("tint").checked ? -2 : -1));
        when("floor", "onchange", () => app.setFloor($("floor").checked));
        when("split-at", "oninput", () => {
            app.look.split = Number($("split-at").value);
            app.changed();
        });
        when("slice-on", "onchange", () => this.#slice());
        when("slice-at", "oninput", () => this.#slice());
        when("heat", "onchange", () => this.#heat());
        when("pause", "onclick", () => {
            app.particles.paused = !app.particles.paused;
            $("pause").textContent = app.particles.paused ? "Play" : "Pause";
            app.changed(false);
        });
        when("restart", "onclick", () => app.attempt(() => app.restart()));
    }

    show(tab) {
        this.showTab(tab);
        for (const section of $("sheets").children) {
            section.hidden = section.id !== `sheet-${tab}`;
        }
        if (tab === "errors" && this.app.data.mesh && !this.#heatSeen) {
            this.#heatSeen = $("heat").checked = true;
            this.#heat();
        }
        this.app.changed();
    }

    /** Returns the shift that centres the picture in the space beside the panel. */
    shift() {
        const box = $("panel").getBoundingClientRect();
        return narrow.matches ? [0, -box.height / innerHeight * 0.9] : [box.width / innerWidth * 0.9, 0];
    }

    /** Returns the shorter side of the space beside the panel, relative to the picture height. */
    room() {
        const panel = $("panel").getBoundingClientRect();
        const free = narrow.matches ? [innerWidth, innerHeight - panel.height - $("title").offsetHeight]
            : [innerWidth - panel.width, innerHeight];
        return Math.max(Math.min(...free) / innerHeight, 0.2);
    }

    frame() {
        this.app.pin = null;
        this.app.camera.frame(this.app.look.box, this.room());
    }

    /** Formats a length with the unit of the collider. */
    #length(v) {
        return lengthText(v, this.app.body.collider.info.unit);
    }

    /** Enables the picture of a scene that has render.meshes. */
    offerPicture() {
        for (const value of ["picture", "surface", "mesh", "split"]) {
            $(`show-${value}`).hidden = value === "mesh" || value === "split";
        }
        $("show-field").hidden = false;
        this.setShow("picture");
    }

    setShow(value) {
        this.app.look.show = value;
        this.showWhat(value);
        $("split-at").hidden = value !== "split";
        $("floor").parentElement.hidden = value === "picture";
        this.app.changed();
    }

    #slice() {
        const { look, body } = this.app;
        const on = $("slice-on").checked;
        if (on && this.app.look.show === "picture") {
            this.setShow("surface"); // only the surface can be sliced
        }
        const at = body.box.min[this.#axis] + Number($("slice-at").value) * body.box.size[this.#axis];
        const range = 0.1 * body.box.longest;
        look.slice = on ? { axis: this.#axis, at, range } : null;
        $("slice-fields").disabled = !on;
        $("slice-value").textContent = on ? this.#length(at) : "";
        this.#legend("slice", range);
        this.app.changed();
    }

    #legend(name, range) {
        $(`${name}-low`).textContent = `${this.#length(-range)} inside`;
        $(`${name}-high`).textContent = `outside ${this.#length(range)}`;
    }

    // --- maps

    /** Returns the maps to list. Empty if all bodies deform: their maps have texels only while the scene plays. */
    #shownMaps() {
        const { data, body } = this.app;
        return data.scene && !data.shows ? [] : body.collider.info.maps;
    }

    #fillMaps() {
        const { collider } = this.app.body;
        const maps = this.#shownMaps();
        $("patches-note").hidden = !maps.some(({ projection }) => projection === "local");
        $("maps").replaceChildren(...maps.map((_, i) => element("button", {
            "aria-pressed": false, onclick: () => this.selectMap(this.#map === i ? -1 : i),
        }, element("span", { class: "frame" }, element("canvas", { role: "img", "aria-label": `Map ${i}` })),
           element("span", { class: "what" }, element("i", { style: `background:${mapCss(i)}` }),
                   element("b", {}, `${i}`), ` ${mapTitle(collider, i)}`))));
        this.#pictures();
    }

    /** Draws the maps one by one and yields in between, so that the page stays responsive. */
    async #pictures() {
        const { body } = this.app;
        for (const [i, canvas] of [...$("maps").querySelectorAll("canvas")].entries()) {
            if (body === this.app.body) {
                await this.app.attempt(() => drawMap(canvas, body.collider, i));
                await new Promise((done) => setTimeout(done));
            }
        }
        this.picturesDone = true;
    }

    /** i: -1 for none, -2 for all, each in its own colour. */
    selectMap(i) {
        this.#map = this.app.look.map = i;
        [...$("maps").children].forEach((button, k) => button.setAttribute("aria-pressed", k === i));
        $("tint").checked = i === -2;
        if (i !== -1 && ["mesh", "picture"].includes(this.app.look.show)) {
            this.setShow("surface");
        }
        this.app.changed();
    }

    // --- errors

    #heat() {
        const { look, body, data } = this.app;
        const { distance_error: distance } = (data.check.repaired ?? data.check).accuracy;
        const range = Math.max(2 * distance.p99, 1e-3 * body.box.longest);
        look.heat = $("heat").checked ? range : 0;
        // A sheet lies in the middle of its shell: subtract half of the recorded thickness, if any.
        look.depth = 0.5 * Number(/(?:^| )--thickness (?:auto=)?([0-9.e+-]+)/.exec(body.collider.info.provenance.options)?.[1] ?? 0);
        $("sheets-note").textContent = look.depth === 0 ? "" : `Sheets have a thickness of ${this.#length(2 * look.depth)}; ` +
            "white means that the mesh is in the middle of its shell.";
        this.#legend("heat", range);
        this.app.changed();
    }

    #fillErrors({ verdict, parts, advice, worst_places: places, ...check }) {
        const side = this.app.body.box.longest;
        const rows = checkRows(check, (v) => `${this.#length(v)} (${shortNumber(100 * v / side)} %)`);
        $("measures").replaceChildren(...rows.flatMap(([name, value]) => [element("dt", {}, name), element("dd", {}, value)]));
        $("verdict").className = check.max_error_percent === null ? verdict.grade : check.passed ? "good" : "poor";
        $("verdict").textContent = [verdict.text, verdict.inside_text].filter(Boolean).join("; ");
        $("parts").textContent = parts.text;
        $("advice-title").hidden = advice.length === 0;
        $("advice").replaceChildren(...advice.map(({ command, ...one }) => element("li", {},
            ...(one.tried && !one.helps ? [] : [element("code", {}, command)]), element("p", { class: "hint" }, adviceText(one, verdict)))));
        $("places-title").textContent = places.length ? "Worst places, by fraction of wrong points" : "No wrong places";
        $("places").replaceChildren(...places.map((place) => element("li", {}, element("button", { onclick: () => this.#goTo(place) },
            element("b", {}, `${shortNumber(place.contribution_percent)} %`),
            element("span", {}, [`${this.#length(place.size)} across`, kCauses[place.cause],
                                 place.map === null ? "no map" : `map ${place.map}`].join(", "))))));
    }

    #goTo({ position, normal, explanation }) {
        this.selectMap(-1);
        this.app.pin = position;
        this.app.camera.lookAt(position, normal, 0.9 * this.app.body.box.longest);
        $("explanation").textContent = explanation;
    }

    // --- particles

    /** Updates the particle count and the quality note. fraction: of the resolution per side. */
    tick(now, fraction) {
        $("quality").hidden = fraction === 1;
        $("quality").textContent = `Reduced resolution: ${Math.round(100 * fraction)} % per side`;
        const { system } = this.app.particles;
        if (now - this.#lastTick > 250 && system) {
            this.#lastTick = now;
            $("alive").textContent = `${system.info.alive.toLocaleString("en")} alive`;
        }
    }

    /** Fills the panel with the data of the page. */
    refresh() {
        const { data, body, look } = this.app;
        const { info } = body.collider;
        const { bytes: size } = data;
        $("name").textContent = data.name;
        const { length } = this.#shownMaps();
        $("facts").textContent = `${length} map${length === 1 ? "" : "s"}, ` +
            (size >= 1e6 ? `${(size / 1e6).toFixed(2)} MB` : `${Math.round(size / 1e3)} kB`) +
            (info.provenance.triangles ? ` from ${info.provenance.triangles.toLocaleString("en")} triangles` : "") +
            `, ${this.#length(body.box.longest)} long` + (data.collider?.animated ? ", at rest" : "");
        $("show-field").hidden = !data.mesh;
        $("show-picture").hidden = true;
        $("tab-errors").hidden = !data.check;
        $("tab-particles").hidden = !data.scene;
        this.#fillMaps();
        if (data.check && data.mesh) {
            this.#fillErrors(data.check);
        }
        look.split = $("split-at").value = 0.5 - 0.5 * this.shift()[0];
        this.setShow(data.mesh ? "split" : "surface");
        this.#slice();
    }
}

/** Returns the results of `relief check`, measured against the baked mesh. */
function checkRows({ accuracy: original, repaired, sampling }, length) {
    const accuracy = repaired?.accuracy ?? original;
    const percent = (v) => `${shortNumber(v)} %`;
    const { near, uniform, distance_error: distance, normal_error_degrees: normal } = accuracy;
    return [["false inside near the surface", percent(near.false_inside_percent)], ["false outside near the surface", percent(near.false_outside_percent)],
            ["wrong in the whole box", percent(uniform.wrong_percent)],
            ["distance error, mean", length(distance.mean)], ["distance error, 99 % below", length(distance.p99)],
            ["normal error, mean", `${shortNumber(normal.mean)}°`], ["normal error, 99 % below", `${shortNumber(normal.p99)}°`],
            ["surface unseen by maps", percent(accuracy.unseen_area_percent)],
            ["far outside, without a distance", percent(accuracy.far_percent)], ["no map votes", percent(accuracy.unknown_percent)],
            ["without a normal", percent(accuracy.no_normal_percent)],
            ["inside, decided by a farther face", percent(accuracy.inside.far_face_percent)],
            ["size on the GPU", `${accuracy.gpu_bytes.toLocaleString("en")} bytes`],
            ["samples of each kind", sampling.samples.toLocaleString("en")], ["seed", `${sampling.seed}`]];
}

function adviceText({ description, tried, helps, wrong_percent: left, untried_reason: reason }, verdict) {
    return !tried ? `${description}; not tried: ${reason}` : helps
        ? `${description}; tried: ${shortNumber(left)} % wrong points instead of ${shortNumber(verdict.wrong_percent)} %`
        : `Tried without improvement: ${description} (${shortNumber(left)} %)`;
}

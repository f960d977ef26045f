// SPDX-License-Identifier: Apache-2.0
// The parts of the panel about bodies of a world: the picked body, and the errors of a check.
import { bytesText, kWrongLegend } from "./bodies.js";
import { length, lengthText, shortNumber } from "./math.js";
import { $, element } from "./panel.js";

export class WorldPanel {
    constructor(app) {
        this.app = app;
        $("wrong-legend").style.background = kWrongLegend;
        const { bodies, data } = app;
        $("wrong").onchange = () => {
            bodies.tinted = $("wrong").checked;
            app.changed();
        };
        $("picked-close").onclick = () => this.pick(-1);
        $("fly-note").hidden = false;
        if (bodies.meshes.size > 0) {
            const files = [...new Set(bodies.info.map(({ file }) => file))];
            const bytes = files.reduce((sum, file) => sum + (data.files[file]?.length ?? 0), 0);
            $("facts").textContent = `${bodies.placed.length} bod${bodies.placed.length === 1 ? "y" : "ies"} of ` +
                `${files.length} collider${files.length === 1 ? "" : "s"}, ${bytesText(bytes)}`;
        }
        $("mesh-errors").hidden = Boolean(data.check?.accuracy);
        if (!bodies.measured && !data.check?.accuracy) {
            return;
        }
        $("world-errors").hidden = false;
        $("verdict").className = data.check.verdict.grade;
        $("verdict").textContent = data.check.verdict.text;
        $("wrong").disabled = !bodies.measured;
        $("wrong").checked = Boolean(bodies.measured);
        $("wrong").onchange();
        const { accuracy: { places }, unit } = data.check;
        $("bodies-title").textContent = places.length ? "Worst bodies" : "No body has wrong points";
        $("bodies").replaceChildren(...places.map((place) => element("li", {},
            element("button", { onclick: () => this.#goTo(place), "aria-expanded": false },
                    element("b", {}, `${shortNumber(place.wrong_percent)} %`), element("span", {}, place.node || place.mesh)),
            element("div", { class: "place", hidden: "" },
                    element("img", { alt: `A slice through (${place.position.map(shortNumber).join(", ")})`,
                                     src: `data:image/png;base64,${place.picture}` }),
                    element("p", { class: "hint" }, `At (${place.position.map(shortNumber).join(", ")}): ` +
                            `error ${lengthText(place.distance, unit)}${place.texel > 0 ? `, texel ${lengthText(place.texel, unit)}` : ""}.`),
                    ...(place.advice ? [element("p", { class: "hint" }, `${place.advice[0].toUpperCase()}${place.advice.slice(1)}.`)] : [])))));
    }

    #goTo(place) {
        const { app } = this;
        [...$("bodies").children].forEach((item, k) => {
            const open = app.data.check.accuracy.places[k] === place;
            item.querySelector(".place").hidden = !open;
            item.querySelector("button").setAttribute("aria-expanded", open);
        });
        app.pin = place.position;
        const index = app.bodies.measured?.indexOf(app.bodies.nodes[place.body]) ?? -1;
        const body = app.bodies.placed[index];
        const longest = body ? body.box.longest * length(body.model) : app.look.box.longest;
        app.camera.lookAt(place.position, place.normal, 0.5 * longest);
        app.camera.pitch = Math.max(app.camera.pitch, 0.3); // do not look from below the ground
        this.pick(index);
    }

    /** Picks a body and shows its facts; −1: none. */
    pick(i) {
        const { bodies } = this.app;
        bodies.picked = i;
        $("picked").hidden = i < 0;
        if (i >= 0) {
            $("picked-name").textContent = bodies.name(i);
            $("picked-facts").replaceChildren(...bodies.facts(i).flatMap(([name, value]) =>
                [element("dt", {}, name), element("dd", {}, value)]));
        }
        this.app.changed();
    }
}

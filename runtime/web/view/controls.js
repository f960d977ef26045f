// Parts of the page: radio buttons, sliders, messages, legends.
import { css, distanceColor } from "./colors.js";

export const $ = (id) => document.getElementById(id);

export function element(tag, attributes = {}, ...children) {
    const made = document.createElement(tag);
    for (const [key, value] of Object.entries(attributes)) {
        if (key.startsWith("on")) {
            made.addEventListener(key.slice(2), value);
        } else {
            made.setAttribute(key, value);
        }
    }
    made.append(...children);
    return made;
}

/** The radio buttons of a name. */
export function choice(name, changed) {
    const buttons = [...document.getElementsByName(name)];
    buttons.forEach((one) => (one.onchange = () => changed(one.value)));
    return {
        show: (value) => buttons.forEach((one) => (one.checked = one.value === value)),
        allow: (value, yes) => buttons.filter((one) => one.value === value).forEach((one) => (one.disabled = !yes)),
    };
}

/** A slider with its name and number. scale: from a slider's place in [0, 1] to a value and back. */
export function slider({ id, name, scale, text, changed }) {
    const output = element("output");
    const input = element("input", { type: "range", id, min: 0, max: 1, step: 0.001 });
    const tell = (value) => {
        output.textContent = text(value);
        input.setAttribute("aria-valuetext", text(value));
    };
    input.addEventListener("input", () => {
        const value = scale.to(Number(input.value));
        tell(value);
        changed(value);
    });
    const show = (value) => {
        input.value = scale.back(value);
        tell(value);
    };
    return { label: element("label", { class: "field" }, element("span", { class: "label" }, `${name} `, output), input), show, input };
}

export const linear = (low, high) => ({ to: (u) => low + u * (high - low), back: (v) => (v - low) / (high - low) });
export const powersOfTwo = (low, high) => ({
    to: (u) => 2 ** Math.round(Math.log2(low * (high / low) ** u)),
    back: (v) => Math.log(v / low) / Math.log(high / low),
});

/** One sentence in place of a frozen page; null: none. */
export function say(message) {
    $("message").hidden = !message;
    $("message").querySelector("p").textContent = message ?? "";
}

/** The colours of distances, from inside to outside. */
export function fillLegends() {
    const colors = Array.from({ length: 33 }, (_, i) => css(distanceColor(i / 16 - 1)));
    document.querySelectorAll(".legend > i").forEach((one) => (one.style.background = `linear-gradient(to right, ${colors})`));
}

// Parts of the page: groups of buttons, sliders, tabs, messages.
import { distanceColor } from "./colors.js";

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

/** Buttons of which one is chosen; arrow keys go from one to the next. */
export function choice(id, changed, checked = "aria-checked", key = (button) => button.dataset.value) {
    const group = $(id) ?? id;
    const buttons = () => [...group.querySelectorAll("button")];
    const show = (value) => buttons().forEach((button) => {
        const chosen = key(button) === value;
        button.setAttribute(checked, chosen);
        button.tabIndex = chosen ? 0 : -1;
    });
    group.addEventListener("click", (event) => {
        const button = event.target.closest("button");
        if (button && !button.disabled) {
            show(key(button));
            changed(key(button));
        }
    });
    group.addEventListener("keydown", (event) => {
        const way = { ArrowRight: 1, ArrowDown: 1, ArrowLeft: -1, ArrowUp: -1 }[event.key];
        const at = buttons().filter((one) => !one.disabled);
        const i = at.indexOf(document.activeElement);
        if (way && i >= 0) {
            event.preventDefault();
            event.stopPropagation();
            const next = at[(i + way + at.length) % at.length];
            next.focus();
            next.click();
        }
    });
    show(buttons().filter((one) => one.getAttribute(checked) === "true").map(key)[0]);
    return { show, allow: (value, yes) => buttons().filter((one) => key(one) === value).forEach((one) => (one.disabled = !yes)) };
}

/** { value, text }: a slider with its name and number. scale: from a slider's place in [0, 1] to a value and back. */
export function slider({ id, name, scale, text, changed }) {
    const output = element("output");
    const input = element("input", { type: "range", id, min: 0, max: 1, step: 0.001 });
    const show = (value) => {
        input.value = scale.back(value);
        output.textContent = text(value);
        input.setAttribute("aria-valuetext", text(value));
    };
    input.addEventListener("input", () => {
        const value = scale.to(Number(input.value));
        output.textContent = text(value);
        input.setAttribute("aria-valuetext", text(value));
        changed(value);
    });
    const label = element("label", { class: "field" }, element("span", { class: "label" }, `${name} `, output), input);
    return { label, show, input };
}

export const linear = (low, high) => ({ to: (u) => low + u * (high - low), back: (v) => (v - low) / (high - low) });
export const powers = (low, high, round = (v) => v) => ({
    to: (u) => round(low * (high / low) ** u),
    back: (v) => Math.log(v / low) / Math.log(high / low),
});

export function tabs(chosen) {
    const group = document.querySelector("nav");
    return choice(group, (id) => {
        for (const button of group.querySelectorAll("button")) {
            $(button.getAttribute("aria-controls")).hidden = button.id !== id;
        }
        chosen(id.replace("tab-", ""));
    }, "aria-selected", (button) => button.id);
}

const kTipGap = 8; // pixels

/** What a button does, beside the card that holds it, so that it covers none of the card's words. */
export function followTips() {
    const tip = $("tip");
    const show = (button) => {
        tip.hidden = !button;
        if (!button) {
            return;
        }
        tip.textContent = button.dataset.tip;
        const at = button.getBoundingClientRect();
        const card = button.closest(".card").getBoundingClientRect();
        const { offsetWidth: width, offsetHeight: height } = tip;
        const middle = [at.left + at.width / 2 - width / 2, at.top + at.height / 2 - height / 2];
        const [x, y] = card.left - kTipGap - width > 0 ? [card.left - kTipGap - width, middle[1]]
            : card.bottom + kTipGap + height < innerHeight ? [middle[0], card.bottom + kTipGap]
            : [middle[0], card.top - kTipGap - height];
        tip.style.transform = `translate(${Math.round(Math.min(Math.max(x, 4), innerWidth - width - 4))}px, ${Math.round(y)}px)`;
    };
    const over = (event) => show(event.target.closest?.("[data-tip]"));
    if (matchMedia("(hover: hover)").matches) {
        addEventListener("pointerover", over);
    }
    addEventListener("focusin", (event) => event.target.matches?.(":focus-visible") && over(event));
    addEventListener("focusout", () => show(null));
    addEventListener("pointerdown", () => show(null));
}

/** One sentence in place of a frozen page; null: none. */
export function say(message) {
    $("message").hidden = !message;
    $("message").querySelector("p").textContent = message ?? "";
}

export function legend(id) {
    const canvas = $(id);
    const context = canvas.getContext("2d");
    for (let x = 0; x < canvas.width; ++x) {
        const [r, g, b] = distanceColor(2 * (x + 0.5) / canvas.width - 1).map((v) => Math.round(255 * v));
        context.fillStyle = `rgb(${r},${g},${b})`;
        context.fillRect(x, 0, 1, 1);
    }
}

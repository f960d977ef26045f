// SPDX-License-Identifier: Apache-2.0
// An orbit and fly camera with mouse, touch and keyboard input.
import { add, boxOf, clamp, cross, length, lookAt, multiply, normalize, perspective, scale, sub } from "./math.js";

const kFov = 36 * Math.PI / 180;
const kSpeed = 0.12; // flight speed, in box radii per second
const kShiftFactor = 5; // speed factor while Shift is held
const kArm = 0.005; // orbit distance while flying, in box radii

export class Camera {
    constructor(changed) {
        Object.assign(this, { yaw: 0.6, pitch: 0.32, distance: 4, target: [0, 0, 0] });
        this.taken = true; // controlled by the user: it does not follow the scene's camera
        this.changed = () => {
            this.taken = true;
            changed();
        };
        this.box = boxOf({ min: [-1, -1, -1], max: [1, 1, 1] });
        this.fov = kFov;
        this.shift = [0, 0]; // shift of the picture's centre, for the space beside the panel
        this.flying = false;
    }

    /** Frames a box. room: shorter side of the free area, relative to the picture height. */
    frame(box, room = 1) {
        this.box = box;
        this.flying = false;
        const half = Math.atan(Math.tan(kFov / 2) * Math.min(1, room));
        this.fov = kFov;
        this.target = [...box.center];
        this.distance = 1.02 * box.radius / Math.sin(half);
        this.changed();
    }

    /** Looks from an eye position to a target. */
    look(eye, target, fov) {
        this.flying = false;
        const away = sub(eye, target);
        this.distance = length(away) || 1;
        this.yaw = Math.atan2(away[0], away[2]);
        this.pitch = Math.asin(clamp(away[1] / this.distance, -1, 1));
        this.target = [...target];
        this.fov = fov ?? this.fov;
        this.changed();
    }

    get eye() {
        const c = Math.cos(this.pitch);
        return add(this.target, scale([Math.sin(this.yaw) * c, Math.sin(this.pitch), Math.cos(this.yaw) * c],
                                      this.distance));
    }

    matrices(width, height) {
        const view = lookAt(this.eye, this.target, [0, 1, 0]);
        const reach = this.distance + 12 * this.box.radius;
        const near = Math.max(this.distance - 3 * this.box.radius, this.distance * 0.01, reach * (this.flying ? 4e-5 : 2e-4));
        const projection = perspective(this.fov, width / height, near, reach);
        projection[8] = this.shift[0];
        projection[9] = this.shift[1];
        return { view, projection, camera: multiply(projection, view), eye: this.eye };
    }

    orbit(dx, dy) {
        this.yaw -= dx;
        this.pitch = clamp(this.pitch + dy, -1.55, 1.55);
        this.changed();
    }

    zoom(factor) {
        if (this.flying) {
            this.fly([0, 0, -Math.log(factor)], 1);
            return;
        }
        this.distance = clamp(this.distance * factor, 0.02 * this.box.radius, 20 * this.box.radius);
        this.changed();
    }

    /**
     * Flies for `seconds`. way: right, up and forward, each from −1 to 1. The camera then rotates about its own
     * position.
     */
    fly(way, seconds) {
        const { eye } = this;
        const back = normalize(sub(eye, this.target));
        if (!this.flying) {
            this.flying = true;
            this.distance = kArm * this.box.radius;
            this.target = sub(eye, scale(back, this.distance));
        }
        const right = normalize(cross([0, 1, 0], back));
        const step = kSpeed * this.box.radius * seconds;
        this.target = add(this.target, add(add(scale(right, step * way[0]), [0, step * way[1], 0]), scale(back, -step * way[2])));
        this.changed();
    }

    /** Pans. dx, dy: relative to the picture height. */
    pan(dx, dy) {
        const back = normalize(sub(this.eye, this.target));
        const right = normalize(cross([0, 1, 0], back));
        const span = 2 * this.distance * Math.tan(this.fov / 2);
        this.target = add(this.target, add(scale(right, -dx * span), scale(cross(back, right), dy * span)));
        this.changed();
    }

    /** Looks at a place from the direction of its normal. */
    lookAt(place, normal, distance) {
        const n = normalize(normal);
        this.flying = false;
        this.yaw = Math.hypot(n[0], n[2]) > 0.2 ? Math.atan2(n[0], n[2]) : this.yaw;
        this.pitch = clamp(Math.asin(clamp(n[1], -1, 1)), -1.3, 1.3);
        this.distance = distance;
        this.target = [...place];
        this.changed();
    }
}

const kArrows = { ArrowLeft: [1, 0], ArrowRight: [-1, 0], ArrowUp: [0, 1], ArrowDown: [0, -1] };

const kFlights = { KeyD: [1, 0, 0], KeyA: [-1, 0, 0], KeyE: [0, 1, 0], KeyQ: [0, -1, 0], KeyW: [0, 0, 1], KeyS: [0, 0, -1] };

/** Flight keys, by their physical position on the keyboard. */
export class FlightKeys {
    #held = new Set();
    #fast = false;

    constructor(camera) {
        this.camera = camera;
        addEventListener("keydown", (event) => {
            this.#fast = event.shiftKey;
            if (this.on && kFlights[event.code] && !event.ctrlKey && !event.metaKey && !event.altKey) {
                this.#held.add(event.code);
                camera.changed();
            }
        });
        addEventListener("keyup", (event) => {
            this.#fast = event.shiftKey;
            this.#held.delete(event.code);
        });
        addEventListener("blur", () => this.#held.clear());
    }

    /** Call once per frame. */
    advance(seconds) {
        if (this.#held.size > 0) {
            const way = [...this.#held].reduce((sum, code) => add(sum, kFlights[code]), [0, 0, 0]);
            this.camera.fly(scale(way, this.#fast ? kShiftFactor : 1), seconds);
        }
    }
}

const kTap = 5; // maximum pointer movement of a click, in pixels

/**
 * Connects pointer, wheel and keyboard input. tap(x, y): called for clicks, in fractions of the canvas from the lower
 * left.
 */
export function followInput(canvas, camera, tap) {
    const down = new Map();
    let pressed = null; // position of a press that may become a click
    const spread = () => {
        const [a, b] = [...down.values()];
        return { x: (a.x + b.x) / 2, y: (a.y + b.y) / 2, d: Math.hypot(a.x - b.x, a.y - b.y) || 1 };
    };
    canvas.addEventListener("pointerdown", (event) => {
        canvas.setPointerCapture(event.pointerId);
        down.set(event.pointerId, { x: event.clientX, y: event.clientY });
        pressed = down.size === 1 && event.button === 0 ? { x: event.clientX, y: event.clientY } : null;
        canvas.classList.add("held");
    });
    canvas.addEventListener("pointermove", (event) => {
        const last = down.get(event.pointerId);
        if (!last) {
            return;
        }
        if (pressed && Math.hypot(event.clientX - pressed.x, event.clientY - pressed.y) <= kTap) {
            return; // may still become a click
        }
        pressed = null;
        const height = canvas.clientHeight;
        const before = down.size === 2 ? spread() : null;
        const dx = event.clientX - last.x;
        const dy = event.clientY - last.y;
        down.set(event.pointerId, { x: event.clientX, y: event.clientY });
        if (before) {
            const now = spread();
            camera.pan((now.x - before.x) / height, (now.y - before.y) / height);
            camera.zoom(before.d / now.d);
        } else if (down.size === 1 && (event.buttons & 6 || event.shiftKey)) {
            camera.pan(dx / height, dy / height);
        } else if (down.size === 1) {
            camera.orbit(dx * 3.2 / height, dy * 3.2 / height);
        }
    });
    const up = (event) => {
        down.delete(event.pointerId);
        canvas.classList.toggle("held", down.size > 0);
    };
    canvas.addEventListener("pointerup", (event) => {
        up(event);
        if (pressed) {
            pressed = null;
            const { left, bottom, width, height } = canvas.getBoundingClientRect();
            tap((event.clientX - left) / width, (bottom - event.clientY) / height);
        }
    });
    canvas.addEventListener("pointercancel", up);
    canvas.addEventListener("contextmenu", (event) => event.preventDefault());
    canvas.addEventListener("wheel", (event) => {
        event.preventDefault();
        const pixels = event.deltaY * (event.deltaMode === 1 ? 30 : event.deltaMode === 2 ? 300 : 1);
        camera.zoom(Math.exp(clamp(pixels, -240, 240) * (event.ctrlKey ? 0.008 : 0.0014)));
    }, { passive: false });
    addEventListener("keydown", (event) => {
        if (!event.target.closest?.("input, button")) { // controls handle their own keys
            const way = kArrows[event.key];
            if (way) {
                camera[event.shiftKey ? "pan" : "orbit"](0.08 * way[0], 0.08 * way[1]);
            }
            const factor = { "+": 0.85, "-": 1 / 0.85 }[event.key];
            if (factor) {
                camera.zoom(factor);
            }
        }
    });
}

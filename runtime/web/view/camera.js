// A camera that goes round a point: by mouse, by touch with two fingers, by arrow keys.
import { add, boxOf, clamp, cross, length, lookAt, multiply, normalize, perspective, scale, sub } from "./math.js";

const kFov = 36 * Math.PI / 180;

export class Camera {
    constructor(changed) {
        Object.assign(this, { changed, yaw: 0.6, pitch: 0.32, distance: 4, target: [0, 0, 0] });
        this.box = boxOf({ min: [-1, -1, -1], max: [1, 1, 1] });
        this.fov = kFov;
        this.shift = [0, 0]; // of the picture's middle, for what lies under a panel
    }

    /** Round a box. room: what is free of the picture, its shorter side over the picture's height. */
    frame(box, room = 1) {
        this.box = box;
        const half = Math.atan(Math.tan(kFov / 2) * Math.min(1, room));
        this.fov = kFov;
        this.target = [...box.center];
        this.distance = 1.02 * box.radius / Math.sin(half);
        this.changed();
    }

    /** From an eye to a target, as in a scene. */
    look(eye, target, fov) {
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
        const near = Math.max(this.distance - 3 * this.box.radius, this.distance * 0.01, reach * 2e-4);
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
        this.distance = clamp(this.distance * factor, 0.02 * this.box.radius, 20 * this.box.radius);
        this.changed();
    }

    /** In heights of the picture. */
    pan(dx, dy) {
        const back = normalize(sub(this.eye, this.target));
        const right = normalize(cross([0, 1, 0], back));
        const span = 2 * this.distance * Math.tan(this.fov / 2);
        this.target = add(this.target, add(scale(right, -dx * span), scale(cross(back, right), dy * span)));
        this.changed();
    }

    /** At a place, from its normal's side. */
    lookAt(place, normal, distance) {
        const n = normalize(normal);
        this.yaw = Math.hypot(n[0], n[2]) > 0.2 ? Math.atan2(n[0], n[2]) : this.yaw;
        this.pitch = clamp(Math.asin(clamp(n[1], -1, 1)), -1.3, 1.3);
        this.distance = distance;
        this.target = [...place];
        this.changed();
    }
}

const kArrows = { ArrowLeft: [1, 0], ArrowRight: [-1, 0], ArrowUp: [0, 1], ArrowDown: [0, -1] };

/** Mouse, pen and fingers on the canvas, and keys. */
export function followInput(canvas, camera) {
    const down = new Map();
    const spread = () => {
        const [a, b] = [...down.values()];
        return { x: (a.x + b.x) / 2, y: (a.y + b.y) / 2, d: Math.hypot(a.x - b.x, a.y - b.y) || 1 };
    };
    canvas.addEventListener("pointerdown", (event) => {
        canvas.setPointerCapture(event.pointerId);
        down.set(event.pointerId, { x: event.clientX, y: event.clientY });
        canvas.classList.add("held");
    });
    canvas.addEventListener("pointermove", (event) => {
        const last = down.get(event.pointerId);
        if (!last) {
            return;
        }
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
    canvas.addEventListener("pointerup", up);
    canvas.addEventListener("pointercancel", up);
    canvas.addEventListener("contextmenu", (event) => event.preventDefault());
    canvas.addEventListener("wheel", (event) => {
        event.preventDefault();
        const pixels = event.deltaY * (event.deltaMode === 1 ? 30 : event.deltaMode === 2 ? 300 : 1);
        camera.zoom(Math.exp(clamp(pixels, -240, 240) * (event.ctrlKey ? 0.008 : 0.0014)));
    }, { passive: false });
    addEventListener("keydown", (event) => {
        if (!event.target.closest?.("input, button")) { // which have keys of their own
            const [x, y] = kArrows[event.key] ?? [0, 0];
            camera[event.shiftKey ? "pan" : "orbit"](0.08 * x, 0.08 * y);
            camera.zoom({ "+": 0.85, "-": 1 / 0.85 }[event.key] ?? 1);
        }
    });
}

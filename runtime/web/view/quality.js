// SPDX-License-Identifier: Apache-2.0
// Reduces the resolution while frames take too long.
const kPixels = [1, 0.71, 0.5]; // fraction of the resolution per side; each level halves the pixels
const kFrames = 10; // the median of this many frames decides
const kSlow = 40; // ms
const kQuick = 19; // ms; below kSlow even with twice the pixels
const kPause = 1000; // ms; longer gaps are pauses, not slow frames

export class Quality {
    #times = [];
    #last = null;
    #level = 0;

    /** Fraction of the resolution per side while something moves. */
    get pixels() {
        return kPixels[this.#level];
    }

    /** Call once per frame. moving: the next frame follows as soon as possible. */
    frame(now, moving) {
        const took = this.#last === null ? kPause : now - this.#last;
        this.#last = moving ? now : null;
        if (took >= kPause || this.#times.push(took) < kFrames) {
            return;
        }
        const middle = this.#times.sort((a, b) => a - b)[kFrames / 2];
        this.#times = [];
        if (middle > kSlow && this.#level < kPixels.length - 1) {
            this.#level += 1;
        } else if (middle < kQuick && this.#level > 0) {
            this.#level -= 1;
        }
    }
}

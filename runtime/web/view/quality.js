// SPDX-License-Identifier: Apache-2.0
// Keeps the page moving where a machine is slow: while frames take long, fewer pixels are drawn.
const kPixels = [1, 0.71, 0.5]; // of each side: half as many pixels each time
const kFrames = 10; // of which the middle one counts
const kSlow = 40; // ms
const kQuick = 19; // with twice the pixels such a frame is not slow
const kPause = 1000; // a page that slept is not slow

export class Quality {
    #times = [];
    #last = null;
    #level = 0;

    /** Of each side, while something moves. */
    get pixels() {
        return kPixels[this.#level];
    }

    /** With each frame. moving: the next one comes as soon as it can. */
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

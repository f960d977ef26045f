// Keeps the page moving where a machine is slow: while frames take long, fewer pixels are drawn, then fewer particles.
const kPixels = [1, 0.71, 0.5]; // of each side
const kFrames = 10; // of which the middle one counts
const kSlow = 40; // ms
const kQuick = 24;
const kPatience = 4000; // ms of quick frames before finer pixels are tried; twice as long after each try in vain
const kPause = 1000; // a page that slept is not slow
const kParticlesMin = 8192;

export class Quality {
    #times = [];
    #last = null;
    #level = 0;
    #quickSince = null;
    #patience = kPatience;
    #tried = false;

    /** Of each side, while something moves. */
    get pixels() {
        return kPixels[this.#level];
    }

    /**
     * With each frame. moving: the next one comes as soon as it can.
     * @param fewer  halves the particles; returns whether there were enough of them
     */
    frame(now, moving, fewer) {
        const took = this.#last === null ? kPause : now - this.#last;
        this.#last = moving ? now : null;
        if (took >= kPause) {
            return;
        }
        this.#times.push(took);
        if (this.#times.length < kFrames) {
            return;
        }
        const middle = [...this.#times].sort((a, b) => a - b)[kFrames / 2];
        this.#times = [];
        if (middle > kSlow) {
            this.#patience *= this.#tried ? 2 : 1;
            this.#quickSince = null;
            if (this.#level < kPixels.length - 1) {
                this.#level += 1;
            } else {
                fewer(kParticlesMin);
            }
            this.#tried = false;
        } else if (middle < kQuick && this.#level > 0) {
            this.#quickSince ??= now;
            if (now - this.#quickSince > this.#patience) {
                this.#level -= 1;
                this.#tried = true;
                this.#quickSince = null;
            }
        } else {
            this.#quickSince = null;
        }
    }
}

// SPDX-License-Identifier: MIT
// SPDX-FileCopyrightText: 2026 The musurf authors
// sphere_view.js: the lit sphere: draws whenever something has changed; coarser while it moves where 30 frames a second want that; finer
// when all is still; and adds samples up as long as there is nothing else to do.
import { materialNumbers, queryNumbers, sphereNumbers } from "./question.js";

const FULL = 512, BEHIND = 96, COARSER = [512, 384, 256, 192], FRAME = 1000 / 30, STILL = 200, PASSES = 1024;
const ALBEDO = { moving: 34, still: 610 };

export class SphereView {
    constructor(team, canvas, behind, status, choices) {
        Object.assign(this, { team, canvas, behind, status, choices });
        this.context = canvas.getContext("2d");
        behind.width = behind.height = BEHIND;
        this.pass = 0;
        this.coarse = 0;
        this.ends = [];
        this.frames = 0;
    }

    show(state) {
        this.state = structuredClone(state);
        this.changed = performance.now();
        this.dirty = true;
        this.pass = 0;
        if (!this.busy) this.work();
    }

    jobOf(moving) {
        const { state, choices } = this;
        const size = state.size !== "adaptive" ? Number(state.size) : moving ? COARSER[this.coarse] : FULL;
        const around = String([state.turn, state.surroundings, state.exposure, state.technique === "lamp"]);
        const backdrop = around === this.around ? 0 : BEHIND;
        this.around = around;
        return {
            material: materialNumbers(state, choices), query: queryNumbers(state), sphere: sphereNumbers(state, size, choices),
            surroundings: choices.surroundings.indexOf(state.surroundings), size, pass: this.pass,
            sampled: state.technique === "sampled", moving, albedo: moving ? ALBEDO.moving : ALBEDO.still, backdrop,
        };
    }

    // Frames of the last second, and what a frame takes, which says how coarse the next may be.
    count(size, taken, moving) {
        const now = performance.now();
        this.ends = this.ends.filter((end) => now - end < 1000);
        this.ends.push(now);
        this.frames++;
        if (moving && this.state.size === "adaptive") {
            if (taken > 1.15 * FRAME && this.coarse < COARSER.length - 1) this.coarse++;
            else if (this.coarse > 0 && taken * (COARSER[this.coarse - 1] / COARSER[this.coarse]) ** 2 < 0.85 * FRAME) this.coarse--;
        }
        const rate = moving ? ` · ${this.ends.length} frames/s` : "", passes = this.state.technique === "sampled" ? ` · ${this.pass + 1} samples a pixel` : "";
        const text = `${size}²${rate}${passes}`;
        if (this.status.textContent !== text) this.status.textContent = text;
        Object.assign(this.status.dataset, { size, worker: this.team.taken, taken, frames: this.frames, rate: this.ends.length, pass: this.pass });
    }

    async work() {
        this.busy = true;
        for (;;) {
            const begun = performance.now(), moving = this.dirty && begun - this.changed < STILL;
            this.dirty = false;
            const job = this.jobOf(moving), { picture, behind } = await this.team.draw(job);
            if (this.canvas.width !== job.size) this.canvas.width = this.canvas.height = job.size;
            this.context.putImageData(picture, 0, 0);
            if (behind) this.behind.getContext("2d").putImageData(behind, 0, 0);
            this.count(job.size, performance.now() - begun, moving);
            if (this.dirty) continue;
            if (job.sampled && this.pass < PASSES - 1) this.pass++;
            else if (moving) return this.wait();
            else break;
        }
        this.busy = false;
    }

    // When nothing has moved for a while: once more, in full.
    wait() {
        this.busy = false;
        setTimeout(() => this.settle(), STILL + 20);
    }

    settle() {
        if (this.busy || performance.now() - this.changed < STILL) return;
        this.work();
    }
}

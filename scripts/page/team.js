// SPDX-License-Identifier: MIT
// SPDX-FileCopyrightText: 2026 The musurf authors
// team.js: workers that share a picture, each every so-manieth pair of rows. A page from a disk may have workers of its own text.
import { loadCore } from "./core.js";
import { Renderer } from "./renderer.js";

function start(source, bytes) {
    return new Promise((resolve, reject) => {
        const worker = new Worker(source);
        worker.onerror = (event) => reject(new Error(event.message || "a worker failed"));
        worker.onmessage = () => resolve(worker);
        worker.postMessage({ bytes });
    });
}

export class Team {
    static async make(text, bytes, wanted) {
        const team = new Team();
        team.rooms = [];
        try {
            const source = URL.createObjectURL(new Blob([text], { type: "text/javascript" }));
            team.workers = await Promise.all(Array.from({ length: wanted }, () => start(source, bytes)));
        } catch (error) { // then the page draws itself, and waits while it does
            team.workers = [];
            team.renderer = new Renderer(await loadCore(bytes));
        }
        return team;
    }

    get count() {
        return this.workers.length;
    }

    async part(job, first, step) {
        const room = this.rooms[first], mine = { ...job, first, step, room };
        if (this.renderer) return this.renderer.run(mine);
        const worker = this.workers[first];
        return new Promise((resolve) => {
            worker.onmessage = (event) => {
                this.taken = Math.max(this.taken, event.data.taken);
                resolve(event.data);
            };
            worker.postMessage(mine, room ? [room] : []);
        });
    }

    // One job at a time. The whole picture, and what is behind it if that was asked for.
    async draw(job) {
        this.taken = 0; // by the slowest worker
        const step = Math.max(this.count, 1), size = job.size, row = 4 * size;
        if (this.picture?.width !== size) this.picture = new ImageData(size, size);
        const parts = await Promise.all(Array.from({ length: step }, (_, first) => this.part(job, first, step)));
        parts.forEach(({ pixels }, first) => {
            this.rooms[first] = pixels; // back with the next job: a megabyte a frame would keep the collector busy
            const bytes = new Uint8ClampedArray(pixels);
            for (let pair = first, at = 0; pair < size / 2; pair += step, at += 2 * row) {
                this.picture.data.set(bytes.subarray(at, at + row), row * pair);
                this.picture.data.set(bytes.subarray(at + row, at + 2 * row), row * (size - 1 - pair));
            }
        });
        const behind = parts[0].backdrop && new ImageData(new Uint8ClampedArray(parts[0].backdrop), job.backdrop, job.backdrop);
        return { picture: this.picture, behind };
    }
}

// SPDX-License-Identifier: MIT
// SPDX-FileCopyrightText: 2026 The musurf authors
// renderer.js: some rows of the sphere's picture, in a worker or, where there is none, in the page itself.
import { Doubles } from "./core.js";

// Texels of half a degree, twice a pixel of what a sphere of 512 pixels shows in its middle.
const SIDE = 256;

export class Renderer {
    constructor(core) {
        this.core = core;
        this.material = core.page_material_new();
        this.sphere = core.page_sphere_new();
        this.surroundings = new Map();
        this.room = {};
        this.said = {};
    }

    place(name, numbers) {
        this.room[name] ??= new Doubles(this.core, numbers.length);
        return this.room[name].set(numbers);
    }

    around(kind) {
        if (!this.surroundings.has(kind)) this.surroundings.set(kind, this.core.page_surroundings_new(kind, SIDE));
        return this.surroundings.get(kind);
    }

    // Pixels of a picture: they keep their memory from job to job, and sums from pass to pass.
    reserve(size, pairs) {
        const bytes = 8 * size * pairs;
        if (this.bytes === bytes) return;
        if (this.pixels) this.core.free(this.pixels), this.core.free(this.sums);
        this.pixels = this.core.malloc(bytes);
        this.sums = this.core.malloc(3 * bytes);
        this.bytes = bytes;
    }

    // What is behind the sphere, where it has changed.
    backdrop(size) {
        this.behind ??= this.core.malloc(4 * size * size);
        this.core.page_backdrop(this.sphere, size, this.behind);
        return this.core.memory.buffer.slice(this.behind, this.behind + 4 * size * size);
    }

    // job: { material, query, sphere: numbers, surroundings, size, first, step, pass, sampled, moving, albedo, backdrop, room }. Rows come in pairs,
    // from the top and from the bottom: pairs first, first + step, ... Returns their pixels, in `room`, an ArrayBuffer, where it has that size;
    // the first of all also the backdrop, of that size unless 0. While the material moves, every other picture has the albedos of the one
    // before: where a column of M moves by 0.07 a picture they differ by less than 1 %, and so few directions are off by 2 to 5 %.
    run(job) {
        const { core } = this, half = job.size / 2, pairs = Math.ceil((half - job.first) / job.step);
        const said = String(job.material), anew = said !== this.said.material || job.albedo > (this.said.albedo ?? 0);
        if (said !== this.said.material) core.page_material_set(this.material, this.place("material", job.material));
        const around = this.around(job.surroundings);
        const albedo = anew && !(job.moving && this.made) ? job.albedo : 0;
        this.made = albedo > 0;
        if (anew) this.said = { material: said, albedo };
        core.page_sphere_set(this.sphere, this.material, around, this.place("query", job.query), this.place("sphere", job.sphere), albedo);
        this.reserve(job.size, pairs);
        if (job.sampled && job.pass === 0) new Uint8Array(core.memory.buffer, this.sums, 3 * this.bytes).fill(0);
        for (let i = 0, row = job.first; i < pairs; i++, row += job.step) {
            const offset = 8 * job.size * i;
            core.page_sphere_rows(this.sphere, row, job.pass, job.sampled ? this.sums + 3 * offset : 0, 0, this.pixels + offset);
        }
        const pixels = job.room?.byteLength === this.bytes ? job.room : new ArrayBuffer(this.bytes);
        new Uint8Array(pixels).set(new Uint8Array(core.memory.buffer, this.pixels, this.bytes));
        return { pixels, backdrop: job.backdrop && job.first === 0 ? this.backdrop(job.backdrop) : null };
    }
}

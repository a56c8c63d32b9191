// SPDX-License-Identifier: MIT
// SPDX-FileCopyrightText: 2026 The musurf authors
// core.js: the C core in WebAssembly: its functions (page.h), its memory, its lists of names.

// The C library would write messages by these; nobody does: 52 is "not implemented".
const wasi = { fd_close: () => 52, fd_seek: () => 52, fd_write: () => 52 };

export function bytesOfBase64(text) {
    const raw = atob(text.trim()), bytes = new Uint8Array(raw.length);
    for (let i = 0; i < raw.length; i++) bytes[i] = raw.charCodeAt(i);
    return bytes;
}

export async function loadCore(bytes) {
    const { instance } = await WebAssembly.instantiate(bytes, { wasi_snapshot_preview1: wasi });
    const core = instance.exports;
    core._initialize();
    return core;
}

export function textAt(core, place) {
    const bytes = new Uint8Array(core.memory.buffer);
    let end = place;
    while (bytes[end]) end++;
    return new TextDecoder().decode(bytes.slice(place, end));
}

// Of a function that names 0, 1, ... and answers NULL after the last.
export function namesOf(core, nameOf) {
    const names = [];
    for (let place; (place = nameOf(names.length)); ) names.push(textAt(core, place));
    return names;
}

// Memory of the core for `count` doubles. Views end when memory grows: ask for one anew.
export class Doubles {
    constructor(core, count) {
        this.core = core;
        this.count = count;
        this.place = core.malloc(8 * count);
    }
    view() {
        return new Float64Array(this.core.memory.buffer, this.place, this.count);
    }
    set(numbers) {
        this.view().set(numbers);
        return this.place;
    }
}

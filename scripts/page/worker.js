// SPDX-License-Identifier: MIT
// SPDX-FileCopyrightText: 2026 The musurf authors
// worker.js: a thread of its own with a core of its own: gets the core's bytes, then jobs.
import { loadCore } from "./core.js";
import { Renderer } from "./renderer.js";

let renderer;
onmessage = async (event) => {
    if (event.data.bytes) {
        renderer = new Renderer(await loadCore(event.data.bytes));
        postMessage({ ready: true });
    } else {
        const begun = performance.now(), done = renderer.run(event.data);
        postMessage({ ...done, taken: performance.now() - begun }, [done.pixels]);
    }
};

// SPDX-License-Identifier: MIT
// SPDX-FileCopyrightText: 2026 The musurf authors
// controls.js: sliders, numbers and choices, each bound to a key of the state ("M.2": the third number of M) by data-key.
import { ranges, within } from "./state.js";

function read(state, path) {
    const [key, index] = path.split(".");
    return index === undefined ? state[key] : state[key][index];
}

function written(state, path, value) {
    const [key, index] = path.split(".");
    if (index === undefined) return { [key]: value };
    const copy = [...state[key]];
    copy[index] = value;
    return { [key]: copy };
}

export class Controls {
    // `change(part of the state)`
    constructor(root, choices, change) {
        this.inputs = [...root.querySelectorAll("[data-key]")];
        for (const input of this.inputs) {
            const path = input.dataset.key;
            if (input.tagName === "SELECT")
                for (const name of choices[path]) input.add(new Option(name.replaceAll("_", " "), name));
            else if (ranges[path] && !input.min) [input.min, input.max] = ranges[path];
            input.addEventListener("input", () => {
                const value = input.tagName === "SELECT" ? input.value : input.valueAsNumber;
                if (typeof value === "number" && !Number.isFinite(value)) return; // half typed
                change(written(this.state, path, input.tagName === "SELECT" ? value : within(path, value)));
            });
        }
    }

    // `state`
    show() {
        const { state } = this;
        for (const input of this.inputs) {
            const value = String(read(state, input.dataset.key));
            if (input.value === value) continue;
            if (input !== document.activeElement || input.type === "range" || input.tagName === "SELECT") input.value = value;
        }
        for (const row of document.querySelectorAll("[data-for]")) row.hidden = !row.dataset.for.split(" ").includes(state.ndf);
    }
}

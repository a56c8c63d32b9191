// SPDX-License-Identifier: MIT
// SPDX-FileCopyrightText: 2026 The musurf authors
// handle.js: a point in a drawing that is dragged with the pointer or moved with the arrow keys. Drawings are SVG of -1 ... 1, y downwards.

const svgNamespace = "http://www.w3.org/2000/svg";

export function svgElement(name, attributes, parent) {
    const element = document.createElementNS(svgNamespace, name);
    for (const [key, value] of Object.entries(attributes)) element.setAttribute(key, value);
    if (parent) parent.append(element);
    return element;
}

// A pointer's place, x to the right and y upwards.
function placeOf(svg, event) {
    const box = svg.getBoundingClientRect();
    return [2 * (event.clientX - box.left) / box.width - 1, 1 - 2 * (event.clientY - box.top) / box.height];
}

// `moved(x, y)`: to a place; `stepped(right, up)`: by arrow keys, ten times as far with Shift.
export class Handle {
    constructor(svg, { name, kind = name, label, moved, stepped }) {
        this.group = svgElement("g", { class: `handle ${kind}`, tabindex: 0, role: "slider", "aria-label": label }, svg);
        svgElement("circle", { r: 0.11, class: "reach" }, this.group);
        svgElement("circle", { r: 0.038, class: "knob" }, this.group);
        this.text = svgElement("text", { x: 0.055, y: -0.05 }, this.group);
        this.text.textContent = name;
        this.group.addEventListener("pointerdown", (event) => {
            this.group.setPointerCapture(event.pointerId);
            this.dragged = true;
        });
        this.group.addEventListener("pointermove", (event) => this.dragged && moved(...placeOf(svg, event)));
        for (const end of ["pointerup", "pointercancel"]) this.group.addEventListener(end, () => (this.dragged = false));
        this.group.addEventListener("keydown", (event) => {
            const step = { ArrowLeft: [-1, 0], ArrowRight: [1, 0], ArrowUp: [0, 1], ArrowDown: [0, -1] }[event.key];
            if (!step) return;
            event.preventDefault();
            const times = event.shiftKey ? 10 : 1;
            stepped(step[0] * times, step[1] * times);
        });
    }

    put(x, y, value) {
        this.group.setAttribute("transform", `translate(${x.toFixed(4)} ${(-y).toFixed(4)})`);
        this.group.setAttribute("aria-valuetext", value);
        this.text.setAttribute("text-anchor", x > 0.75 ? "end" : "start");
        this.text.setAttribute("x", x > 0.75 ? -0.055 : 0.055);
    }
}

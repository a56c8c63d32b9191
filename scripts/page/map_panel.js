// SPDX-License-Identifier: MIT
// SPDX-FileCopyrightText: 2026 The musurf authors
// map_panel.js: M as what it does to the plane: a grid and a circle of the microsurface, and its two columns, which are dragged.
import { Handle, svgElement } from "./handle.js";

const reaches = [3, 6, 12, 30, 120, 1e3, 1e4, 1e6];
const round = (x) => Math.round(x * 100) / 100 + 0;

export class MapPanel {
    // `change(M)`
    constructor(svg, change) {
        this.change = change;
        this.grid = svgElement("path", { class: "grid" }, svg);
        this.before = svgElement("circle", { class: "before" }, svg);
        this.after = svgElement("path", { class: "after" }, svg);
        this.arrows = [0, 1].map((column) => svgElement("path", { class: `arrow column${column}` }, svg));
        this.scale = svgElement("text", { x: 0.97, y: 0.94, "text-anchor": "end", class: "scale" }, svg);
        this.handles = [0, 1].map((column) => new Handle(svg, {
            name: column ? "M ŷ" : "M x̂", kind: `column${column}`,
            label: `column ${column + 1} of M: where the ${column ? "y" : "x"} axis of the microsurface goes`,
            moved: (x, y) => this.moveTo(column, round(x * this.reach), round(y * this.reach)),
            stepped: (right, up) => this.moveTo(column, round(this.M[column] + 0.02 * right), round(this.M[column + 2] + 0.02 * up)),
        }));
    }

    moveTo(column, x, y) {
        const M = [...this.M];
        M[column] = x, M[column + 2] = y;
        this.change(M);
    }

    // `M`
    show() {
        const { M } = this, largest = Math.max(Math.hypot(M[0], M[2]), Math.hypot(M[1], M[3]));
        if (!this.handles.some((handle) => handle.dragged)) this.reach = reaches.find((reach) => reach >= 1.02 * largest) ?? largest;
        const at = (x, y) => `${((M[0] * x + M[1] * y) / this.reach).toFixed(4)} ${(-(M[2] * x + M[3] * y) / this.reach).toFixed(4)}`;
        let grid = "", ellipse = "";
        for (let i = -4; i <= 4; i++) grid += `M${at(i, -4)}L${at(i, 4)}M${at(-4, i)}L${at(4, i)}`;
        for (let i = 0; i < 64; i++) ellipse += `${i ? "L" : "M"}${at(Math.cos(i * Math.PI / 32), Math.sin(i * Math.PI / 32))}`;
        this.grid.setAttribute("d", grid);
        this.before.setAttribute("r", 1 / this.reach);
        this.after.setAttribute("d", ellipse + "Z");
        [[1, 0], [0, 1]].forEach((axis, column) => {
            this.arrows[column].setAttribute("d", `M0 0L${at(...axis)}`);
            this.handles[column].put(M[column] / this.reach, M[column + 2] / this.reach, `${M[column]}, ${M[column + 2]}`);
        });
        this.scale.textContent = `±${this.reach}`;
    }
}

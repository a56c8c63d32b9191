// SPDX-License-Identifier: MIT
// SPDX-FileCopyrightText: 2026 The musurf authors
// lobe_panel.js: one of the three panels of panel.h: the material's lobe as a picture, over it region, axis, samples; and its handles.
import { Doubles } from "./core.js";
import { discOf } from "./direction.js";
import { svgElement } from "./handle.js";

const BOUNDARY = 0;
const curves = { boundary: [BOUNDARY, 97], whole: [1, 25], clamped: [2, 25] };
const POINTS = 3, SAMPLED = 4, DISCS = 5, DISC = 32, SLOPES = 0, NORMALS = 1, REFLECTED = 2;
const WHOLE = [1.1, 0, 0]; // reach and middle of what is shown: the hemisphere

// 1, 2 or 5 times a power of ten, at least x.
function niceAbove(x) {
    const power = 10 ** Math.floor(Math.log10(x));
    return [1, 2, 5, 10].map((digit) => digit * power).find((nice) => nice >= x * (1 - 1e-12));
}

export class LobePanel {
    // `largest`: the most pixels of a side.
    constructor(core, space, canvas, svg, largest) {
        Object.assign(this, { core, space, canvas, svg });
        this.context = canvas.getContext("2d");
        this.work = core.malloc(4 * largest * largest);
        this.pixels = core.malloc(4 * largest * largest);
        this.points = core.malloc(16 * 64 * DISC);
        this.cross = svgElement("path", { class: "cross" }, svg);
        if (space !== SLOPES) this.horizon = svgElement("circle", { class: "horizon" }, svg);
        this.frame = WHOLE;
        this.framePlace = new Doubles(core, 3);
        this.discs = svgElement("path", { class: "discs" }, svg);
        this.lines = Object.fromEntries(Object.keys(curves).map((name) => [name, svgElement("path", { class: name }, svg)]));
        this.samples = svgElement("path", { class: "samples" }, svg);
        this.dots = ["far", "far", "near", "near", "shifted", "shifted", "normal"].map((name) =>
            svgElement("circle", { class: name, r: name === "shifted" ? 0.032 : 0.022 }, svg));
        this.scale = svgElement("text", { x: 0.97, y: 0.94, "text-anchor": "end", class: "scale" }, svg);
    }

    pointsOf(curve, count) {
        const found = this.core.page_curve_points(this.material, this.query, this.space, this.framePlace.set(this.frame), curve, count, this.points);
        const flat = new Float64Array(this.core.memory.buffer, this.points, 2 * found), points = [];
        // what is far out, or at no place, is drawn far out
        const held = (x) => (Math.abs(x) < 99 ? Math.round(x * 1e4) / 1e4 : x > 0 ? 99 : x < 0 ? -99 : 0);
        for (let i = 0; i < found; i++) points.push([held(flat[2 * i]), held(-flat[2 * i + 1])]);
        return points;
    }

    drawDensity(size, ink) {
        const { core } = this;
        if (this.image?.width !== size) {
            this.image = new ImageData(size, size);
            this.canvas.width = this.canvas.height = size;
        }
        this.largest = core.page_density(this.material, this.query, this.space, this.framePlace.set(this.frame), size, ink, this.work, this.pixels);
        this.image.data.set(new Uint8ClampedArray(core.memory.buffer, this.pixels, 4 * size * size));
        this.context.putImageData(this.image, 0, 0);
    }

    // What to show: of slopes so much that the region fills a half of the panel; of directions all or, close up, as of slopes.
    frameFor(state, sigma, wo) {
        if (this.space === SLOPES) return [niceAbove(Math.max(1.7 * state.k * Math.max(...sigma), 1e-9)), 0, 0];
        if (state.panels !== "close up") return WHOLE;
        const middle = this.space === NORMALS ? [0, 0] : discOf([-wo[0], -wo[1], wo[2]]);
        this.frame = [1, ...middle];
        const widest = Math.max(...this.pointsOf(BOUNDARY, 33).map((p) => Math.hypot(...p)));
        return widest < 0.4 ? [niceAbove(Math.max(1.7 * widest, 1e-9)), ...middle] : WHOLE;
    }

    // A place of the panel's plane in the panel, and back.
    inPanel([x, y]) {
        const [reach, middleX, middleY] = this.frame;
        return [(x - middleX) / reach, (y - middleY) / reach];
    }
    inPlane(x, y) {
        const [reach, middleX, middleY] = this.frame;
        return [middleX + reach * x, middleY + reach * y];
    }

    drawFrame() {
        const [x, y] = this.inPanel([0, 0]).map((c) => Math.round(c * 1e4) / 1e4), reach = this.frame[0];
        this.cross.setAttribute("d", `M-1 ${-y}H1M${x} -1V1`);
        this.scale.textContent = this.frame === WHOLE ? "" : `±${Number(reach.toPrecision(3))}`;
        if (!this.horizon) return;
        this.horizon.setAttribute("cx", x);
        this.horizon.setAttribute("cy", -y);
        this.horizon.setAttribute("r", 1 / reach);
    }

    show(material, query, state, sigma, wo, size, ink) {
        Object.assign(this, { material, query });
        this.frame = this.frameFor(state, sigma, wo);
        this.drawFrame();
        this.drawDensity(size, ink);
        for (const [name, [curve, count]] of Object.entries(curves))
            this.lines[name].setAttribute("d", "M" + this.pointsOf(curve, count).map((p) => p.join(" ")).join("L"));
        this.pointsOf(POINTS, 0).forEach(([x, y], i) => (this.dots[i].setAttribute("cx", x), this.dots[i].setAttribute("cy", y)));
        this.samples.setAttribute("d", this.pointsOf(SAMPLED, 0).map((p) => `M${p.join(" ")}h0`).join(""));
        if (this.space === REFLECTED) {
            const points = this.pointsOf(DISCS, 0);
            let path = "";
            points.forEach((p, i) => (path += `${i % DISC ? "L" : (i ? "Z" : "") + "M"}${p.join(" ")}`));
            this.discs.setAttribute("d", path + "Z");
        }
    }
}

// SPDX-License-Identifier: MIT
// SPDX-FileCopyrightText: 2026 The musurf authors
// numbers.js: the numbers at wo, wi and the axis, as the core says them, all their digits; and the commands that say the same.
import { Doubles, textAt } from "./core.js";
import { axisLine, evalLine } from "./question.js";

// Name, unit, what it is; of the core's names (numbers.c).
const rows = {
    "at wo, wi and wm = (wo + wi) / |wo + wi|": {
        wm: ["", "micronormal halfway"], D: ["1/sr", "distribution of micronormals at wm"], Dv: ["1/sr", "of those visible from wo"],
        G1: ["", "masking of wm from wo"], Lambda: ["", "Smith's Λ of wo"], sigma: ["", "projected area of the side visible from wo"],
        G2: ["", "shadowing and masking"], F: ["", "Fresnel reflectance, r g b"], f: ["1/sr", "BRDF, r g b"],
        f_cos: ["1/sr", "BRDF times the cosine of wi"], pdf: ["1/sr", "of sampling wi by visible normals"],
    },
    "major axis": {
        slope_sigma: ["", "deviations of the slope along U, V"], angle: ["rad", "from x to U"], t: ["rad", "of the closest and farthest point"],
        far: ["", "farthest points, micronormals"], near: ["", "closest points, micronormals"],
        tau: ["", "where the axis meets the horizon"], far_clamped: ["", "axis ends above the horizon, micronormals"],
        delta: ["rad", "shift of the closest points"], width: ["chord", "width of the lobe"], length: ["chord", "length of the axis"],
        zeta: ["", "(length − width) / length"], radius: ["chord", "of a sample: filtered for alpha = radius"],
    },
};

export class Numbers {
    constructor(core, place, lines) {
        const words = textAt(core, core.page_number_names()).split(" ");
        this.counts = [];
        for (let i = 0; i < words.length; i += 2) this.counts.push([words[i], Number(words[i + 1])]);
        this.core = core;
        this.out = new Doubles(core, this.counts.reduce((sum, [, count]) => sum + count, 0));
        this.lines = lines;
        this.cells = {};
        for (const [title, group] of Object.entries(rows)) this.addTable(place, title, group);
    }

    addTable(place, title, group) {
        const table = document.createElement("table"), body = document.createElement("tbody");
        table.createCaption().textContent = title;
        for (const [name, [unit, meaning]] of Object.entries(group)) {
            const row = body.insertRow(), head = document.createElement("th"), cell = document.createElement("td"),
                  note = document.createElement("td");
            head.scope = "row", head.textContent = name, row.append(head);
            cell.dataset.name = name, cell.className = "number", row.append(cell);
            note.className = "note", note.textContent = unit ? `${meaning} [${unit}]` : meaning, row.append(note);
            this.cells[name] = cell;
        }
        table.append(body);
        place.append(table);
    }

    // Asks the core; arrays by name.
    ask(material, query) {
        this.core.page_numbers(material, query, this.out.place);
        const numbers = {};
        let at = 0;
        for (const [name, count] of this.counts) numbers[name] = [...this.out.view().slice(at, at += count)];
        return numbers;
    }

    show(state, numbers) {
        for (const [name, values] of Object.entries(numbers)) {
            const text = values.map((x) => (Number.isFinite(x) ? String(x) : x > 0 ? "∞" : x < 0 ? "−∞" : "none"));
            this.cells[name].textContent = text.join("\n");
        }
        this.lines.eval.textContent = evalLine(state, numbers);
        this.lines.axis.textContent = axisLine(state, numbers);
    }
}

// SPDX-License-Identifier: MIT
// SPDX-FileCopyrightText: 2026 The musurf authors
// main.js: the page: one state, shown by every part of it, changed by any.
import { Doubles, bytesOfBase64, loadCore, namesOf } from "./core.js";
import { Controls } from "./controls.js";
import { anglesOf, directionOf, directionOfDisc, directionOfSpot, discOf, spotOf } from "./direction.js";
import { Handle } from "./handle.js";
import { LobePanel } from "./lobe_panel.js";
import { MapPanel } from "./map_panel.js";
import { Numbers } from "./numbers.js";
import { materialNumbers, queryNumbers } from "./question.js";
import { SphereView } from "./sphere_view.js";
import { defaults, presetState, presets, stateOfText, textOfState } from "./state.js";
import { Team } from "./team.js";

const byId = (id) => document.getElementById(id);
const PANEL = { moving: 112, still: 240 }, REST = 150; // pixels of a panel, and after how many ms it is at rest
const PATIENCE = 3, READABLE = 4; // frames of the browser's that the sphere is waited for; while all moves, numbers are shown in one of so many
const SPHERE = 0.88; // radius in its picture

// The color of densities, as bytes r, g, b.
function inkOfTheme() {
    const code = getComputedStyle(document.documentElement).getPropertyValue("--ink").trim().slice(1);
    return parseInt(code.slice(4, 6) + code.slice(2, 4) + code.slice(0, 2), 16);
}

class Page {
    constructor(core, team, choices) {
        this.core = core;
        this.choices = choices;
        this.material = core.page_material_new();
        this.materialPlace = new Doubles(core, materialNumbers(defaults, choices).length);
        this.query = new Doubles(core, queryNumbers(defaults).length);
        this.controls = new Controls(document, choices, (part) => this.change(part));
        this.map = new MapPanel(byId("map"), (M) => this.change({ M }));
        this.panels = ["slopes", "normals", "reflected"].map(
            (name, space) => new LobePanel(core, space, byId(`${name}-picture`), byId(name), PANEL.still));
        this.numbers = new Numbers(core, byId("numbers"), { eval: byId("eval-line"), axis: byId("axis-line") });
        this.sphere = new SphereView(team, byId("sphere-picture"), byId("sphere-behind"), byId("status"), choices);
        this.waited = this.unread = 0;
        this.addHandles();
        this.addButtons();
        addEventListener("hashchange", () => location.hash.slice(1) !== textOfState(this.state) && this.replace(stateOfText(location.hash, choices)));
        matchMedia("(prefers-color-scheme: dark)").addEventListener("change", () => this.repaint());
        this.replace(structuredClone(defaults)); // what is shown where the address asks for none
        this.replace(stateOfText(location.hash, choices));
    }

    // Directions are moved in discs by the pointer, by keys as two angles.
    addHandles() {
        const add = (svg, name, key, label, directionAt) => new Handle(svg, {
            name, label,
            moved: (x, y) => this.change({ [key]: anglesOf(directionAt(x, y)) }),
            stepped: (right, up) => {
                const [theta, phi] = this.state[key];
                this.change({ [key]: [Math.min(Math.max(theta + up, 0), 89.9), (phi - right + 540) % 360 - 180] });
            },
        });
        const inDisc = (panel) => [(x, y) => directionOfDisc(...panel.inPlane(x, y)), (w) => panel.inPanel(discOf(w))];
        const [, normals, reflected] = this.panels.map(inDisc);
        const onSphere = [(x, y) => directionOfSpot(x / SPHERE, y / SPHERE), (w) => spotOf(w).map((c) => c * SPHERE)];
        const view = "direction toward the viewer: up and down its angle from the normal, left and right its azimuth";
        const light = "direction toward the light: up and down its angle from the normal, left and right its azimuth";
        const all = [["normals", "wo", "view", view, normals], ["reflected", "wo", "view", view, reflected],
                     ["reflected", "wi", "light", light, reflected], ["sphere", "wo", "view", "place on the sphere that is looked at; " + view, onSphere]];
        this.handles = all.map(([id, name, key, label, [directionAt, placeOf]]) => [add(byId(id), name, key, label, directionAt), key, placeOf]);
    }

    addButtons() {
        const list = byId("preset");
        for (const name of Object.keys(presets)) list.add(new Option(name, name));
        list.addEventListener("input", () => list.value && this.replace(presetState(list.value)));
        byId("reset").addEventListener("click", () => this.replace(structuredClone(defaults)));
        byId("play").addEventListener("click", () => this.play(!this.playing));
        byId("theme").addEventListener("click", () => {
            const dark = getComputedStyle(document.documentElement).colorScheme.trim() === "dark";
            document.documentElement.dataset.theme = dark ? "light" : "dark";
            this.repaint();
        });
        for (const button of document.querySelectorAll("[data-copy]"))
            button.addEventListener("click", () => this.copy(button));
    }

    async copy(button) {
        const text = button.dataset.copy === "link" ? location.href : byId(button.dataset.copy).textContent;
        try {
            await navigator.clipboard.writeText(text);
            button.textContent = "copied";
        } catch (error) { // not allowed from everywhere
            button.textContent = button.dataset.copy === "link" ? "it is in the address bar" : "select it and copy";
        }
        setTimeout(() => (button.textContent = "copy"), 1500);
    }

    // Turns the light by 30 degrees a second.
    play(on) {
        this.playing = on;
        byId("play").textContent = on ? "❚❚ stop the light" : "▶ turn the light";
        byId("play").setAttribute("aria-pressed", on);
        let before = performance.now();
        const turn = (now) => {
            if (!this.playing) return;
            const to = this.state.turn + 0.03 * (now - before);
            before = now;
            this.state = { ...this.state, turn: (to + 540) % 360 - 180 };
            this.controls.state = this.state;
            this.controls.show();
            this.sphere.show(this.state);
            requestAnimationFrame(turn);
        };
        if (on) requestAnimationFrame(turn);
        else this.change({ turn: Math.round(this.state.turn * 10) / 10 });
    }

    change(part) {
        byId("preset").value = "";
        this.replace({ ...this.state, ...part });
    }

    replace(state) {
        const set = this.core.page_material_set(this.material, this.materialPlace.set(materialNumbers(state, this.choices)));
        const at = (place) => new TextDecoder().decode(new Uint8Array(this.core.memory.buffer).slice(place, place + 200)).split("\0")[0];
        byId("complaint").textContent = set ? "" : `${at(this.core.page_material_field(this.material))}: ${at(this.core.page_material_complaint(this.material))}`;
        this.state = this.controls.state = state;
        this.map.M = state.M;
        this.ask();
        if (!set) return; // the pictures stay those of the last material that is one
        this.drawn = state;
        this.changed = performance.now();
        this.sphere.show(state);
        clearTimeout(this.remembering);
        this.remembering = setTimeout(() => this.remember(), 300);
    }

    // In the address, for a link or a bookmark.
    remember() {
        const text = textOfState(this.state);
        try {
            history.replaceState(null, "", "#" + text);
        } catch (error) {
            location.hash = text;
        }
    }

    repaint() {
        this.ink = undefined;
        this.show();
    }

    ask() {
        if (!this.asked) this.asked = requestAnimationFrame(() => this.follow());
    }

    // Once per picture of the sphere, if it comes soon: more often the browser's drawing would only take the sphere's time.
    follow() {
        const { sphere } = this, late = sphere.busy && sphere.frames === this.followed && this.waited < PATIENCE;
        this.waited = late ? this.waited + 1 : 0;
        this.asked = 0;
        if (late) return this.ask();
        this.followed = sphere.frames;
        this.show(this.drawn === this.shown || ++this.unread % READABLE === 0);
    }

    show(digits = true) {
        this.controls.show();
        this.map.show();
        const { drawn: state } = this, query = this.query.set(queryNumbers(state));
        const numbers = this.numbers.ask(this.material, query);
        const moving = performance.now() - this.changed < REST, size = moving ? PANEL.moving : PANEL.still;
        clearTimeout(this.settling);
        if (moving) this.settling = setTimeout(() => this.show(), REST);
        this.ink ??= inkOfTheme();
        for (const panel of this.panels) panel.show(this.material, query, state, numbers.slope_sigma, directionOf(state.view), size, this.ink);
        for (const [handle, key, place] of this.handles)
            handle.put(...place(directionOf(state[key])), `${state[key][0]}° from the normal, azimuth ${state[key][1]}°`);
        this.shown = state;
        if (digits) this.numbers.show(state, numbers);
        else this.ask();
        byId("alpha").textContent = `α = ${Number((state.roughness ** 2).toPrecision(4))}`;
        byId("determinant").textContent = `det M = ${Number((state.M[0] * state.M[3] - state.M[1] * state.M[2]).toPrecision(4))}`;
        document.documentElement.dataset.shown = Number(document.documentElement.dataset.shown ?? 0) + 1;
    }
}

async function begin() {
    try {
        if (typeof WebAssembly !== "object") throw new Error("this browser has no WebAssembly");
        const bytes = bytesOfBase64(byId("wasm").textContent), core = await loadCore(bytes);
        const choices = {
            ndf: namesOf(core, (i) => core.page_choice(0, i)),
            masking: namesOf(core, (i) => core.page_choice(1, i)),
            metal: ["none", ...namesOf(core, (i) => core.page_choice(2, i))],
            technique: namesOf(core, core.page_technique_name),
            surroundings: namesOf(core, core.page_surroundings_name),
            appendix_c: ["symmetric", "printed"], size: ["adaptive", "256", "512", "768"], panels: ["hemisphere", "close up"],
        };
        const threads = Math.min(Math.max(navigator.hardwareConcurrency || 2, 1), 4);
        const team = await Team.make(byId("worker").textContent, bytes, threads);
        globalThis.musurf = new Page(core, team, choices);
        document.documentElement.dataset.ready = team.count;
    } catch (error) {
        byId("failure").hidden = false;
        byId("why").textContent = String(error.message ?? error);
        console.warn(error);
    }
}

begin();

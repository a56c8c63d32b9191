// SPDX-License-Identifier: MIT
// SPDX-FileCopyrightText: 2026 The musurf authors
// state.js: all that a person can set, by names that also stand in the address; and sets of it worth a look.
// Angles in degrees: from the normal, and counter-clockwise from x. M: its two rows.

export const defaults = Object.freeze({
    ndf: "gtr", roughness: 0.4, gamma: 2, exponent: 20, M: [1, 2, 0, 1], masking: "height_correlated", metal: "Ag",
    view: [50, -155], light: [46, 20],
    N: 8, k: 1, beta: 2.3, appendix_c: "symmetric",
    technique: "major axis", surroundings: "studio", turn: 0, exposure: 1, size: "adaptive", panels: "hemisphere",
});

export const ranges = Object.freeze({
    roughness: [0, 1], gamma: [0, 10], exponent: [0, 1000], N: [1, 64], k: [0.1, 3], beta: [0, 10], turn: [-180, 180], exposure: [0.1, 10],
    "view.0": [0, 89.9], "view.1": [-180, 360], "light.0": [0, 89.9], "light.1": [-180, 360],
});

const plate = { ndf: "gtr", roughness: 0.11, gamma: 1.7, metal: "Ag", panels: "close up" }; // alpha 0.0121
export const presets = Object.freeze({
    "Skewed, rough": {},
    "Figure 1: plate": { ...plate, M: [1, 0, 0, 1] },
    "Figure 1: stretched 5×": { ...plate, M: [5, 0, 0, 1] },
    "Figure 1: skewed": { ...plate, M: [1, 2, 0, 1] },
    "Brushed aluminium": { ndf: "ggx", roughness: 0.45, M: [2.4, 0, 0, 0.42], metal: "Al", surroundings: "studio" },
    "Brushed gold, turned": { ndf: "ggx", roughness: 0.45, M: [1.41, 0.99, 0.99, 1.41], metal: "Au", surroundings: "sky" },
    "Long tail": { ndf: "gtr", roughness: 0.15, gamma: 1, M: [1, 0, 0, 1], metal: "Cu", surroundings: "lamps" },
    "Mirrored (det M < 0)": { ndf: "beckmann", roughness: 0.22, M: [-0.8, 1.4, 0.5, 0.6], metal: "none", surroundings: "lamps" },
    "Velvet, sheared": { ndf: "sheen", roughness: 0.6, M: [1.5, 0.8, 0, 1], metal: "none", surroundings: "sky" },
});

export function presetState(name) {
    return { ...structuredClone(defaults), ...structuredClone(presets[name]) };
}

// The part of the state that is not as at the start, as text behind the #.
export function textOfState(state) {
    return Object.keys(defaults)
        .filter((key) => String(state[key]) !== String(defaults[key]))
        .map((key) => `${key}=${encodeURIComponent(String(state[key])).replaceAll("%2C", ",")}`)
        .join("&");
}

function valueOf(key, coded) {
    const like = defaults[key];
    let text;
    try {
        text = decodeURIComponent(coded);
    } catch (error) { // an address that was cut
        return undefined;
    }
    if (typeof like === "string") return text;
    const numbers = text.split(",").map(Number);
    const right = Array.isArray(like) ? like.length : 1;
    if (numbers.length !== right || !numbers.every(Number.isFinite)) return undefined;
    return Array.isArray(like) ? numbers : numbers[0];
}

// What an address says over the state at the start; what it does not know is passed over.
export function stateOfText(text, choices) {
    const state = structuredClone(defaults);
    for (const part of text.replace(/^#/, "").split("&")) {
        const [key, ...rest] = part.split("=");
        if (!(key in defaults)) continue;
        const value = valueOf(key, rest.join("="));
        if (value === undefined || (choices[key] && !choices[key].includes(value))) continue;
        state[key] = within(key, value);
    }
    return state;
}

// Held in its range.
export function within(key, value) {
    if (Array.isArray(value)) return value.map((each, i) => within(`${key}.${i}`, each));
    const range = ranges[key];
    if (!range || typeof value !== "number") return value;
    const held = Math.min(Math.max(value, range[0]), range[1]);
    return key === "N" ? Math.round(held) : held;
}

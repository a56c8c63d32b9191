// SPDX-License-Identifier: MIT
// SPDX-FileCopyrightText: 2026 The musurf authors
// question.js: the state as the core takes it (material.h, numbers.h, sphere.c), and as lines for the command musurf.
import { directionOf } from "./direction.js";

export const distributions = {
    ggx: [], beckmann: [], gtr: ["gamma"], std: ["gamma"], phong: ["exponent"], sheen: [],
};

export function materialNumbers(state, choices) {
    return [choices.ndf.indexOf(state.ndf), state.roughness, state.gamma, state.exponent, ...state.M,
            choices.masking.indexOf(state.masking), choices.metal.indexOf(state.metal)];
}

export function queryNumbers(state) {
    return [...directionOf(state.view), ...directionOf(state.light), state.k, state.beta, state.N,
            state.appendix_c === "printed" ? 1 : 0];
}

// The lamp stands 35 degrees up, at azimuth -125 when nothing is turned.
export function sphereNumbers(state, size, choices) {
    const turn = state.turn * Math.PI / 180;
    return [size, choices.technique.indexOf(state.technique), turn, state.exposure, ...directionOf([55, state.turn - 125])];
}

function materialObject(state) {
    const material = { material: "musurf.microfacet", ndf: state.ndf };
    if (state.ndf !== "phong") material.roughness = state.roughness;
    for (const key of distributions[state.ndf]) material[key] = state[key];
    material.transform = [state.M.slice(0, 2), state.M.slice(2)];
    if (state.masking !== "height_correlated") material.masking = state.masking;
    if (state.metal !== "none") material.fresnel = { conductor: state.metal };
    return material;
}

export function evalLine(state, numbers) {
    return JSON.stringify({ material: materialObject(state), wo: directionOf(state.view), wi: directionOf(state.light), wm: numbers.wm });
}

export function axisLine(state, numbers) {
    return JSON.stringify({ sigma: numbers.slope_sigma, angle: numbers.angle[0], wo: directionOf(state.view),
                            k: state.k, N: state.N, beta: state.beta, appendix_c: state.appendix_c });
}

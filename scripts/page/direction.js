// SPDX-License-Identifier: MIT
// SPDX-FileCopyrightText: 2026 The musurf authors
// direction.js: directions as two angles, as points of a disc, as points of the sphere: where handles stand and what dragging them says.

const degree = Math.PI / 180;

export function directionOf([theta, phi]) {
    const flat = Math.sin(theta * degree);
    return [flat * Math.cos(phi * degree), flat * Math.sin(phi * degree), Math.cos(theta * degree)];
}

// To a tenth of a degree; the azimuth in (-180, 180].
export function anglesOf([x, y, z]) {
    const round = (angle) => Math.round(angle / degree * 10) / 10 + 0;
    return [round(Math.atan2(Math.hypot(x, y), z)), round(Math.atan2(y, x))];
}

// The equal-area disc of panel.h, horizon at 1.
export function discOf([x, y, z]) {
    const scale = 1 / Math.sqrt(1 + z);
    return [x * scale, y * scale];
}
export function directionOfDisc(x, y) {
    const r = Math.hypot(x, y), most = 0.9995;
    if (r > most) x *= most / r, y *= most / r;
    const z = 1 - (x * x + y * y), scale = Math.sqrt(1 + z);
    return [x * scale, y * scale, z];
}

// Where on the sphere (sphere.c) the viewer is seen in direction wo: x to the right, y up, radius 1.
export function spotOf([x, y, z]) {
    const across = Math.sqrt(Math.max(1 - x * x, 1e-12));
    return [-x * z / across, -y / across];
}
export function directionOfSpot(x, y) {
    const r = Math.hypot(x, y), most = 0.9995;
    if (r > most) x *= most / r, y *= most / r;
    const front = Math.sqrt(1 - x * x - y * y), flat = Math.hypot(x, front);
    return [-x / flat, -y * front / flat, front];
}

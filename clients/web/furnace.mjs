// In the page: white metal under lights from everywhere, all of the sphere's picture and a line of
// it.

import { furnace, line, metal } from './metal.mjs';

const SIDE = 48;

/// What a sphere returns of a sky of lights, and the cosine of the view, by pixel.
window.furnace = (roughness, table) => {
    const sum = furnace(metal(0xffffff, roughness, table), [-1, 1, 1, -1], [SIDE, SIDE]);
    const pixels = [];
    for (let i = 0; i < sum.length; ++i) {
        const [x, y] = [i % SIDE, Math.floor(i / SIDE)].map(at => (2 * at + 1) / SIDE - 1);
        const square = 1 - x * x - y * y;
        if (square > 0) pixels.push({ mu: Math.sqrt(square), value: sum[i] });
    }
    return pixels;
};

/// The same along a line from the middle to the edge.
window.line = (roughness, table, count) => line(metal(0xffffff, roughness, table), 96, count);

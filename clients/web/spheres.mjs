// In the page: rows of spheres by roughness, of three.js' material as it ships and with our table
// below, in a furnace and under one light; and the numbers that are written below each.

import { REVISION, Color, LinearSRGBColorSpace } from 'three';
import { lamp, line, metal, off } from './metal.mjs';

/// Pixels along a picture's side, and samples from the middle of a sphere to its edge.
const SIDE = 208, LINE = 104;
/// The deviation that has the full colour; three.js' table is off by a little more.
const FULL = 0.1;
const LOST = [22, 84, 196], GAINED = [214, 90, 0];
const GOLD = new Color().setRGB(1, 0.766, 0.336, LinearSRGBColorSpace);
const DIRECTION = [-0.5, 0.6, 0.75], INTENSITY = 4;

/// Of the columns; an address that ends in ?roughness=0.25,1 has others.
const asked = new URLSearchParams(location.search).get('roughness') ?? '';
const ROUGHNESS = asked
    ? asked.split(',').map(Number) : [0.1, 0.2, 0.3, 0.4, 0.5, 0.6, 0.7, 0.8, 0.9, 1];

/// Lights by roughness: many within every lobe, which is as wide as the square of it.
const lights = roughness => 8192 * Math.ceil(Math.max(1, 0.16 / roughness ** 2));

/// The colour of a deviation: white is none, and a root shows small ones.
function colour(deviation) {
    const share = Math.sqrt(Math.min(1, Math.abs(deviation) / FULL));
    return (deviation < 0 ? LOST : GAINED).map(end => 255 + (end - 255) * share);
}

/// A value of light as displays show it.
const shown = x => 255 * (x <= 0.0031308 ? 12.92 * x : 1.055 * Math.min(1, x) ** (1 / 2.4) - 0.055);

/// Fills a canvas by a function of the pixel, which returns its RGBA, the highest row first.
function paint(canvas, width, height, pixel) {
    Object.assign(canvas, { width, height });
    const context = canvas.getContext('2d');
    const image = context.createImageData(width, height);
    for (let i = 0; i < width * height; ++i) {
        image.data.set(pixel(i % width, Math.floor(i / width)), 4 * i);
    }
    context.putImageData(image, 0, 0);
}

/// The picture that a line from the middle to the edge is of, with a thin edge to see where it is.
function paintFurnace(canvas, pixels) {
    paint(canvas, SIDE, SIDE, (x, y) => {
        const r = Math.hypot(2 * x + 1 - SIDE, 2 * y + 1 - SIDE) / SIDE;
        const at = Math.max(0, r * LINE - 0.5), i = Math.min(LINE - 1, Math.floor(at));
        const [a, b] = [pixels[i], pixels[Math.min(LINE - 1, i + 1)]].map(({ value }) => value);
        const edge = Math.max(0, 1 - Math.abs(1 - r) * SIDE / 2 / 1.5);
        const inside = r < 1 ? colour(a + (b - a) * (at - i) - 1) : [255, 255, 255];
        return [...inside.map(c => c + (150 - c) * edge), 255];
    });
}

function paintLamp(canvas, values) {
    paint(canvas, SIDE, SIDE, (x, y) => {
        const at = 4 * ((SIDE - 1 - y) * SIDE + x);
        const covered = values[at + 3] > 0 ? 255 : 0;
        return [...values.slice(at, at + 3)].map(shown).concat(covered);
    });
}

const total = values => values.reduce((sum, x, i) => (i % 4 === 3 ? sum : sum + x), 0);

function element(parent, name, text = '') {
    const made = parent.appendChild(document.createElement(name));
    made.textContent = text;
    return made;
}

/// The cells of both rows of a section, by row and roughness.
function rows(section, table) {
    const texels = table.axes_slowest_first.map(axis => axis.texels).join(' × ');
    const grid = element(document.getElementById(section), 'table');
    const head = element(element(grid, 'thead'), 'tr');
    element(head, 'th', 'roughness').scope = 'col';
    for (const roughness of ROUGHNESS) element(head, 'th', roughness).scope = 'col';
    const body = element(grid, 'tbody');
    const both = [['three.js', 'as it ships'], ['our table', `${texels} halves`]];
    return both.map(([name, what]) => {
        const row = element(body, 'tr'), head = element(row, 'th', name);
        head.scope = 'row';
        element(head, 'small', what);
        return ROUGHNESS.map(roughness => {
            const cell = element(row, 'td');
            const canvas = element(cell, 'canvas');
            canvas.setAttribute('role', 'img');
            canvas.setAttribute('aria-label', `${name}, roughness ${roughness}`);
            return { canvas, number: element(cell, 'div', '…') };
        });
    });
}

/// Lets the browser show what is drawn so far.
const pause = () => new Promise(resolve => setTimeout(resolve));

async function draw() {
    document.getElementById('release').textContent = `r${REVISION}`;
    for (const deviation of [-0.1, -0.01, -0.001, 0.001, 0.01, 0.1]) {
        const sign = deviation < 0 ? '−' : '+';
        const of = element(document.getElementById('scale'), 'span', sign + Math.abs(deviation));
        of.style.background = `rgb(${colour(deviation)})`;
        of.classList.toggle('strong', Math.abs(deviation) === FULL);
    }
    const ours = await (await fetch('/table.json')).json();
    const [furnaces, lamps] = ['furnace', 'lamp'].map(section => rows(section, ours));
    for (const [i, roughness] of ROUGHNESS.entries()) {
        const [own, other] = [null, ours].map(table =>
            lamp(metal(GOLD, roughness, table), DIRECTION, INTENSITY, SIDE));
        for (const [row, values] of [own, other].entries()) {
            paintLamp(lamps[row][i].canvas, values);
            const percent = 100 * total(values) / total(own);
            lamps[row][i].number.textContent = `${percent.toFixed(1)} %`;
        }
        await pause();
    }
    // The rough ones first, which take fewer lights.
    for (const i of [...ROUGHNESS.keys()].reverse()) {
        for (const [row, table] of [null, ours].entries()) {
            const roughness = ROUGHNESS[i];
            const pixels = line(metal(0xffffff, roughness, table), LINE, lights(roughness));
            paintFurnace(furnaces[row][i].canvas, pixels);
            furnaces[row][i].number.textContent = off(pixels).toFixed(4);
            await pause();
        }
    }
    document.documentElement.dataset.drawn = 'true';
}

draw().catch(error => {
    element(document.querySelector('main'), 'p', `${error}`).setAttribute('role', 'alert');
    throw error;
});

// Exported WGSL as nodes of three.js: how its parser reads functions, and, where the browser has
// WebGPU, what materials of them shade, against the reference of the model.

import assert from 'node:assert/strict';
import { readFileSync } from 'node:fs';
import { join } from 'node:path';
import { after, before, test } from 'node:test';
import WGSLNodeParser from 'three/src/renderers/webgpu/nodes/WGSLNodeParser.js';
import { FOLDER, launch, serve } from './harness.mjs';
import { closedNodes, lobeNodes } from './nodes.mjs';

const read = (...path) => readFileSync(join(FOLDER, ...path), 'utf8');
const CLOSED = read('wgsl', 'student_t_closed.wgsl');
const SHAPES = read('wgsl', 'student_t.wgsl');

/// Inputs, and what the model has for them in double precision; `e` is NaN where it has none.
const [HEADER, ...LINES] = readFileSync(
    join(import.meta.dirname, '../../docs/reference.csv'), 'utf8').trim().split('\n');
const NAMES = HEADER.split(',');
const number = text => (text === 'inf' ? Infinity : Number(text || NaN));
const REFERENCE = LINES.map(line => {
    const cells = line.split(',');
    const of = name => cells[NAMES.indexOf(name)];
    const vector = names => names.split(' ').map(name => number(of(name)));
    const [sigma, m, v, l] = ['sigma_x sigma_y', 'mx my mz', 'vx vy vz', 'lx ly lz'].map(vector);
    const [d, g1, g2, e] = vector('d_exact g1_exact g2_exact e_exact');
    const [kind, masking] = [of('case'), of('masking')];
    return { kind, masking, gamma: number(of('gamma')), sigma, m, v, l, d, g1, g2, e };
}).filter(({ kind, masking, l }) => ['middle', 'anisotropic', 'shape', 'grazing'].includes(kind)
    && masking === 'height-correlated' && l[2] > 0);

/// D, as the paper prints it.
function distribution(gamma, [x, y], m) {
    const slope = ((m[0] / x) ** 2 + (m[1] / y) ** 2) / m[2] ** 2, s = gamma - 1;
    const power = gamma === Infinity ? Math.exp(-slope) : (1 + slope / s) ** -gamma;
    return power / (Math.PI * x * y * m[2] ** 4);
}

/// f with F = 1.
function brdf({ gamma, sigma, v, l, g2 }) {
    const sum = v.map((x, i) => x + l[i]);
    const d = distribution(gamma, sigma, sum.map(x => x / Math.hypot(...sum)));
    return d * g2 / (4 * v[2] * l[2]);
}

const parse = text => new WGSLNodeParser().parseFunction(text);
function signature({ name, type, inputs }) {
    return `${name}(${inputs.map(input => `${input.name}: ${input.type}`).join(', ')}) ${type}`;
}

test('the parser has names, inputs and types of all nodes', () => {
    const of = nodes => Object.values(nodes).map(node => signature(parse(node.code)));
    assert.deepEqual(of(closedNodes(CLOSED)), [
        'closed_d(gamma: float, sigma: vec2, m: vec3) float',
        'closed_masking(gamma: float, sigma: vec2, w: vec3) float',
        'closed_albedo(gamma: float, sigma: float, cos_theta: float) float',
    ]);
    for (const isFamily of [false, true]) {
        const first = isFamily ? 'lobe_at(gamma: float' : 'lobe_of(shape: uint';
        assert.deepEqual(of(lobeNodes(SHAPES, isFamily)), [
            `${first}, sigma: vec2, tables: texture) StudentTLobe`,
            // Structures of a module have no name as inputs, and are handed on as they are.
            'lobe_d(lobe: undefined, m: vec3) float',
            'lobe_masking(lobe: undefined, w: vec3, tables: texture) float',
            'lobe_albedo(lobe: undefined, cos_theta: float, tables: texture) float',
            'lobe_eval_pdf(lobe: undefined, v: vec3, l: vec3, tables: texture) vec2',
        ]);
    }
});

test('of a whole module the parser takes the first function alone', () => {
    assert.equal(parse(CLOSED).name, 'student_t_closed_between');
    assert.equal(parse(SHAPES).name, 'student_t_impl_pair');
});

let browser, page, hasAdapter;

before(async () => {
    browser = await launch(['--enable-unsafe-webgpu', '--use-webgpu-adapter=swiftshader']);
    page = await serve(browser, 'nodes.html');
    await page.waitForFunction(() => window.shadeLobes);
    hasAdapter = await page.evaluate(async () => Boolean(await navigator.gpu?.requestAdapter()));
});

after(() => browser.close());

/// Compares what a page shades with the model: `allowed` has the largest error of each result.
function compare(name, shade, shapeOf, allowed) {
    test(name, async test => {
        if (!hasAdapter) return test.skip('this browser has no WebGPU');
        const errors = [];
        const listen = message => message.type() === 'error' && errors.push(message.text());
        page.on('console', listen);
        const found = await shade(REFERENCE.map(row => ({ ...row, shape: shapeOf(row.gamma) })));
        page.off('console', listen);
        assert.deepEqual(errors, []);
        const worst = allowed.map(() => 0);
        REFERENCE.forEach((row, i) => allowed.forEach(([expected, limit, holds], j) => {
            if (holds && !holds(row)) return;
            const error = Math.abs(found[i][j] - expected(row)) / limit(row);
            worst[j] = error <= worst[j] ? worst[j] : error; // NaN as well
        }));
        const shares = worst.map(error => error.toFixed(3));
        test.diagnostic(`${REFERENCE.length} rows, of what is allowed: ${shares.join(', ')}`);
        assert.ok(worst.every(error => error <= 1), `${worst}`);
    });
}

/// Albedos are those of round lobes.
const isRound = ({ sigma, e }) => sigma[0] === sigma[1] && !Number.isNaN(e);
const isFitted = row => isRound(row) && row.gamma >= 1.6 && row.sigma[0] <= 1 && row.v[2] >= 0.02;
const finite = gamma => Math.min(gamma, 1e18);
const D = [row => row.d, row => 1e-4 * row.d];

compare(
    'closed forms shade as the model',
    rows => page.evaluate(([text, rows]) => window.shadeClosed(text, rows), [CLOSED, rows]),
    finite,
    [D, [row => row.g1, () => 1e-3], [row => row.e, () => 7e-3, isFitted]]);

for (const [what, folder, name] of [
    ['single shapes', 'wgsl', 'student_t'], ['a family', 'wgsl-family', 'student_t_family'],
]) {
    const isFamily = folder === 'wgsl-family';
    const { width, height, shapes = {} } = JSON.parse(read(folder, `${name}.json`));
    const base64 = readFileSync(join(FOLDER, folder, `${name}.bin`), 'base64');
    const given = [read(folder, `${name}.wgsl`), { base64, width, height }, isFamily];
    const offsets = new Map(Object.entries(shapes).map(([key, of]) => [number(key), of.offset]));
    compare(
        `lobes of ${what} shade as the model`,
        rows => page.evaluate(
            ([rows, text, tables, isFamily]) => window.shadeLobes(text, rows, tables, isFamily),
            [rows, ...given]),
        isFamily ? finite : gamma => offsets.get(gamma),
        [D, [row => row.g1, () => 1e-5], [row => row.e, () => 2.5e-4, isRound],
            [brdf, row => 1e-4 * brdf(row)]]);
}

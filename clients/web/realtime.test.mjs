// The kit for real time in WebGL 2: the sphere of its program is that of the exact module.

import assert from 'node:assert/strict';
import { readFileSync, writeFileSync } from 'node:fs';
import { join } from 'node:path';
import { after, before, test } from 'node:test';
import { FOLDER, launch, serve } from './harness.mjs';

let browser, page;

before(async () => {
    browser = await launch();
    page = await serve(browser, 'realtime.html');
    await page.waitForFunction(() => window.draw);
});

after(() => browser.close());

const text = (...names) => readFileSync(join(FOLDER, ...names), 'utf8');

/// The exact module of a shape, with its tables.
function exact(gamma) {
    const folder = 'glsl-of-shapes';
    const { width, height, shapes } = JSON.parse(text(folder, 'student_t.json'));
    const bytes = readFileSync(join(FOLDER, folder, 'student_t.bin')).toString('base64');
    return {
        text: text(folder, 'student_t.glsl') + text(folder, 'student_t_sample.frag'),
        tables: { size: [width, height], bytes, offset: shapes[`${gamma}`].offset },
    };
}

/// The kit, with its textures.
function kit() {
    const folder = 'realtime-es';
    const told = JSON.parse(text(folder, 'student_t_realtime.json')).textures;
    const textures = Object.fromEntries(Object.entries(told).map(([name, one]) => {
        const { file, size, offset, bytes } = one;
        const texels = readFileSync(join(FOLDER, folder, file)).subarray(offset, offset + bytes);
        return [name, { size, bytes: texels.toString('base64') }];
    }));
    const module = text(folder, 'student_t_realtime.glsl');
    return { text: module + text(folder, 'student_t_realtime_sample.frag'), textures };
}

/// The largest difference of two pictures, in steps of 8 bits, and what share of pixels are lit.
async function difference(gamma, sigma, of_kit = gamma) {
    const [light, metal] = [[0.48, 0.6, 0.64], [0.95, 0.64, 0.54]];
    const draw = (what, gamma) => {
        const uniforms = { gamma, sigma, light, metal };
        return page.evaluate(what => window.draw(what), { ...what, uniforms });
    };
    const [a, b] = [await draw(exact(gamma), gamma), await draw(kit(), of_kit)];
    const lit = a.filter((x, i) => i % 4 === 0 && x > 8).length / (a.length / 4);
    // Beside the sphere one has no opacity.
    const of = (x, i) => i % 4 === 3 ? 0 : Math.abs(x - b[i]);
    const largest = a.reduce((most, x, i) => Math.max(most, of(x, i)), 0);
    return { largest, lit };
}

test('spheres of the kit are those of the exact module', async test => {
    for (const gamma of [1.65, 2, 3, 40]) {
        for (const sigma of [[0.1, 0.1], [0.8, 0.4]]) {
            const { largest, lit } = await difference(gamma, sigma);
            test.diagnostic(`gamma ${gamma}, sigma ${sigma}: ${largest} of 255`);
            assert.ok(lit > 0.05, `${lit} is lit`);
            assert.ok(largest <= 2, `gamma ${gamma}, sigma ${sigma}: ${largest}`);
        }
    }
    // Another gamma is told apart.
    assert.ok((await difference(3, [0.4, 0.4], 2.5)).largest > 2);
});

test('a picture, if there is a folder for it', { skip: !process.env.SHOTS }, async () => {
    writeFileSync(join(process.env.SHOTS, 'realtime.png'), await page.screenshot());
});

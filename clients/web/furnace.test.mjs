// White metal of three.js under direct lights from everywhere, which must return all of them.

import assert from 'node:assert/strict';
import { readFileSync } from 'node:fs';
import { join } from 'node:path';
import { after, before, test } from 'node:test';
import { FOLDER, launch, serve } from './harness.mjs';

const [TABLE, SMALL] = ['lut', 'lut16'].map(folder =>
    JSON.parse(readFileSync(join(FOLDER, folder, 'lut.json'), 'utf8')));
/// E over the coordinates of three.js, but with texels at the ends, in the form that Cycles reads:
/// in as many texels, and in four times as many.
const ENDS = [16, 32].map(texels => {
    const text = readFileSync(join(FOLDER, `ends${texels}`, 'shader.tables'), 'utf8');
    const [, numbers] = text.match(/table_ggx_E\[\d+\] = \{([^}]*)\}/);
    return { texels, data: numbers.match(/[\d.]+(?=f)/g).map(Number) };
});

let browser, page;

before(async () => {
    browser = await launch();
    page = await serve(browser, 'furnace.html');
    await page.waitForFunction(() => window.furnace);
});

after(() => browser.close());

/// What pixels with a cosine of 0.1 and more differ from 1 by, of a picture of the sphere, by
/// `furnace`, or of a `line` of it.
async function differences(name, roughness, table, count) {
    const pixels = await page.evaluate(
        ([name, ...of]) => window[name](...of), [name, roughness, table, count]);
    return pixels.filter(({ mu }) => mu >= 0.1).map(({ value }) => value - 1);
}

/// The largest of them.
async function off(roughness, table) {
    const seen = await differences('furnace', roughness, table);
    assert.ok(seen.length > 1000);
    return Math.max(...seen.map(Math.abs));
}

test('our coordinates return all light of rough metal, that of three.js does not', async test => {
    for (const roughness of [0.3, 0.6, 0.8, 1]) {
        const found = [];
        for (const table of [null, ...ENDS, TABLE]) found.push(await off(roughness, table));
        const [own, ends, finer, ours] = found.map(x => x.toFixed(4));
        test.diagnostic(`roughness ${roughness}: ${own} by its table, with texels at the ends `
            + `${ends}, in 32 × 32 ${finer}; ${ours} by ours`);
        assert.ok(ours <= 5e-3, `roughness ${roughness}: ${ours}`);
        assert.ok(roughness < 1 || own > 5e-2, `roughness ${roughness}: ${own}`);
        // The last texel then stands at roughness 1.
        assert.ok(ends <= 5e-3 && finer <= 2e-3, `roughness ${roughness}: ${ends}, ${finer}`);
    }
});

test('16 × 16 texels leave rings, 32 × 32 hardly', async test => {
    const largest = [0, 0];
    for (const roughness of [0.4, 0.6, 0.8, 0.95, 1]) {
        const seen = [];
        for (const [i, table] of [SMALL, TABLE].entries()) {
            const found = await differences('line', roughness, table);
            const ends = [Math.min(...found), Math.max(...found)];
            seen.push(ends.map(x => x.toFixed(4)).join(' … '));
            largest[i] = Math.max(largest[i], ...ends.map(Math.abs));
        }
        test.diagnostic(`roughness ${roughness}: 16 × 16 ${seen[0]}, 32 × 32 ${seen[1]}`);
    }
    assert.ok(largest[0] > 4e-3 && largest[0] < 6e-3, `16 × 16: ${largest[0]}`);
    assert.ok(largest[1] < 1.5e-3, `32 × 32: ${largest[1]}`);
});

test('smooth metal needs more than texels at the ends', async test => {
    const found = [];
    for (const table of [null, ...ENDS, TABLE]) {
        // Its lobe is narrow, and must hold many lights.
        const seen = await differences('line', 0.2, table, 32768);
        found.push(Math.max(...seen.map(Math.abs)));
    }
    const [own, ends, finer, ours] = found.map(x => x.toFixed(4));
    test.diagnostic(`roughness 0.2, along a line: ${own} by its table, with texels at the ends `
        + `${ends}, in 32 × 32 ${finer}; ${ours} by ours`);
    assert.ok(found[3] <= 1e-3 && found[2] <= 2e-3, `${finer}, ${ours}`);
    assert.ok(found[1] > found[0], `${ends} is less than ${own}`);
});

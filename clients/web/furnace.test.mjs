// White metal of three.js under direct lights from everywhere, which must return all of them.

import assert from 'node:assert/strict';
import { readFileSync } from 'node:fs';
import { join } from 'node:path';
import { after, before, test } from 'node:test';
import { FOLDER, launch, serve } from './harness.mjs';

const TABLE = JSON.parse(readFileSync(join(FOLDER, 'lut', 'lut.json'), 'utf8'));

let browser, page;

before(async () => {
    browser = await launch();
    page = await serve(browser, 'furnace.html');
    await page.waitForFunction(() => window.furnace);
});

after(() => browser.close());

/// The largest distance from 1 of what views of a cosine of 0.1 and more see.
async function off(roughness, table) {
    const pixels = await page.evaluate(
        ([r, description]) => window.furnace(r, description), [roughness, table]);
    const seen = pixels.filter(({ mu }) => mu >= 0.1).map(({ value }) => Math.abs(value - 1));
    assert.ok(seen.length > 1000);
    return Math.max(...seen);
}

test('our coordinates return all light of rough metal, that of three.js does not', async test => {
    for (const roughness of [0.6, 0.8, 1]) {
        const [own, ours] = [await off(roughness, null), await off(roughness, TABLE)];
        const by = `${own.toFixed(4)} by its table, ${ours.toFixed(4)}`;
        test.diagnostic(`roughness ${roughness}: ${by}`);
        assert.ok(ours <= 5e-3, `roughness ${roughness}: ${ours}`);
        assert.ok(roughness < 1 || own > 5e-2, `roughness ${roughness}: ${own}`);
    }
});

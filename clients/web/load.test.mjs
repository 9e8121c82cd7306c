// Pages load by themselves, whole and without a word, whatever a browser lacks.

import assert from 'node:assert/strict';
import { after, before, test } from 'node:test';
import { PAGES, launch, open, source } from './harness.mjs';
import { names, structure } from './structure.mjs';

let browser;
before(async () => (browser = await launch()));
after(() => browser.close());

/// A megabyte, and a tenth of that for a shape.
const BYTES = 1_000_000;
const BYTES_OF_SHAPE = 100_000;

for (const name of PAGES) {
    test(`${name}: loads, asks for nothing, is whole`, async () => {
        const { page, troubles, close } = await open(browser, name);
        await page.evaluate(settled);
        assert.deepEqual(await page.evaluate(structure), []);
        const { count, found, roles } = await names(page);
        assert.deepEqual(found, []);
        assert.ok(count > 0, 'nothing has a name');
        assert.deepEqual(troubles, []);
        const bytes = source(name).length;
        const shapes = await page.evaluate(() => window.report?.shapes ?? 0);
        console.log(`${name}: ${bytes} bytes, ${count} named elements: ${roles.join(', ')}`);
        assert.ok(bytes <= BYTES, `${bytes} bytes`);
        assert.ok(!shapes || bytes <= Math.max(1, shapes) * BYTES_OF_SHAPE, `${shapes} shapes`);
        await close();
    });
}

/// Browsers that lack something, and how.
const LACKING = {
    'WebGL 2 is absent': { init: () => {
        const { getContext } = HTMLCanvasElement.prototype;
        HTMLCanvasElement.prototype.getContext = function (kind, ...more) {
            return kind === 'webgl2' ? null : getContext.call(this, kind, ...more);
        };
    } },
    'textures of floats cannot be drawn to': { init: () => {
        const { getExtension } = WebGL2RenderingContext.prototype;
        WebGL2RenderingContext.prototype.getExtension = function (name) {
            return name === 'EXT_color_buffer_float' ? null : getExtension.call(this, name);
        };
    } },
    'scripts are off': { scripts: false },
};

for (const [what, lacking] of Object.entries(LACKING)) {
    for (const name of ['default', 'gold', 'ggx']) {
        test(`${name}: where ${what} there are pictures`, async () => {
            const { page, troubles, close } = await open(browser, name, lacking);
            // Without scripts in the page, ours run in a world of their own.
            assert.deepEqual(await page.evaluate(structure), []);
            const pictures = page.locator('#look img');
            assert.ok((await pictures.count()) > 0, 'no pictures');
            for (const picture of await pictures.all()) {
                assert.ok(await picture.isVisible());
            }
            // Nothing that does nothing is offered.
            assert.equal(await page.locator('#look .controls').isVisible(), false, 'controls');
            assert.equal(await page.locator('#look canvas').isVisible(), false, 'a canvas');
            assert.deepEqual(troubles, []);
            await close();
        });
    }
}

test('a browser without any GL draws the pictures', async () => {
    const bare = await launch(['--disable-3d-apis']);
    const { page, troubles, close } = await open(bare, 'default');
    const gl = await page.evaluate(() => document.createElement('canvas').getContext('webgl2'));
    assert.equal(gl, null);
    assert.ok((await page.locator('#look img').count()) > 0, 'no pictures');
    assert.deepEqual(troubles, []);
    await close();
    await bare.close();
});

/// Resolves when the page's own work at the start is done.
async function settled() {
    await window.report?.ready;
    await new Promise(done => requestAnimationFrame(() => setTimeout(done, 200)));
}

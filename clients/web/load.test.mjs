// Pages load by themselves, whole and without a word, whatever a browser lacks.

import assert from 'node:assert/strict';
import { after, before, test } from 'node:test';
import { PAGES, launch, open, settled, source } from './harness.mjs';
import { names, structure } from './structure.mjs';

let browser;
before(async () => (browser = await launch()));
after(() => browser.close());

/// A megabyte; and a tenth of that for a shape, besides style and scripts, which are the same on
/// every page.
const BYTES = 1_000_000;
const BYTES_OF_SHAPE = 100_000;

/// The bytes of a page that are style, scripts and shaders.
function fixed() {
    const all = document.querySelectorAll('style, script:not([type="application/json"])');
    const bytes = text => new TextEncoder().encode(text).length;
    return [...all].reduce((sum, { textContent }) => sum + bytes(textContent), 0);
}

for (const name of PAGES) {
    test(`${name}: loads, asks for nothing, is whole`, async t => {
        const { page, troubles } = await open(t, browser, name);
        await settled(page);
        assert.deepEqual(await page.evaluate(structure), []);
        const { count, found, roles } = await names(page);
        assert.deepEqual(found, []);
        assert.ok(count > 0, 'nothing has a name');
        assert.deepEqual(troubles, []);
        const bytes = source(name).length;
        const same = await page.evaluate(fixed);
        const shapes = await page.evaluate(() => report.state().shapes);
        const each = Math.round((bytes - same) / shapes);
        console.log(`${name}: ${bytes} bytes, of which ${same} fixed, and ${each} for each of `
            + `${shapes} shapes; ${count} named elements: ${roles.join(', ')}`);
        assert.ok(bytes <= BYTES, `${bytes} bytes`);
        assert.ok(shapes > 0 && each <= BYTES_OF_SHAPE, `${each} bytes a shape`);
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
    for (const name of ['default', 'ggx']) {
        test(`${name}: where ${what} there are pictures`, async t => {
            const { page, troubles } = await open(t, browser, name, lacking);
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
        });
    }
}

test('a browser without any GL draws the pictures', async t => {
    const bare = await launch(['--disable-3d-apis']);
    t.after(() => bare.close());
    const { page, troubles } = await open(t, bare, 'default');
    const gl = await page.evaluate(() => document.createElement('canvas').getContext('webgl2'));
    assert.equal(gl, null);
    assert.ok((await page.locator('#look img').count()) > 0, 'no pictures');
    assert.deepEqual(troubles, []);
});

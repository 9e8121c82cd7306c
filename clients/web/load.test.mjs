// Pages load by themselves, whole and without a word, whatever a browser lacks.

import assert from 'node:assert/strict';
import { rmSync, writeFileSync } from 'node:fs';
import { join } from 'node:path';
import { after, before, test } from 'node:test';
import { FOLDER, PAGES, address, launch, open, settled, source } from './harness.mjs';
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

/// The page with a letter of each of its scripts changed, as by one who slips another in.
test('a script that the page does not state by hash does not run', async t => {
    const path = join(FOLDER, 'altered.html');
    const altered = source('default').toString().replaceAll(
        /(<script type="module">)/g, '$1window.altered = true; ');
    writeFileSync(path, altered);
    t.after(() => rmSync(path));
    const { page, troubles } = await open(t, browser, 'altered');
    assert.equal(await page.evaluate(() => window.altered || window.report), undefined);
    assert.equal(troubles.length, 2, troubles.join('\n'));
    for (const word of troubles) {
        assert.match(word, /script .*violates .*Content Security Policy .*script-src 'sha256-/s);
    }
    // Pictures are there all the same.
    assert.ok(await page.locator('#sphere-still').isVisible());
    assert.equal(await page.locator('#look .controls').isVisible(), false);
});

test('the picture is first, and the sphere takes its place when it is as clean', async t => {
    const options = { width: 375, height: 812 };
    // Frames are held back, so that nothing is drawn before the test looks.
    const init = () => {
        const { requestAnimationFrame } = window;
        const held = [];
        window.requestAnimationFrame = draw => held.push(draw);
        window.release = () => {
            window.requestAnimationFrame = requestAnimationFrame;
            held.splice(0).forEach(draw => requestAnimationFrame(draw));
        };
    };
    const { page, troubles } = await open(t, browser, 'default', { ...options, init });
    const polling = { polling: 50 };
    await page.waitForFunction(() => window.report, null, polling);
    const shown = () => Promise.all(['#sphere-still', '#sphere'].map(
        id => page.locator(id).isVisible()));
    assert.deepEqual(await shown(), [true, false]);
    await page.evaluate(() => window.release());
    await page.waitForFunction(() => /^A picture; /.test(
        document.querySelector('#sphere-samples').textContent), null, polling);
    assert.deepEqual(await shown(), [true, false]);
    // A picture of fewer pixels and samples is soon passed.
    await page.evaluate(() => {
        const still = document.querySelector('#sphere-still');
        still.setAttribute('width', 64);
        still.dataset.samples = 2;
    });
    await page.waitForSelector('#sphere', { state: 'visible' });
    assert.deepEqual(await shown(), [false, true]);
    assert.deepEqual(troubles, []);
});

test('what the picture does not show is drawn at once', async t => {
    for (const [hash, look] of [['', { gamma: 5 }], ['#gamma=5&sigma=0.2', {}]]) {
        const url = address('default') + hash;
        const { page, troubles } = await open(t, browser, 'default', { url, width: 375 });
        await settled(page, { ...look, size: 64, samples: 1 });
        assert.equal(await page.locator('#sphere-still').isVisible(), false);
        assert.ok(await page.locator('#sphere').isVisible());
        assert.deepEqual(troubles, []);
    }
});

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

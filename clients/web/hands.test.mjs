// The page under a mouse and a finger, and when the graphics device goes away and comes back.

import assert from 'node:assert/strict';
import { after, before, test } from 'node:test';
import { difference, launch, open, settled } from './harness.mjs';
import { layout } from './layout.mjs';
import { shownText } from './structure.mjs';

let browser;
before(async () => (browser = await launch()));
after(() => browser.close());

/// A window in which the sphere is small, and soon drawn.
const NARROW = { width: 390, height: 844 };

/// Where the handle of the lobe is for a view of so many degrees, in the window.
function place(degrees) {
    const svg = document.querySelector('#lobe-live svg');
    svg.scrollIntoView({ block: 'center', behavior: 'instant' });
    const view = degrees * Math.PI / 180;
    const at = new DOMPoint(-150 * Math.sin(view), -150 * Math.cos(view));
    const { x, y } = at.matrixTransform(svg.getScreenCTM());
    return { x, y };
}

/// What the lobe's drawing says and shows.
function drawing() {
    const figure = document.querySelector('#lobe-live');
    return {
        degrees: Number(figure.querySelector('[role=slider]').getAttribute('aria-valuenow')),
        points: figure.querySelector('.of-shape').getAttribute('points'),
    };
}

/// Drags from one point to another.
const DRAGS = {
    async mouse(page, from, to) {
        await page.mouse.move(from.x, from.y);
        await page.mouse.down();
        await page.mouse.move(to.x, to.y, { steps: 5 });
        await page.mouse.up();
    },
    async finger(page, from, to) {
        const session = await page.context().newCDPSession(page);
        const touch = (type, ...touchPoints) =>
            session.send('Input.dispatchTouchEvent', { type, touchPoints });
        await touch('touchStart', from);
        for (const part of [0.25, 0.5, 0.75, 1]) {
            const along = key => from[key] + part * (to[key] - from[key]);
            await touch('touchMove', { x: along('x'), y: along('y') });
        }
        await touch('touchEnd');
        await session.detach();
    },
};

for (const [hand, drag] of Object.entries(DRAGS)) {
    test(`the view of the lobe follows a ${hand}`, async t => {
        const options = hand === 'finger' ? { ...NARROW, touch: true } : {};
        const { page, troubles } = await open(t, browser, 'default', options);
        await settled(page);
        await page.evaluate(() => report.lobe(45));
        const [from, to] = [await page.evaluate(place, 45), await page.evaluate(place, 70)];
        const [before, scrolled] =
            [await page.evaluate(drawing), await page.evaluate(() => window.scrollY)];
        await drag(page, from, to);
        const { degrees } = await page.evaluate(drawing);
        assert.ok(Math.abs(degrees - 70) <= 1, `${degrees} degrees`);
        await page.waitForFunction(points => document.querySelector('#lobe-live .of-shape')
            .getAttribute('points') !== points, before.points);
        assert.equal(await page.evaluate(() => window.scrollY), scrolled, 'the page scrolls');
        assert.deepEqual(troubles, []);
    });
}

/// The sphere as it is, in few samples.
const seen = page => page.evaluate(async () => {
    await report.set({ size: 64, samples: 8 });
    return [...await report.pixels()];
});

test('sliders, lists and pictures change the sphere', async t => {
    const { page, troubles } = await open(t, browser, 'default', NARROW);
    await settled(page);
    let last = await seen(page);
    const changed = async what => {
        const now = await seen(page);
        const { largest } = difference(last, now);
        assert.ok(largest > 16, `${what} changes the sphere by ${largest}/255`);
        last = now;
    };
    for (const id of ['sigma-x', 'shape']) {
        const slider = page.locator(`#${id}`);
        await slider.scrollIntoViewIfNeeded();
        const { x, y, width, height } = await slider.boundingBox();
        const at = part => ({ x: x + part * width, y: y + height / 2 });
        const value = Number(await slider.inputValue()) / Number(await slider.getAttribute('max'));
        await DRAGS.mouse(page, at(value), at(0.2));
        await changed(id);
    }
    const { sigma, gamma } = await page.evaluate(() => report.state());
    assert.ok(sigma[0] < 0.05 && sigma[0] === sigma[1], `σ = ${sigma}`);
    assert.ok(gamma < 2, `γ = ${gamma}`);
    await page.locator('#metal').selectOption({ label: 'copper' });
    await changed('metal');
    const picture = page.locator('[data-material="2"]');
    await picture.click();
    await changed('a picture');
    assert.equal(await picture.getAttribute('aria-pressed'), 'true');
    assert.equal(await page.evaluate(() => report.state().gamma), 2);
    assert.deepEqual(troubles, []);
});

/// What Chromium says of itself when a context is lost.
const OWN_WORDS = /CONTEXT_LOST_WEBGL/;

test('pictures stand for the sphere while its context is lost, and then it is back', async t => {
    const { page, troubles } = await open(t, browser, 'default', NARROW);
    await settled(page);
    const before = await seen(page);
    await page.evaluate(() => new Promise(lost => {
        const canvas = document.querySelector('#sphere');
        window.context = canvas.getContext('webgl2').getExtension('WEBGL_lose_context');
        // The page hears of it before the test does.
        canvas.addEventListener('webglcontextlost', () => setTimeout(lost));
        window.context.loseContext();
    }));
    assert.ok(await page.locator('#sphere-still').isVisible());
    assert.ok(await page.locator('#lobe-still').isVisible());
    for (const gone of ['#sphere', '#sphere-controls', '#lobe-live']) {
        assert.equal(await page.locator(gone).isVisible(), false, gone);
    }
    await page.evaluate(shownText);
    assert.deepEqual(await page.evaluate(layout, { touch: false }), []);
    // What other pages of the history ask for, and what is asked of a lost context.
    await page.evaluate(() => { location.hash = '#gamma=5&sigma=0.2'; });
    assert.equal(await page.evaluate(() => report.pixels()), null);
    await page.evaluate(() => report.lobe(60));
    await page.evaluate(() => window.context.restoreContext());
    await page.waitForSelector('#sphere', { state: 'visible' });
    assert.equal(await page.locator('#sphere-still').isVisible(), false);
    assert.equal(await page.evaluate(() => report.state().gamma), 5);
    await settled(page, { gamma: 3, sigma: [0.3, 0.3], size: 64, samples: 1 });
    assert.equal(difference(before, await seen(page)).largest, 0);
    assert.deepEqual(troubles.filter(word => !OWN_WORDS.test(word)), []);
});

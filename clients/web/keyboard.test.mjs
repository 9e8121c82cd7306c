// The page without a mouse: everything is reached by Tab, is seen to have the focus, and obeys the
// keys of its kind.

import assert from 'node:assert/strict';
import { after, before, test } from 'node:test';
import { launch, open, settled } from './harness.mjs';
import { ring } from './layout.mjs';

let browser;
before(async () => (browser = await launch()));
after(() => browser.close());

/// What can be acted on and is shown, as a list that the page keeps.
function controls() {
    const all = 'input, select, button, summary, a[href], [role=slider], [tabindex="0"]';
    const shown = element =>
        !element.disabled && element.checkVisibility({ visibilityProperty: true });
    window.controls = [...document.querySelectorAll(all)].filter(shown);
    return window.controls.length;
}

for (const [name, width] of [['default', 1440], ['default', 375], ['gold', 1440]]) {
    test(`${name} at ${width}: Tab reaches every control, and shows where it is`, async t => {
        const { page } = await open(t, browser, name, { width });
        await settled(page);
        const count = await page.evaluate(controls);
        assert.ok(count > 0, 'no controls');
        const seen = new Map();
        const cut = [];
        // Radio buttons of one name share a stop, so that there may be fewer.
        for (let i = 0; i < 2 * count + 10; i++) {
            await page.keyboard.press('Tab');
            const at = await page.evaluate(() => {
                const element = document.activeElement;
                const { outlineStyle, outlineWidth, boxShadow } = getComputedStyle(element);
                const isSeen = outlineStyle !== 'none' && parseFloat(outlineWidth) > 0
                    || boxShadow !== 'none';
                return { index: window.controls.indexOf(element), isSeen };
            });
            if (seen.has(at.index)) {
                break;
            }
            seen.set(at.index, at.isSeen);
            // What has the focus comes into view within a frame or two.
            await page.evaluate(() => new Promise(seen => requestAnimationFrame(
                () => requestAnimationFrame(seen))));
            cut.push(...await page.evaluate(ring));
        }
        assert.deepEqual(cut, []);
        const reached = await page.evaluate(
            indices => window.controls.map((element, i) => ({
                what: element.id || element.getAttribute('class') || element.textContent.trim(),
                isReached: indices.includes(i)
                    || element.type === 'radio' && indices.some(j =>
                        window.controls[j]?.name === element.name),
            })),
            [...seen.keys()],
        );
        const missed = reached.filter(({ isReached }) => !isReached).map(({ what }) => what);
        assert.deepEqual(missed, []);
        const unseen = [...seen].filter(([i, isSeen]) => i >= 0 && !isSeen);
        assert.deepEqual(unseen.map(([i]) => reached[i].what), [], 'no ring about the focus');
    });
}

for (const name of ['default', 'gold']) {
    test(`${name}: keys change what has the focus`, async t => {
        const { page, troubles } = await open(t, browser, name);
        await settled(page);
        await page.evaluate(controls);
        const kinds = new Set();
        const all = await page.evaluateHandle(() => window.controls);
        for (const handle of (await all.getProperties()).values()) {
            const control = handle.asElement();
            const kind = await control.evaluate(element =>
                element.getAttribute('role') ?? (element.type || element.tagName.toLowerCase()));
            const keys = {
                range: ['ArrowLeft', 'ArrowRight'], slider: ['ArrowLeft', 'ArrowRight'],
                'select-one': ['ArrowDown', 'ArrowUp'], checkbox: ['Space'],
            }[kind];
            if (!keys) {
                continue;
            }
            kinds.add(kind);
            const value = () => control.evaluate(element => element.getAttribute('aria-valuenow')
                ?? (element.type === 'checkbox' ? element.checked : element.value));
            await control.focus();
            const before = await value();
            let isChanged = false;
            // At an end of its range one of two keys does nothing.
            for (const key of keys) {
                await page.keyboard.press(key);
                isChanged ||= (await value()) !== before;
            }
            const what = await control.evaluate(element =>
                element.id || element.getAttribute('class'));
            assert.ok(isChanged, `${kind} ${what} stays at ${before}`);
        }
        console.log(`${name}: ${[...kinds].join(', ')} obey keys`);
        assert.ok(kinds.has('range') && kinds.has('checkbox') && kinds.has('slider'));
        assert.deepEqual(troubles, []);
    });
}

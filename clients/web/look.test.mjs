// How pages look: light and dark, on a desk and on a phone, on paper. Writes screenshots into the
// folder SHOTS, where it is set.

import assert from 'node:assert/strict';
import { mkdirSync } from 'node:fs';
import { join } from 'node:path';
import { after, before, test } from 'node:test';
import { PAGES, launch, open, settled } from './harness.mjs';
import { layout, printed } from './layout.mjs';
import { contrast, shownText } from './structure.mjs';

let browser;
before(async () => (browser = await launch()));
after(() => browser.close());

const shots = process.env.SHOTS;
/// What the sphere rests in: on a screenshot it is to be seen.
const look = shots ? { size: 240, samples: 32 } : undefined;
const WIDTHS = { 1440: { height: 900 }, 375: { height: 812, touch: true } };

for (const name of PAGES) {
    for (const [width, screen] of Object.entries(WIDTHS)) {
        // Colours are those of all pages; what differs is where things stand.
        for (const scheme of name === 'default' || shots ? ['light', 'dark'] : ['dark']) {
            test(`${name} at ${width}, ${scheme}: nothing is cut, covered or pale`, async t => {
                const options = { ...screen, width: Number(width), scheme };
                const { page, troubles } = await open(t, browser, name, options);
                await settled(page, look);
                await page.evaluate(shownText);
                assert.ok((await page.evaluate(() => window.shownText().length)) > 0, 'no text');
                if (shots) {
                    await shoot(page, `${name}-${width}-${scheme}`);
                }
                const found = [
                    ...await page.evaluate(layout, { touch: Boolean(screen.touch) }),
                    ...await page.evaluate(contrast),
                ];
                assert.deepEqual(found, []);
                assert.deepEqual(troubles, []);
            });
        }
    }
}

/// Screenshots of a page in parts, for a surface that is taller cannot be drawn.
async function shoot(page, name) {
    mkdirSync(shots, { recursive: true });
    const part = 6000;
    const [width, height] = await page.evaluate(() => {
        const { scrollWidth, scrollHeight } = document.documentElement;
        return [scrollWidth, scrollHeight];
    });
    for (let y = 0; y < height; y += part) {
        const path = join(shots, `${name}-${y / part + 1}.png`);
        const clip = { x: 0, y, width, height: Math.min(part, height - y) };
        await page.screenshot({ path, clip, fullPage: true });
    }
}

/// A4 with margins of 12 mm, in pixels.
const SHEET = { width: 703, height: 1032 };

for (const name of ['default', 'gold', 'demo']) {
    test(`${name}: is printed with its pictures, on light paper`, async t => {
        const { page, troubles } = await open(t, browser, name, { scheme: 'dark' });
        await settled(page, look);
        await page.setViewportSize(SHEET);
        await page.emulateMedia({ media: 'print', colorScheme: 'light' });
        await page.evaluate(shownText);
        const found = [
            ...await page.evaluate(printed, { pageHeight: SHEET.height }),
            ...await page.evaluate(layout, { touch: false }),
            ...await page.evaluate(contrast),
        ];
        assert.deepEqual(found, []);
        assert.deepEqual(troubles, []);
        const margin = { top: '12mm', bottom: '12mm', left: '12mm', right: '12mm' };
        const path = shots && join(shots, `${name}.pdf`);
        const pdf = await page.pdf({ format: 'A4', margin, printBackground: true, path });
        const count = pattern => pdf.toString('latin1').match(pattern)?.length ?? 0;
        const sheets = count(/\/Type \/Page\b/g);
        const images = count(/\/Subtype \/Image\b/g);
        console.log(`${name}: ${sheets} sheets, ${images} images in the PDF`);
        assert.ok(sheets >= 1);
        assert.ok(images >= 1, 'no picture is printed');
    });
}

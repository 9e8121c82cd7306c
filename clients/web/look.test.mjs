// How pages look: light and dark, on a desk and on a phone, on paper. Writes screenshots into the
// folder SHOTS, where it is set.

import assert from 'node:assert/strict';
import { mkdirSync } from 'node:fs';
import { join } from 'node:path';
import { after, before, test } from 'node:test';
import { PAGES, launch, open } from './harness.mjs';
import { layout, printed } from './layout.mjs';
import { contrast, shownText } from './structure.mjs';

let browser;
before(async () => (browser = await launch()));
after(() => browser.close());

const shots = process.env.SHOTS;
const WIDTHS = { 1440: { height: 900 }, 390: { height: 844, density: 2, touch: true } };

for (const name of PAGES) {
    for (const [width, screen] of Object.entries(WIDTHS)) {
        for (const scheme of ['light', 'dark']) {
            test(`${name} at ${width}, ${scheme}: nothing is cut, covered or pale`, async () => {
                const options = { ...screen, width: Number(width), scheme };
                const { page, troubles, close } = await open(browser, name, options);
                await page.evaluate(shownText);
                assert.ok((await page.evaluate(() => window.shownText().length)) > 0, 'no text');
                if (shots) {
                    mkdirSync(shots, { recursive: true });
                    await page.evaluate(() => window.report?.ready);
                    const path = join(shots, `${name}-${width}-${scheme}.png`);
                    await page.screenshot({ path, fullPage: true });
                }
                const found = [
                    ...await page.evaluate(layout, { touch: Boolean(screen.touch) }),
                    ...await page.evaluate(contrast),
                ];
                assert.deepEqual(found, []);
                assert.deepEqual(troubles, []);
                await close();
            });
        }
    }
}

/// A4 with margins of 12 mm, in pixels.
const SHEET = { width: 703, height: 1032 };

for (const name of ['default', 'gold']) {
    test(`${name}: is printed with its pictures, on light paper`, async () => {
        const { page, troubles, close } = await open(browser, name, { scheme: 'dark' });
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
        await close();
    });
}

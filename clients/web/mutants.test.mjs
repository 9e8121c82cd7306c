// Every check can fail: each is given a page without faults, and the same page with one.

import assert from 'node:assert/strict';
import { mkdtempSync, rmSync, writeFileSync } from 'node:fs';
import { tmpdir } from 'node:os';
import { join } from 'node:path';
import { after, before, test } from 'node:test';
import { pathToFileURL } from 'node:url';
import { difference, launch, open } from './harness.mjs';
import { layout, printed, ring } from './layout.mjs';
import { contrast, names, shownText, structure } from './structure.mjs';

const folder = mkdtempSync(join(tmpdir(), 'mutants-'));
let browser;
before(async () => (browser = await launch()));
after(async () => {
    await browser.close();
    rmSync(folder, { recursive: true });
});

const DOT = 'data:image/gif;base64,R0lGODlhAQABAIAAAAAAAP///ywAAAAAAQABAAACAUwAOw==';
const GOOD = `<!DOCTYPE html>
<html lang="en"><head><meta charset="utf-8"><title>A page</title>
<meta name="viewport" content="width=device-width, initial-scale=1">
<style>
:root { color-scheme: light dark; }
figure { break-inside: avoid; margin: 0; }
input { min-height: 24px; }
.scroll { overflow-x: auto; }
.scroll a { display: inline-block; padding: 6px; outline-offset: -2px; }
.reader { position: absolute; width: 1px; height: 1px; overflow: hidden; white-space: nowrap; }
@media print { input { display: none; } button { display: contents; } }
</style></head><body><main><h1>A page</h1><section><h2>A part</h2>
<h3 class="reader">For screen readers alone, as wide as it may be, and not to be seen.</h3>
<p id="words">Words that are read.</p>
<label for="sigma">Roughness</label> <input id="sigma" type="range">
<figure><img src="${DOT}" alt="a dot"><figcaption>A dot</figcaption></figure>
<button aria-label="Show a dot"><img src="${DOT}" alt="" width="24" height="24"></button>
<svg role="img" aria-label="a figure" width="100" height="40"><text x="5" y="20" font-size="12"
 fill="light-dark(#111,#eee)">text</text></svg>
<nav class="scroll"><a href="#words">to the words</a></nav>
<div class="scroll"><table><caption>Numbers</caption>
<tr><th scope="col">wide</th><td>1</td></tr></table></div>
</section></main></body></html>`;

/// All that is said of a page at the width of a phone.
async function findings(t, html) {
    const path = join(folder, 'page.html');
    writeFileSync(path, html);
    const options = { url: pathToFileURL(path).href, width: 375 };
    const { page, troubles } = await open(t, browser, '', options);
    await page.evaluate(shownText);
    const found = [
        ...troubles,
        ...await page.evaluate(structure),
        ...(await names(page)).found,
        ...await page.evaluate(layout, { touch: true }),
        ...await page.evaluate(contrast),
    ];
    await page.keyboard.press('Tab');
    for (const link of await page.locator('a').all()) {
        await link.focus();
        found.push(...await page.evaluate(ring));
    }
    await page.emulateMedia({ media: 'print' });
    found.push(...await page.evaluate(printed, { pageHeight: 1000 }));
    return found;
}

test('a page without faults is told to have none', async t => {
    assert.deepEqual(await findings(t, GOOD), []);
});

/// What is replaced by what, and a word of what must be said.
const MUTANTS = [
    ['</main>', '</main><script>console.warn("so")</script>', /^console: so/],
    ['</main>', '</main><script>nothing()</script>', /^script: nothing/],
    ['</main>', '</main><script>fetch("http://127.0.0.1:9/")</script>', /^request: http/],
    ['</main>', '</main><img src="missing.png" alt="gone">', /^failed: .*missing/],
    ['</main>', '</main><img src="missing.png" alt="gone">', /need of "missing.png"/],
    [' lang="en"', '', /no language/],
    ['<title>A page</title>', '<title></title>', /no title/],
    ['<h2>A part</h2>', '<h4>A part</h4>', /skips a level/],
    ['<h2>A part</h2>', '<h1>A part</h1>', /no single h1/],
    ['<h2>', '<h2 id="words">', /two of id "words"/],
    ['for="sigma"', 'for="gone"', /id "gone"/],
    ['<p id="words">', '<p id="words"><a href="#gone">to</a>', /no #gone/],
    ['<caption>Numbers</caption>', '', /no caption/],
    ['<th scope="col">', '<th>', /th with scope/],
    [' alt="a dot"', '', /no alt/],
    [' alt="a dot"', ' alt=""', /no alt/],
    ['<button aria-label="Show a dot">', '<button>', /no alt of a picture in button/],
    ['<button aria-label="Show a dot">', '<button>', /a button without a name/],
    ['<figcaption>A dot</figcaption>', '', /figure/],
    ['<label for="sigma">Roughness</label>', '', /a slider without a name/],
    [' aria-label="a figure"', '', /a (img|image|graphics-document) without a name/],
    ['<p id="words">', '<p id="words" style="width: 500px">', /wide, the window/],
    ['<p id="words">', '<p id="words" style="margin-left: -20px">', /beyond the page/],
    ['<p id="words">', '<p style="width: 60px; height: 9px; overflow: hidden">', /cut: p/],
    ['x="5" y="20"', 'x="90" y="20"', /cut by its figure/],
    ['<p id="words">', '<p style="position: relative; top: 80px">', /overlap/],
    ['<p id="words">', `<p style="width: 50px">${'Words and '.repeat(9)}`, /squeezed to 50 of/],
    ['class="reader"', 'style="position: absolute; left: -50rem"', /beyond the page: h3/],
    ['<p id="words">', '<p style="position: relative; z-index: 1; top: 120px">', /overlap.* img/],
    ['<p id="words">', '<p style="font-size: 7px">', /letters of 7/],
    ['font-size="12"', 'font-size="10.5"', /letters of 10.5/],
    ['outline-offset: -2px', 'outline-offset: 2px', /the ring about "to the words" is cut/],
    ['min-height: 24px', 'height: 12px', /a target of/],
    ['<p id="words">', '<p style="color: light-dark(#888, #777)">', /contrast/],
    ['<p id="words">', '<p style="opacity: 0.5">', /contrast/],
    ['light-dark(#111,#eee)', '#bbb', /contrast/],
    ['figure { break-inside: avoid;', 'figure {', /may be divided/],
    ['alt="a dot"', 'alt="a dot" style="width: 20px; height: 1200px"', /taller than a sheet/],
    ['font-size="12"', 'font-size="25"', /letters of 1\.6 times those of the page: "text"/],
    ['@media print { input { display: none; }', '@media print {', /a control on paper: sigma/],
    ['button { display: contents; }', '', /a control on paper: button/],
];

for (const [from, to, said] of MUTANTS) {
    test(`${from} → ${to}`, async t => {
        assert.ok(GOOD.includes(from), 'the page without faults lacks it');
        const found = await findings(t, GOOD.replace(from, to));
        assert.ok(found.some(word => said.test(word)), `${said} is not in ${found.join('\n')}`);
    });
}

test('pictures that differ are told apart', () => {
    const grey = new Uint8Array(64).fill(100);
    const other = grey.slice();
    assert.deepEqual(difference(grey, other), { largest: 0, differing: 0, pixels: 16 });
    other[5] += 3;
    assert.deepEqual(difference(grey, other), { largest: 3, differing: 1, pixels: 16 });
    assert.throws(() => difference(grey, other.slice(4)));
    assert.throws(() => difference([], []));
});

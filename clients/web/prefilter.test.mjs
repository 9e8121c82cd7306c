// Light that three.js filters in advance, with its lines of GGX replaced by those of any gamma.

import assert from 'node:assert/strict';
import { readFileSync } from 'node:fs';
import { join } from 'node:path';
import { after, before, test } from 'node:test';
import { FOLDER, launch, serve } from './harness.mjs';

/// The exported functions, without the tables that they do not read.
const FUNCTIONS = readFileSync(join(FOLDER, 'glsl', 'student_t.glsl'), 'utf8');

let browser, page;

before(async () => {
    browser = await launch();
    page = await serve(browser, 'prefilter.html');
    await page.waitForFunction(() => window.compare);
});

after(() => browser.close());

/// The largest difference, as a share of what is there.
const apart = (a, b) => Math.max(...a.map((x, i) => Math.abs(x - b[i]) / b[i]));

const compare = gamma => page.evaluate(([text, g]) => window.compare(text, g), [FUNCTIONS, gamma]);

test('at gamma = 2 the picture is that of three.js', async () => {
    for (const { alpha, own, changed } of await compare(2)) {
        assert.ok(apart(changed, own) <= 1e-3, `alpha ${alpha}: ${apart(changed, own)}`);
    }
});

for (const gamma of [1.6, 40]) {
    test(`at gamma = ${gamma} it is the integral, which GGX is not`, async test => {
        for (const { alpha, own, changed, truth } of await compare(gamma)) {
            const [ours, theirs] = [apart(changed, truth), apart(own, truth)];
            const found = `${ours.toFixed(4)}, GGX ${theirs.toFixed(4)}`;
            test.diagnostic(`alpha ${alpha.toFixed(3)}: ${found}`);
            assert.ok(ours <= 0.05, `alpha ${alpha}: off by ${ours}`);
            // What is not filtered is the same.
            assert.ok(alpha < 1e-3 || ours < 0.6 * theirs, `alpha ${alpha}: GGX ${theirs}`);
        }
    });
}

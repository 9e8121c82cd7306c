// The sphere's pixels are those of the crate's own BSDF: the same random numbers, samples and tone
// curve, in the browser and in Rust. And the lobe in the plane of incidence is that of the crate.

import assert from 'node:assert/strict';
import { execFileSync } from 'node:child_process';
import { mkdtempSync, readFileSync, rmSync } from 'node:fs';
import { tmpdir } from 'node:os';
import { join } from 'node:path';
import { after, before, test } from 'node:test';
import { difference, launch, open } from './harness.mjs';

const ALLOWED = 2;
const SIZE = 96;
const SAMPLES = 16;
/// Of the largest value of a lobe.
const OFF = 1e-4;

const folder = mkdtempSync(join(tmpdir(), 'sphere-'));
let browser, opened;
before(async () => {
    browser = await launch();
    // It stays until the browser is closed.
    opened = await open({ after() {} }, browser, 'default');
    await opened.page.waitForFunction(() => window.report);
});
after(async () => {
    await browser.close();
    rmSync(folder, { recursive: true });
});

/// What the page draws, from the upper left, and what it says that it is.
function drawn(look) {
    return opened.page.evaluate(async ({ gamma, ...look }) => {
        await report.set({ ...look, gamma: gamma === 'inf' ? Infinity : gamma });
        const bytes = await report.pixels(), row = 4 * look.size, flipped = [];
        for (let at = bytes.length - row; at >= 0; at -= row) {
            flipped.push(...bytes.slice(at, at + row));
        }
        const { drawn } = report.state();
        return { pixels: flipped, drawn: drawn === Infinity ? 'inf' : drawn };
    }, { ...look, size: SIZE, samples: SAMPLES });
}

/** The words of the study of a sphere and its lobe. */
function study(options) {
    const named = ([name, value]) => [`--${name}`, `${value}`];
    return ['report_sphere', ...Object.entries(options).flatMap(named)];
}

/// What Rust draws, decoded by the browser.
async function rendered({ sigma, gamma, metal, compensation }, drawn) {
    const out = join(folder, 'sphere.png');
    const options = {
        gamma, drawn, sigma, metal, size: SIZE, samples: SAMPLES, out,
    };
    const words = study(options);
    execFileSync(process.env.STUDY, compensation ? [...words, '--compensation'] : words);
    const url = `data:image/png;base64,${readFileSync(out, 'base64')}`;
    return opened.page.evaluate(async (src) => {
        const image = Object.assign(new Image(), { src });
        await image.decode();
        const canvas = new OffscreenCanvas(image.width, image.height).getContext('2d');
        canvas.drawImage(image, 0, 0);
        return [...canvas.getImageData(0, 0, image.width, image.height).data];
    }, url);
}

const look = (gamma, x, y, metal, compensation = true) =>
    ({ gamma, sigma: [x, y], metal, compensation });

/// Shapes that the page holds and shapes between them, both limits, ends of σ, two σ, one bounce.
const LOOKS = [
    look(3, 0.2, 0.2, 'gold'), look(1.501, 0.3, 0.3, 'silver'), look(1.7, 1, 1, 'gold'),
    look(2, 0.05, 0.05, 'copper'), look('inf', 1, 1, 'gold'), look('inf', 0.01, 0.01, 'silver'),
    look(4.5, 0.1, 0.5, 'aluminium'), look(60, 0.8, 0.8, 'copper'),
    look(2.6, 0.4, 0.4, 'gold', false),
    // Smooth heavy tails, whose albedo falls steeply about the normal.
    look(1.501, 0.013, 0.013, 'silver'), look(1.51, 0.01, 0.01, 'mirror'),
    look(1.7, 0.03, 0.03, 'mirror'),
];

for (const one of LOOKS) {
    test(`${one.metal}, γ = ${one.gamma}, σ = ${one.sigma}: as the crate draws it`, async () => {
        const { pixels, drawn: slice } = await drawn(one);
        const found = difference(pixels, await rendered(one, slice));
        console.log(`at most ${found.largest}/255; ${found.differing} of ${found.pixels} differ`);
        assert.ok(found.largest <= ALLOWED, `${found.largest}/255`);
    });
}

for (const [what, other] of Object.entries({
    'σ by 5 %': { sigma: [0.21, 0.21] }, 'compensation': { compensation: false },
    'γ': { gamma: 3.2 }, 'metal': { metal: 'copper' },
})) {
    test(`another ${what} is told apart`, async () => {
        const { pixels, drawn: slice } = await drawn(LOOKS[0]);
        const found = difference(pixels, await rendered({ ...LOOKS[0], ...other }, slice));
        assert.ok(found.largest > ALLOWED, `${found.largest}/255`);
    });
}

/// How far the curves of the page are from those of the crate, by the largest of each.
async function apart({ gamma, sigma }, degrees, other = {}) {
    const ours = await opened.page.evaluate(async ([gamma, sigma, degrees]) => {
        const shape = gamma === 'inf' ? Infinity : gamma;
        await report.set({ gamma: shape, sigma, size: 64, samples: 1 });
        return [...await report.lobe(degrees)];
    }, [gamma, sigma, degrees]);
    const options = { gamma, sigma, lobe: degrees, ...other };
    const words = study(options);
    const lines = execFileSync(process.env.STUDY, words, { encoding: 'utf8' }).trim().split('\n');
    const theirs = lines.map(line => line.split(' ').map(Number));
    assert.equal(ours.length, 4 * theirs.length);
    return [0, 1, 2].map(curve => {
        const largest = Math.max(...theirs.map(values => values[curve]));
        assert.ok(largest > 0);
        const off = theirs.map((values, i) => Math.abs(values[curve] - ours[4 * i + curve]));
        assert.ok(off.every(Number.isFinite));
        return Math.max(...off) / largest;
    });
}

for (const one of LOOKS.slice(0, 8)) {
    for (const degrees of [0, 45, 80, 89]) {
        test(`the lobe of γ = ${one.gamma}, σ = ${one.sigma}, at ${degrees}°`, async () => {
            const off = await apart(one, degrees);
            console.log(`off by ${off.map(x => x.toExponential(1)).join(', ')} of the largest`);
            assert.ok(off.every(x => x <= OFF), `${off}`);
        });
    }
}

test('the lobe of another σ, γ or view is told apart', async () => {
    assert.ok((await apart(LOOKS[0], 45, { sigma: 0.202 })).every(x => x > OFF));
    assert.ok((await apart(LOOKS[0], 45, { lobe: 46 })).every(x => x > OFF));
    assert.ok((await apart(LOOKS[0], 45, { gamma: 3.1 }))[0] > OFF);
});

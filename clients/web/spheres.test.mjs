// The page of spheres beside each other: what is written below them, and what is to be seen.

import assert from 'node:assert/strict';
import { mkdtempSync, readFileSync, rmSync, writeFileSync } from 'node:fs';
import { tmpdir } from 'node:os';
import { join } from 'node:path';
import { after, before, test } from 'node:test';
import { FOLDER, launch, serve } from './harness.mjs';

const folder = mkdtempSync(join(tmpdir(), 'spheres-'));
let browser;
before(async () => (browser = await launch()));
after(async () => {
    await browser.close();
    rmSync(folder, { recursive: true });
});

/// In the page: what is written below each sphere by row, and by what the pictures show. Of a
/// picture in the furnace that is the largest distance from white, in bytes; of one under a light
/// its red and blue in all, and how many pixels are black.
function read() {
    const pixels = canvas =>
        canvas.getContext('2d').getImageData(0, 0, canvas.width, canvas.height).data;
    const rows = section => [...document.querySelectorAll(`#${section} tbody tr`)].map(row =>
        [...row.querySelectorAll('td')].map(cell => ({
            number: parseFloat(cell.querySelector('div').textContent),
            data: pixels(cell.querySelector('canvas')),
        })));
    const furnace = ({ number, data }) => {
        const side = Math.sqrt(data.length / 4);
        let most = 0;
        for (let i = 0; i < data.length; i += 4) {
            const [x, y] = [i / 4 % side, Math.floor(i / 4 / side)].map(p => 2 * (p + 0.5) / side);
            // To the views that the number is of; the edge is drawn beyond them.
            if (Math.hypot(x - 1, y - 1) > 0.97) continue;
            most = Math.max(most, ...data.slice(i, i + 3).map(c => 255 - c));
        }
        return { number, most };
    };
    const lamp = ({ number, data }) => {
        let red = 0, blue = 0, black = 0;
        for (let i = 0; i < data.length; i += 4) {
            [red, blue] = [red + data[i], blue + data[i + 2]];
            black += data[i + 3] === 255 && data[i] + data[i + 1] + data[i + 2] === 0;
        }
        return { number, red, blue, black };
    };
    const { scrollWidth, scrollHeight } = document.documentElement;
    return {
        columns: [...document.querySelectorAll('#furnace thead th')].slice(1)
            .map(cell => Number(cell.textContent)),
        furnace: rows('furnace').map(row => row.map(furnace)),
        lamp: rows('lamp').map(row => row.map(lamp)),
        size: [scrollWidth, scrollHeight],
        window: [innerWidth, innerHeight],
    };
}

/// What is on the page, once all is drawn, of the columns and the table that are asked for.
async function drawn({ roughness = '', table, shot } = {}) {
    const options = { viewport: { width: 1280, height: 800 }, ...(table && { table }) };
    const page = await serve(browser, `spheres.html?roughness=${roughness}`, options);
    const said = [];
    page.on('console', message => said.push(message.text()));
    page.on('pageerror', error => said.push(error.message));
    await page.waitForSelector('[data-drawn]', { timeout: 600_000 });
    const found = { ...await page.evaluate(read), said };
    if (shot) await page.screenshot({ path: shot });
    await page.close();
    return found;
}

/// What is wrong, in words.
function faults({ columns, furnace, lamp, size, window, said }) {
    const found = said.map(text => `said: ${text}`);
    if (size.some((x, i) => x > window[i])) found.push(`bars: ${size} in ${window}`);
    const [own, ours] = furnace, [below, above] = lamp;
    columns.forEach((roughness, i) => {
        const expect = (holds, what) => holds || found.push(`${what} at roughness ${roughness}`);
        expect(ours[i].number <= 5e-3 && ours[i].most < 60, 'ours is not white');
        // All light that white metal lacks is what gold lacks in red, more than in blue.
        const share = above[i].number / below[i].number;
        const tint = above[i].red / below[i].red / (above[i].blue / below[i].blue);
        if (roughness === 1) {
            expect(own[i].number > 5e-2 && own[i].most > 200, 'that of three.js is white');
            expect(share > 1.05 && share < 1.1, `gold has ${share}`);
            expect(tint > 1.01, `red by blue is ${tint}`);
        } else {
            expect(Math.abs(share - 1) < 5e-3, `gold has ${share}`);
            expect(Math.abs(tint - 1) < 2e-3, `red by blue is ${tint}`);
        }
        // What no light reaches is the same, but for pixels that are just not black.
        const shadows = above[i].black / below[i].black;
        expect(Math.abs(shadows - 1) < 0.02, `shadows are ${shadows}`);
    });
    return found;
}

test('ours is white at every roughness, and gold differs where three.js is off', async test => {
    // Every other column; a screenshot has all, which takes four times as long.
    const shot = process.env.SHOTS && join(process.env.SHOTS, 'spheres.png');
    const found = await drawn({ roughness: shot ? '' : '0.2,0.4,0.6,0.8,1', shot });
    const { columns, furnace: [own, ours], lamp: [, above] } = found;
    columns.forEach((roughness, i) => test.diagnostic(`roughness ${roughness}: `
        + `${own[i].number} by its table, ${ours[i].number}; gold ${above[i].number} %`));
    assert.equal(columns.length, shot ? 10 : 5);
    assert.deepEqual(faults(found), []);
});

test('all columns fit a window of 1,280 × 800, and of 1,920 × 1,080', async () => {
    for (const [width, height] of [[1280, 800], [1920, 1080]]) {
        const page = await serve(browser, 'spheres.html', { viewport: { width, height } });
        await page.waitForFunction(() => document.querySelectorAll('td canvas').length === 40);
        const { scrollWidth, scrollHeight } = await page.evaluate(() => {
            const { scrollWidth, scrollHeight } = document.documentElement;
            return { scrollWidth, scrollHeight };
        });
        assert.deepEqual([scrollWidth, scrollHeight], [width, height]);
        await page.close();
    }
});

test('a table that is 2 % off, and one of another roughness, are told apart', async () => {
    const table = JSON.parse(readFileSync(join(FOLDER, 'lut', 'lut.json'), 'utf8'));
    const off = { ...table, data: table.data.map((x, i) => (i % 2 ? x : 1.02 * x)) };
    const [axis, other] = table.axes_slowest_first;
    const rougher = { ...table, axes_slowest_first: [{ ...axis, sigma_max: 1.1 }, other] };
    for (const changed of [off, rougher]) {
        const path = join(folder, 'table.json');
        writeFileSync(path, JSON.stringify(changed));
        const found = faults(await drawn({ roughness: '1', table: path }));
        assert.ok(found.some(word => word.startsWith('ours is not white')), found.join('\n'));
    }
});

// The browser, the pages under test, and what a page did while it was open.

import { readFileSync } from 'node:fs';
import { join } from 'node:path';
import { pathToFileURL } from 'node:url';
import { chromium } from 'playwright-core';
import { file } from './files.mjs';

/// Where `run` wrote the pages and the pictures of the crate.
export const FOLDER = process.env.PAGES ?? '.';

/// The pages that `run` writes, without `.html`.
export const PAGES = ['default', 'gold', 'demo', 'brushed', 'images', 'ggx', 'tilted'];

/// WebGL by software, which every machine has; and nothing that calls elsewhere.
const FLAGS = [
    '--no-sandbox',
    '--use-angle=swiftshader',
    '--enable-unsafe-swiftshader',
    '--disable-quic',
    '--no-first-run',
    '--disable-background-networking',
    '--disable-component-update',
    '--disable-sync',
];

export function launch(more = []) {
    const executablePath = process.env.CHROMIUM ?? '/usr/bin/chromium';
    return chromium.launch({ executablePath, args: [...FLAGS, ...more] });
}

/// Opens a page of this folder that takes three.js from npm's, and a table of albedos.
export async function serve(browser, name, options = {}) {
    const { table = join(FOLDER, 'lut', 'lut.json'), ...others } = options;
    const page = await browser.newPage(others);
    await page.route('https://page.test/**', route => {
        const { pathname } = new URL(route.request().url());
        return route.fulfill({ path: file(pathname, table) });
    });
    await page.goto(`https://page.test/${name}`);
    return page;
}

export function address(name) {
    return pathToFileURL(join(FOLDER, `${name}.html`)).href;
}

export function source(name) {
    return readFileSync(join(FOLDER, `${name}.html`));
}

/// Opens a page until a test ends, and keeps what should not happen: words on the console, errors
/// of scripts, and requests, whether they succeed or not. `options.init` runs before the page's own
/// scripts.
export async function open(test, browser, name, options = {}) {
    const { width = 1440, height = 900, scheme = 'light', scripts = true, touch = false } = options;
    const context = await browser.newContext({
        viewport: { width, height },
        deviceScaleFactor: options.density ?? 1,
        colorScheme: scheme,
        javaScriptEnabled: scripts,
        hasTouch: touch,
    });
    test.after(() => context.close());
    const page = await context.newPage();
    const troubles = [];
    page.on('console', message => {
        if (['error', 'warning'].includes(message.type())) {
            troubles.push(`console: ${message.text()}`);
        }
    });
    page.on('pageerror', error => troubles.push(`script: ${error.message}`));
    const url = options.url ?? address(name);
    page.on('request', request => {
        const ours = request.url().split('#')[0] === url.split('#')[0];
        if (!ours && !/^(data|blob):/.test(request.url())) {
            troubles.push(`request: ${request.url()}`);
        }
    });
    page.on('requestfailed', request => troubles.push(`failed: ${request.url()}`));
    if (options.init) {
        await page.addInitScript(options.init);
    }
    await page.goto(url, { waitUntil: 'load' });
    return { page, troubles };
}

/// Waits until the page draws by itself, and lets its sphere rest, so that tests that are not about
/// its pixels do not wait for them.
export async function settled(page, look = { size: 112, samples: 2 }) {
    await page.waitForFunction(() => window.report);
    await page.evaluate(look => report.set(look), look);
}

/// What both tests of pixels say of two pictures of the same size, in RGBA bytes.
export function difference(a, b) {
    if (a.length !== b.length || a.length === 0) {
        throw new Error(`pictures of ${a.length} and ${b.length} bytes`);
    }
    let largest = 0;
    let differing = 0;
    for (let pixel = 0; pixel < a.length; pixel += 4) {
        let of = 0;
        for (let channel = pixel; channel < pixel + 4; channel++) {
            of = Math.max(of, Math.abs(a[channel] - b[channel]));
        }
        largest = Math.max(largest, of);
        differing += of > 0;
    }
    return { largest, differing, pixels: a.length / 4 };
}

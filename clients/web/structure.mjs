// What a page is made of: names, headings, references, and whether text can be told from paper.
// Each function runs in the page, and returns what it found wrong, in words.

/// The document as a document.
export function structure() {
    const found = [];
    const lacks = (what, there) => there || found.push(`no ${what}`);
    lacks('language', document.documentElement.lang);
    lacks('title', document.title.trim());
    lacks('viewport', document.querySelector('meta[name=viewport]'));
    lacks('main', document.querySelectorAll('main').length === 1);
    const headings = [...document.querySelectorAll('h1, h2, h3, h4, h5, h6')];
    const levels = headings.map(heading => Number(heading.tagName[1]));
    lacks('single h1, first', levels.indexOf(1) === 0 && levels.lastIndexOf(1) === 0);
    levels.forEach((level, i) => {
        if (level > (levels[i - 1] ?? 0) + 1) {
            found.push(`h${level} "${headings[i].textContent}" skips a level`);
        }
    });
    headings.forEach(heading => lacks('text in a heading', heading.textContent.trim()));
    const ids = [...document.querySelectorAll('[id]')].map(element => element.id);
    ids.forEach((id, i) => ids.indexOf(id) === i || found.push(`two of id "${id}"`));
    const refers = (element, name) => {
        for (const id of (element.getAttribute(name) ?? '').split(/\s+/).filter(Boolean)) {
            lacks(`element of id "${id}", which ${name} names`, document.getElementById(id));
        }
    };
    for (const name of ['aria-labelledby', 'aria-describedby', 'aria-controls', 'for']) {
        document.querySelectorAll(`[${name}]`).forEach(element => refers(element, name));
    }
    for (const link of document.querySelectorAll('a[href^="#"]')) {
        lacks(link.getAttribute('href'), document.getElementById(link.hash.slice(1)));
    }
    for (const table of document.querySelectorAll('table')) {
        const [row] = table.rows;
        lacks(`caption of table "${row?.textContent}"`, table.caption?.textContent.trim());
        lacks('th with scope in a table', table.querySelector('th[scope]'));
    }
    for (const picture of document.querySelectorAll('img')) {
        // What an element with a name of its own holds is a part of it.
        const named = picture.closest(':is(button, a)[aria-label]')?.getAttribute('aria-label');
        const { parentElement: around } = picture;
        const where = around.className || around.tagName.toLowerCase();
        lacks(`alt of a picture in ${where}`, picture.alt.trim() || named?.trim());
        lacks(`picture "${picture.alt}"`, picture.complete && picture.naturalWidth > 0);
    }
    for (const figure of document.querySelectorAll('figure')) {
        const caption = figure.querySelector('figcaption')?.textContent.trim();
        lacks(`caption of figure.${figure.className}`, caption);
    }
    for (const element of document.querySelectorAll('[src], link[href], object, embed, iframe')) {
        const from = element.getAttribute('src') ?? element.getAttribute('href') ?? '';
        lacks(`need of "${from.slice(0, 60)}"`, /^(data:|blob:)/.test(from));
    }
    return found;
}

/// Text that is shown, as elements with the text that is directly in them. Used by functions that
/// run in the page, and so installed there.
export function shownText() {
    // What is for screen readers alone is in a box of a pixel that cuts it.
    window.isForReaders = element => {
        for (let at = element; at; at = at.parentElement) {
            const { width, height } = at.getBoundingClientRect();
            if (width <= 1 && height <= 1 && getComputedStyle(at).overflowX === 'hidden') {
                return true;
            }
        }
        return false;
    };
    window.shownText = () => {
        const elements = new Map();
        const walker = document.createTreeWalker(document.body, NodeFilter.SHOW_TEXT);
        while (walker.nextNode()) {
            const { parentElement: element, textContent: text } = walker.currentNode;
            const skipped = element.closest('script, style, template, title, desc, option');
            const isShown = element.checkVisibility({ visibilityProperty: true });
            if (skipped || !text.trim() || !isShown || window.isForReaders(element)) {
                continue;
            }
            const range = document.createRange();
            range.selectNodeContents(walker.currentNode);
            const boxes = [...range.getClientRects()].filter(box => box.width > 1.5);
            if (boxes.length > 0) {
                const known = elements.get(element) ?? { element, text: '', boxes: [] };
                known.text += text.trim();
                known.boxes.push(...boxes);
                elements.set(element, known);
            }
        }
        return [...elements.values()];
    };
}

/// WCAG 2.2, 1.4.3: text against what is behind it, 4.5, or 3 if it is large. A panel of a figure
/// has the paper behind it.
export function contrast() {
    const found = [];
    const context = new OffscreenCanvas(1, 1).getContext('2d', { willReadFrequently: true });
    const rgba = colour => {
        context.clearRect(0, 0, 1, 1);
        context.fillStyle = colour;
        context.fillRect(0, 0, 1, 1);
        const [r, g, b, a] = context.getImageData(0, 0, 1, 1).data;
        return [r, g, b, a / 255];
    };
    const over = ([r, g, b, a], paper) =>
        [r, g, b].map((c, i) => c * a + paper[i] * (1 - a));
    const isDark = matchMedia('(prefers-color-scheme: dark)').matches;
    const behind = element => {
        if (!element) {
            return isDark ? [18, 18, 18] : [255, 255, 255];
        }
        const colour = rgba(getComputedStyle(element).backgroundColor);
        return colour[3] === 1 ? colour.slice(0, 3) : over(colour, behind(element.parentElement));
    };
    const luminance = colour => {
        const linear = colour.map(c => {
            const x = c / 255;
            return x <= 0.04045 ? x / 12.92 : ((x + 0.055) / 1.055) ** 2.4;
        });
        return 0.2126 * linear[0] + 0.7152 * linear[1] + 0.0722 * linear[2];
    };
    const said = new Set();
    for (const { element, text } of window.shownText()) {
        if (element.closest(':disabled, [aria-disabled=true]')) {
            continue;
        }
        const style = getComputedStyle(element);
        const paper = behind(element);
        let ink = rgba(element instanceof SVGElement ? style.fill : style.color);
        let opacity = 1;
        for (let at = element; at; at = at.parentElement) {
            opacity *= Number(getComputedStyle(at).opacity);
        }
        ink = over([...ink.slice(0, 3), ink[3] * opacity], paper);
        const [high, low] = [luminance(ink), luminance(paper)].sort((a, b) => b - a);
        const ratio = (high + 0.05) / (low + 0.05);
        const size = parseFloat(style.fontSize);
        const isLarge = size >= 24 || (size >= 18.66 && Number(style.fontWeight) >= 700);
        if (ratio < (isLarge ? 3 : 4.5)) {
            const where = `${element.tagName.toLowerCase()}.${element.getAttribute('class') ?? ''}`;
            const key = `${where} ${ink} ${paper}`;
            if (!said.has(key)) {
                found.push(`contrast ${ratio.toFixed(2)} of "${text.slice(0, 40)}" in ${where}`);
                said.add(key);
            }
        }
    }
    return found;
}

/// Roles of what has to have a name; of a figure it is the caption, see [`structure`].
const NAMED = [
    'slider', 'combobox', 'checkbox', 'radio', 'button', 'link', 'image', 'img', 'table', 'Canvas',
    'textbox', 'listbox', 'spinbutton', 'switch', 'DisclosureTriangle', 'graphics-document',
];

/// Elements that people act on, and pictures, must have names: what a screen reader is given,
/// by the browser's own tree.
export async function names(page) {
    const session = await page.context().newCDPSession(page);
    const { nodes } = await session.send('Accessibility.getFullAXTree');
    await session.detach();
    const kept = nodes.filter(node => !node.ignored && NAMED.includes(node.role?.value));
    const bare = kept.filter(node => !node.name?.value?.trim());
    return {
        count: kept.length,
        roles: [...new Set(kept.map(node => node.role.value))],
        found: bare.map(node => `a ${node.role.value} without a name`),
    };
}
